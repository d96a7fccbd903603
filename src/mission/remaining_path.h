#pragma once

#include "battery/landing_forecast.h"
#include "mechanical/prediction.h"
#include "mission/cruise_path.h"

#include <cstddef>
#include <vector>

namespace flightwatt::mission {

/// A place on a path: so much of an element's time has passed.
struct PathPlace {
    std::size_t element = 0;
    double part = 0.0;  ///< of 1
};

/// Where a path is after a time from its start, at most its duration.
PathPlace place_at(const FlownPath& flown, double time_s);

/// What is left of a path from a place on, which may have been found in another wind.
FlownPath rest_from(const FlownPath& flown, const PathPlace& place);

/// A prediction of what is left of a path, and how long that takes: means over the winds that let it be flown.
struct RemainingPath {
    mechanical::RestPrediction cruise;
    double duration_s = 0.0;
    double forbidden_part = 0.0;               ///< of the winds, of 1
    std::vector<battery::PowerStretch> power;  ///< in the plan's wind, as the model has it, in order
};

/// The rest of a cruise along its path (predict_rest_by_motion), over 7 equally likely speeds by 7 directions of the wind
/// that the plan's spread makes of its wind, none slower than 0; where they differ the interval is wider. Throws
/// NoAnswerError as predict_rest_by_motion, or where most of the winds forbid what is left.
RemainingPath predict_rest_of_path(const PathPlan& plan, const mechanical::FlightProgress& flown,
                                   const PathPlace& place);

}  // namespace flightwatt::mission
