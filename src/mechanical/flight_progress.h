#pragma once

#include "flight/flight_series.h"
#include "flight/segmentation.h"
#include "flight/selected_track.h"
#include "mechanical/flight_bins.h"

#include <cstddef>
#include <optional>

namespace flightwatt::mechanical {

/// A flight in the air, at one moment of its cruise; all times are the log's own seconds.
struct FlightProgress {
    double lift_off_s = 0.0;
    double cruise_start_s = 0.0;
    double until_s = 0.0;
    double energy_wh = 0.0;  ///< measured from lift-off until now
    double cruise_energy_wh = 0.0;
    BinnedFlight motion = {};  ///< until now
    double cruise_s() const { return until_s - cruise_start_s; }
};

/// The last time of the log at which power or altitude was logged: now, of a log that still grows. -infinity of none.
double last_time_s(const flight::FlightSeries& series);

/// The log's time so many seconds after a lift-off that is itself found in what lies before: waits, like a
/// ground station, until the lift-off that is seen is that long ago. Never looks beyond the answer. `sortie`
/// counts from 0. Throws NoResultError where the log ends more than 60 s before.
double log_time_after_lift_off(const flight::FlightSeries& series, double since_s, std::size_t sortie = 0,
                               const flight::SegmentationOptions& options = {});

/// What a ground station knew at a time of the log, from the lines until then alone: the answer is the same
/// whether the log goes on or ends there. `sortie` counts from 0. Throws NoResultError where by then the
/// aircraft has not taken off, has not held its height for hold_s, or has landed, or where nothing was logged
/// for more than 60 s before; what segment throws.
FlightProgress progress_at(const flight::FlightSeries& series, double until_s, std::size_t sortie = 0,
                           const flight::SegmentationOptions& options = {});

/// The same of what was known at that time, and was segmented: `known` ends there. nullptr: no sortie.
FlightProgress progress_of(const flight::SelectedTracks& known, const flight::Sortie* sortie, double until_s,
                           const flight::SegmentationOptions& options = {});

}  // namespace flightwatt::mechanical
