#pragma once

#include "mission/sampling/flight_draws.h"
#include "mission/sampling/flight_outcome.h"
#include "mission/sampling/lane_schedule.h"

#include <span>
#include <vector>

namespace flightwatt::mission {

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
