#pragma once

#include "mechanical/flight_progress.h"
#include "mechanical/prediction.h"
#include "path/cruise_path.h"
#include "path/trajectory.h"

#include <vector>

namespace flightwatt::path {

/// The prediction of the remaining path and its duration: means over the winds in which it is feasible.
struct RemainingPath {
    mechanical::RemainingCruise cruise;
    double duration_s = 0.0;
    double infeasible_fraction = 0.0;  ///< fraction (0 to 1) of the winds in which it is infeasible
    PathTrajectory trajectory;         ///< in the plan's wind
};

/// The path of a plan, computed once in each of the likely winds, for forecasts of its remainder from many positions.
class PathForecast {
  public:
    /// Computes the path in all likely winds.
    explicit PathForecast(PlannedPath plan);

    const PlannedPath& plan() const { return plan_; }
    /// Returns the path in the plan's wind. Throws InputError if it is infeasible in it.
    const PathTrajectory& flown() const;
    /// Predicts the rest of a cruise (predict_remaining_physical()) from a position, in 7 equally likely speeds by 7
    /// directions of the wind by the plan's standard deviations, none slower than 0; their differences widen the
    /// interval. Throws NoResultError as predict_remaining_physical, or if most of the winds make the remainder
    /// infeasible.
    RemainingPath predict(const mechanical::FlightProgress& flown, const PathPosition& place) const;

  private:
    PlannedPath plan_;
    std::vector<PathTrajectory> in_likely_winds_;  ///< with InfeasibleLegPolicy::crawl
    PathTrajectory flown_;                         ///< in the plan's wind, with InfeasibleLegPolicy::crawl
};

}  // namespace flightwatt::path
