#pragma once

#include "flight/flight_series.h"
#include "flight/selected_track.h"
#include "path/remaining_path.h"

#include <memory>
#include <optional>

namespace flightwatt::path {

/// Where a flight is on its path, by its positions.
struct PathFix {
    std::optional<double> path_time_s = {};  ///< in the path's planned time; none: they do not lie on the path
    bool is_on_path = true;                  ///< else it has left it, and was there last
    double distance_m = 0.0;                 ///< so far from there now
};

/// Where a flight is on its path, by the positions of its cruise from its start until a moment: two forward filters
/// over places on the path (docs/methods.md, Flight along a path), the first for where the path begins. Nothing later
/// is taken into account. Both go on from moment to moment; where positions changed since, they begin anew, so that the
/// answers depend on the series alone.
class PathTracker {
  public:
    /// `path` takes some time.
    explicit PathTracker(const PathForecast& path);
    ~PathTracker();
    PathTracker(const PathTracker&) = delete;
    PathTracker& operator=(const PathTracker&) = delete;

    /// The path begins where the cruise does. std::nullopt where no positions tell.
    std::optional<PathFix> find(const flight::SelectedTracks& tracks, double cruise_start_s, double until_s);

  private:
    class Filters;
    std::unique_ptr<Filters> filters_;
};

/// The same of one moment; std::nullopt of a path that takes no time, too.
std::optional<PathFix> locate_on_path(const PathForecast& path, const flight::FlightSeries& series,
                                      double cruise_start_s, double until_s);

}  // namespace flightwatt::path
