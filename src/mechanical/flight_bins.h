#pragma once

#include "flight/flight_phases.h"
#include "mechanical/physical_model.h"

#include <cstddef>
#include <string>
#include <vector>

namespace flightwatt::flight {
struct FlightData;
}

namespace flightwatt::mechanical {

/// Power and motion of a flight, averaged over a short time.
struct FlightBin {
    flight::Phase phase = flight::Phase::cruise;
    double start_s = 0.0;  ///< the log's own seconds
    double duration_s = 0.0;
    double power_w = 0.0;
    std::size_t samples = 0;  ///< of power
    TermValues values;        ///< means of the terms; the climb is that of the energy height
    double airspeed_m_per_s = 0.0;

    double middle_s() const { return start_s + 0.5 * duration_s; }
};

/// The bins of one flight, in their order, from lift-off to touchdown.
struct BinnedFlight {
    std::string flight;
    std::vector<FlightBin> bins;
    bool bank_measured = false;  ///< without it every load factor is 1
    std::string no_bins_reason;  ///< why there are no bins; empty if there are
    bool is_rotorcraft = false;
    bool payload_known = false;  ///< of the load; stated, as the rotors, by the log or its column map
    AircraftLoad load = {};
    double airspeed_sd_m_per_s = 0.0;       ///< error of a bin's mean airspeed; 0 if it was measured
    double mean_airspeed_sd_m_per_s = 0.0;  ///< of the flight's mean airspeed
};

/// Each span in equal bins of about `bin_s`. A bin counts where power, airspeed (of a rotorcraft without one, ground
/// speed) and altitude were measured in half of its seconds or more (a sample within 5 s). Its terms:
///   drag, induced   means of V^3 and 1/V of the airspeed's samples (1/V at half their median or more: below, the wing
///                   does not carry)
///   climb           of the energy height altitude + V^2 / 2g, from end to end: power that becomes speed is not lost
///   descent         the same where it is below 0
///   hover, blade    means of the induced power and of V^2 of the airspeed's samples
///   turn            mean of tan^2 of the bank (at most 60 degrees: more is not a steady turn) times that of 1/V
BinnedFlight bin_flight(const flight::FlightData& data, const std::vector<flight::PhaseSegment>& spans,
                        double bin_s = default_bin_s);

/// The spans of a sortie: its phases.
std::vector<flight::PhaseSegment> phase_spans(const flight::Sortie& sortie);

/// The derivatives of a bin's terms by its airspeed, with the climb as it is.
TermValues airspeed_slopes(const FlightBin& bin);

/// Means of the bins' terms, each weighing as long as it is. Of no bins zeros.
TermValues mean_values(const std::vector<FlightBin>& bins);

}  // namespace flightwatt::mechanical
