#pragma once

#include "flight/flight_series.h"
#include "flight/selected_track.h"
#include "path/remaining_path.h"

#include <memory>
#include <optional>

namespace flightwatt::path {

/// Position of a flight on its path.
struct PathFix {
    std::optional<double> path_time_s = {};  ///< in the path's planned time; none: the positions are not on the path
    bool is_on_path = true;                  ///< else it has left the path, at path_time_s
    double distance_m = 0.0;                 ///< from there, now
};

/// Finds the position of a flight on its path from the positions of its cruise up to a given time, by a forward filter
/// over the path (docs/methods.md, Flight along a path). Later data are ignored. The filter continues from call to call
/// and restarts where positions have changed, so that results depend on the series alone.
class PathTracker {
  public:
    /// `path` takes some time.
    explicit PathTracker(const PathForecast& path);
    ~PathTracker();
    PathTracker(const PathTracker&) = delete;
    PathTracker& operator=(const PathTracker&) = delete;

    /// The path begins where the cruise does. std::nullopt without positions.
    std::optional<PathFix> find(const flight::SelectedTracks& tracks, double cruise_start_s, double until_s);

  private:
    class State;
    std::unique_ptr<State> state_;
};

/// The same for a single time; std::nullopt also for a path that takes no time.
std::optional<PathFix> locate_on_path(const PathForecast& path, const flight::FlightSeries& series,
                                      double cruise_start_s, double until_s);

}  // namespace flightwatt::path
