#pragma once

#include "mission/feasibility_limits.h"
#include "mission/mission_file.h"

#include <functional>
#include <optional>

namespace flightwatt::mission {

/// What of a path is made longer until the mission just lands with its reserve.
enum class ReachCriterion {
    circles,   ///< how many of the last circles that the path has
    way_back,  ///< after how many metres of legs to turn back, along the same legs
};

/// Circles where the path has some, else the way back.
ReachCriterion default_criterion(const FlightPath& path);

/// The mission with its path flown to another extent: so many circles, or turning back after so many metres. May throw
/// InputError where its schedule does not fit.
using MissionForExtent = std::function<MissionVariant(double extent)>;

/// The greatest whole number of circles with which a mission lands with its reserve, with its own schedule or the one
/// that demands least energy; with a `probability` that part of the flights do. Throws NoResultError if the fewest that
/// the schedule fits into are too many, or 10,000 are not enough to find an end.
FeasibilityLimit max_circles(const MissionForExtent& mission_of,
                             const std::optional<double>& probability = std::nullopt);

/// The farthest [m] along the legs, which are `length_m` long, from where a mission returns with its reserve; all of
/// them if it returns from their end. Legs behind one whose way back the wind forbids are none to return from. Throws
/// NoResultError if it does not return from anywhere.
FeasibilityLimit farthest_return(const MissionForExtent& mission_of, double length_m,
                                 const std::optional<double>& probability = std::nullopt);

/// What the reach of a mission is counted in.
enum class ReachUnit {
    cruise_s,  ///< of a mission without a path
    circles,
    return_m  ///< along the legs, before it turns back
};

/// How far a mission can go and still land with its reserve.
struct Reach {
    ReachUnit unit = ReachUnit::cruise_s;
    FeasibilityLimit limit;
};

/// The mission's file, read as it says.
using MissionLoader = std::function<MissionVariant(const MissionReadOptions&)>;

/// longest_cruise, or of a mission with a path max_circles or farthest_return; throws as they do.
Reach find_reach(const MissionLoader& mission_of, const std::optional<double>& probability = std::nullopt);

}  // namespace flightwatt::mission
