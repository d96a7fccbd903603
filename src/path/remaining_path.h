#pragma once

#include "mechanical/flight_progress.h"
#include "mechanical/prediction.h"
#include "path/cruise_path.h"
#include "path/trajectory.h"

#include <cstddef>
#include <vector>

namespace flightwatt::path {

/// A prediction of what is left of a path, and how long that takes: means over the winds that let it be flown.
struct RemainingPath {
    mechanical::RemainingCruise cruise;
    double duration_s = 0.0;
    double infeasible_fraction = 0.0;  ///< of the winds, of 1
    PathTrajectory trajectory;         ///< in the plan's wind
};

/// A plan's path as it is flown in each of the winds that its spread makes likely, for forecasts of what is left of it
/// from many places: flying it takes most of the time of a forecast.
class PathForecast {
  public:
    explicit PathForecast(PlannedPath plan);

    const PlannedPath& plan() const { return plan_; }
    /// In the plan's wind. Throws InputError where that forbids it.
    const PathTrajectory& flown() const;
    /// The rest of a cruise (predict_remaining_physical), over 7 equally likely speeds by 7 directions of the wind that
    /// the plan's spread makes of its wind, none slower than 0; where they differ the interval is wider. Throws
    /// NoResultError as predict_remaining_physical, or where most of the winds forbid what is left.
    RemainingPath predict(const mechanical::FlightProgress& flown, const PathPosition& place) const;

  private:
    PlannedPath plan_;
    std::vector<PathTrajectory> in_likely_winds_;  ///< crawling where one forbids it
    PathTrajectory flown_;                         ///< in the plan's wind, crawling where that forbids it
};

}  // namespace flightwatt::path
