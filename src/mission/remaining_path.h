#pragma once

#include "mechanical/prediction.h"
#include "mission/cruise_path.h"

#include <cstddef>

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

/// A prediction of what is left of a path, and how long that takes.
struct RemainingPath {
    mechanical::RestPrediction cruise;
    double duration_s = 0.0;
};

/// The rest of a cruise along its path (predict_rest_by_motion). The spread of the plan's wind widens the interval: by
/// half the difference of the energies at one standard deviation more and less, of speed and of direction. Throws
/// NoAnswerError as predict_rest_by_motion.
RemainingPath predict_rest_of_path(const PathPlan& plan, const mechanical::FlightProgress& flown,
                                   const PathPlace& place);

}  // namespace flightwatt::mission
