#pragma once

#include "flight/flight_data.h"
#include "mechanical/flight_progress.h"
#include "mechanical/prediction.h"
#include "path/cruise_path.h"
#include "path/trajectory.h"

#include <optional>
#include <vector>

namespace flightwatt::path {

/// Prediction of the remaining path and its duration: means over the winds in which it is feasible.
struct RemainingPath {
    mechanical::RemainingCruise cruise;
    double duration_s = 0.0;
    double infeasible_fraction = 0.0;  ///< of the winds, of 1
    PathTrajectory trajectory;         ///< in the plan's wind
};

/// A plan's path computed once in each of the likely winds, for forecasts of its remainder from many positions.
class PathForecast {
  public:
    explicit PathForecast(PlannedPath plan);

    const PlannedPath& plan() const { return plan_; }
    /// In the plan's wind. Throws InputError if it is infeasible in it.
    const PathTrajectory& flown() const;
    /// The rest of a cruise (predict_remaining_physical), over 7 equally likely speeds by 7 directions of the wind that
    /// the plan's spread makes of its wind, none slower than 0; where they differ the interval is wider. Throws
    /// NoResultError as predict_remaining_physical, or if most of the winds make the remainder infeasible.
    RemainingPath predict(const mechanical::FlightProgress& flown, const PathPosition& place) const;

  private:
    PlannedPath plan_;
    std::vector<PathTrajectory> in_likely_winds_;  ///< crawling where one forbids it
    PathTrajectory flown_;                         ///< in the plan's wind, crawling where that forbids it
};

/// Position of a flight on its path.
struct PathFix {
    std::optional<double> path_time_s = {};  ///< in the path's planned time; none: the positions are not on the path
    bool is_on_path = true;                  ///< else it has left the path, at path_time_s
    double distance_m = 0.0;                 ///< from there, now
};

/// Finds the position of a flight on its path, which begins where the cruise does, from the positions of the cruise up
/// to a given time, by a forward filter over the path (docs/methods.md, Flight along a path). Later data are ignored.
/// std::nullopt without positions, and for a path that takes no time.
std::optional<PathFix> locate_on_path(const PathForecast& path, const flight::FlightData& data, double cruise_start_s,
                                      double until_s);

}  // namespace flightwatt::path
