#pragma once

#include "flight/flight_data.h"
#include "flight/flight_phases.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// Statistics of the measurements between two times.
struct PhaseStatistics {
    std::size_t samples = 0;                  ///< power samples in [start, end]
    double mean_power_w = 0.0;                ///< energy over duration; 0 without a duration
    double energy_wh = 0.0;                   ///< integral of the power, linear between samples, without lost_s
    std::optional<double> counter_energy_wh;  ///< change of the on-board counter
    std::size_t gaps = 0;                     ///< number of intervals without a sample, see gap_threshold_s()
    double max_gap_s = 0.0;
    double lost_s = 0.0;  ///< time in gaps of damaged bytes, whose power is not known
};

/// The energy of a circuit, and its part of that of all circuits.
struct CircuitShare {
    std::string name;  ///< its battery monitors
    double energy_wh = 0.0;
    double percent = 0.0;  ///< of the energy of all circuits
};

/// Returns the energies in flight (without a flight: in the whole log) of the circuits of a log that numbers its
/// batteries; empty for other logs.
std::vector<CircuitShare> circuit_shares(const FlightData& data, const FlightPhases& phases);

/// The power of a flight, prepared for the statistics of many phases.
class PowerStatistics {
  public:
    explicit PowerStatistics(const FlightData& data);

    bool has_power() const { return !power_.empty(); }
    /// Returns the statistics of [start_s, end_s]; all zero without power.
    PhaseStatistics between(double start_s, double end_s) const;

  private:
    Track power_;
    std::vector<double> counter_wh_;  ///< at the times of the power samples
    double gap_s_ = 0.0;
    std::vector<std::size_t> lost_;  ///< last sample before each gap in which bytes are damaged
};

/// Returns the energy [Wh] of a power track between two times: trapezoids, with interpolated values at both ends.
double integrated_energy_wh(const Track& power_w, double start_s, double end_s);

}  // namespace flightwatt::flight
