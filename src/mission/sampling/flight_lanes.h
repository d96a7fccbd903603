#pragma once

#include "mission/sampling/flight_draws.h"
#include "mission/sampling/lane_schedule.h"
#include "mission/simulation/load_segments.h"

#include <span>
#include <vector>

namespace flightwatt::mission {

/// A flight that was drawn.
struct SampledFlight {
    const MissionSetup& setup;
    battery::Battery battery;  ///< disturbed
    std::vector<LoadSegment> segments;
};

/// How one flight ended.
struct FlightOutcome {
    double final_soc_percent = 0.0;
    bool depleted = false;
    bool battery_failure = false;  ///< that, or cut off, or beyond the power limit, or on a path that the wind forbids
    /// What is left [points]; after a failure less than 0, by the energy demanded later as a part of a full battery's.
    double remaining_percent = 0.0;
    std::vector<double> soc_percent;  ///< at the times that were asked for
};

/// Follows the charge through the segments and notes it at `times_s`.
FlightOutcome simulate_flight(const SampledFlight& flight, const std::vector<double>& times_s = {});

/// A flight lands below the reserve too where its battery failed, with whatever charge.
inline bool misses_reserve(const FlightOutcome& landing, double reserve_soc_percent) {
    return landing.battery_failure || landing.final_soc_percent < reserve_soc_percent;
}

/// Flies flights of one schedule side by side. How one lands depends on its own numbers alone, whatever flies beside
/// it: as land() of it within 5e-3 points, and 2e-2 of what is left of flights that failed.
class SimdFlightSimulator {
  public:
    /// Charges are noted at `times_s` of the mission as planned, at the same part of each flight. All but the times has
    /// to outlive it.
    SimdFlightSimulator(const MissionSetup& setup, const FlightUncertainty& spreads, const Schedule& schedule,
                        std::vector<double> times_s = {});

    /// Each of the flights of these normals. For all threads.
    void simulate(std::span<const std::vector<double>> normals, std::span<FlightOutcome> landings) const;

    /// One by itself, and by land(): on paths, in phases as they were measured, or where its numbers are far out.
    FlightOutcome simulate_scalar(std::span<const double> normals) const;

  private:
    const MissionSetup& setup_;
    const FlightUncertainty& spreads_;
    const Schedule& schedule_;
    std::vector<double> times_s_;
    bool have_lanes_;
    LaneSchedule lanes_;
};

}  // namespace flightwatt::mission
