#pragma once

#include "mechanical/flight_progress.h"
#include "mechanical/prediction.h"
#include "path/cruise_path.h"
#include "path/trajectory.h"

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

}  // namespace flightwatt::path
