#pragma once

#include "flight/flight_data.h"
#include "flight/segment.h"
#include "mechanical/flight_bins.h"

#include <cstddef>

namespace flightwatt::mechanical {

/// What was flown of a phase.
struct FlownPhase {
    double duration_s = 0.0;
    double energy_wh = 0.0;
};

/// A flight in the air at one moment; all times are the log's own seconds.
struct FlightProgress {
    double lift_off_s = 0.0;
    double cruise_start_s = 0.0;  ///< `until_s` in a take-off: the height was not held for hold_s yet
    double until_s = 0.0;
    double energy_wh = 0.0;  ///< measured from lift-off until now
    double cruise_energy_wh = 0.0;
    BinnedFlight motion = {};                  ///< until now
    flight::PerPhase<FlownPhase> phases = {};  ///< with a known start; of a take-off until 90 % of the height so far
    double cruise_s() const { return until_s - cruise_start_s; }
};

/// The log time `since_s` after a lift-off, which is found from the log up to that time alone, as a ground station
/// would. `sortie` counts from 0. Throws NoResultError where the log ends more than 60 s before.
double log_time_after_lift_off(const flight::FlightSeries& series, double since_s, std::size_t sortie = 0,
                               const flight::SegmentationOptions& options = {});

/// Returns the state at the end of a log, from its segmentation (nullptr: no sortie). Until the height was held for
/// hold_s, or for 10 s and as long as the climb to it took, the aircraft is in its take-off: while it climbs, it has
/// always just reached 90 % of its height so far. What it flew since then counts for no phase, as it may be cruise
/// already. Throws NoResultError where by then the aircraft has not taken off or has landed, where its take-off is not
/// in the log, or where nothing was logged for more than 60 s before.
FlightProgress progress_of(const flight::FlightData& known, const flight::Sortie* sortie, double until_s,
                           const flight::SegmentationOptions& options = {});

/// Energies, phases and motion of these spans, which end at `until_s` or before.
FlightProgress measured_progress(const flight::FlightData& known, const std::vector<flight::PhaseSegment>& spans,
                                 double until_s);

/// The state `since_s` after the lift-off of a sortie whose phases are known, from the power and motion of the log up
/// to then. Throws NoResultError where the take-off is not complete in the log, or it has landed by then.
FlightProgress progress_after_lift_off(const flight::FlightSeries& series, const flight::Sortie& sortie,
                                       double since_s);

}  // namespace flightwatt::mechanical
