#pragma once

#include "mission/mission_file.h"
#include "mission/plan.h"

#include <optional>
#include <string>

namespace flightwatt::mission {

/// Limits of a mission with its own schedule, or if it is yet to be planned with the one of least energy demand. With a
/// `probability`, that fraction of the drawn flights (sampling/flight_draws.h) keeps the reserve; throws then also as
/// require_known_spread does.

/// The longest cruise [s]. Throws NoResultError if no cruise that the schedule fits into is short enough, or none is
/// too long.
FeasibilityLimit longest_cruise(const MissionVariation& with_cruise_s,
                                const std::optional<double>& probability = std::nullopt);

/// The greatest additional constant power [W] over the whole mission. Throws NoResultError if it does not land with its
/// reserve without it.
FeasibilityLimit largest_payload(const MissionVariant& mission,
                                 const std::optional<double>& probability = std::nullopt);

/// The mission with a battery of another capacity; its interval, if it has one, in proportion.
Mission with_capacity(Mission mission, double capacity_ah);

/// The mission with an additional constant load.
Mission with_payload(const Mission& mission, double payload_w);

/// The least capacity [Ah] with which the mission lands with its reserve, its battery otherwise as it is. None if no
/// capacity is enough.
std::optional<double> min_capacity_ah(const MissionVariant& mission,
                                      const std::optional<double>& probability = std::nullopt);

/// The greatest whole number of the path's last circles. Throws NoResultError if the fewest that the schedule fits into
/// are too many, or 10,000 are not enough to find an end.
FeasibilityLimit max_circles(const MissionVariation& with_circles,
                             const std::optional<double>& probability = std::nullopt);

/// The farthest distance [m] along the legs, of `length_m` in all, from which the mission can return along the same
/// legs. Legs after one that is infeasible on the way back are out of reach. Throws NoResultError if it returns from
/// nowhere.
FeasibilityLimit farthest_return(const MissionVariation& with_return_after_m, double length_m,
                                 const std::optional<double>& probability = std::nullopt);

/// How often the path fits, also a fraction of it (path::repeated). Throws NoResultError if nothing of it does, or more
/// than 1000 times.
FeasibilityLimit most_path_times(const MissionVariation& with_path_times,
                                 const std::optional<double>& probability = std::nullopt);

/// States how much of the mission's path that is, or how much of another fits.
std::string describe_path_times(const MissionSetup& mission, double times);

/// Measure of a mission's reach.
enum class ReachUnit {
    cruise_s,   ///< of a mission without a path
    circles,    ///< of a path that has some
    return_m,   ///< along the legs of another, before it turns back
    path_times  ///< of lines with turns between them, as over an area
};

/// How far a mission can go and still land with its reserve.
struct Reach {
    ReachUnit unit = ReachUnit::cruise_s;
    FeasibilityLimit limit;
};

ReachUnit reach_unit_of(const MissionSetup& mission);

/// longest_cruise, max_circles, farthest_return or most_path_times, by default of the mission's own unit; throws as
/// they do.
Reach find_reach(const MissionLoader& mission_of, const std::optional<double>& probability = std::nullopt,
                 std::optional<ReachUnit> unit = std::nullopt);

/// How far a mission without a feasible schedule misses its reserve, and remedies, each sufficient on its own; none
/// where a measure alone is not sufficient.
struct InfeasibilityReport {
    double shortfall_percent = 0.0;             ///< of the schedule that demands least energy
    double shortfall_wh = 0.0;                  ///< the same, of the energy of a full battery
    std::optional<double> cut_off_at_s;         ///< the shortfall then includes the demand after it
    std::optional<double> cruise_s;             ///< the longest that lands, its duration stated by the mission
    std::optional<double> reserve_soc_percent;  ///< the greatest that can be kept
    std::optional<double> capacity_ah;          ///< the least that suffices
};

/// `plan`, made with `probability`, is infeasible, of the mission that `with_cruise_s` gives for the cruise as it is.
InfeasibilityReport infeasibility_report(const PlanningProblem& problem, const MissionPlan& plan,
                                         const MissionVariation& with_cruise_s,
                                         const std::optional<double>& probability = std::nullopt);

/// For people: "short by 2.1 points (0.23 Wh); ...".
std::string describe(const MissionSetup& mission, const InfeasibilityReport& report);

}  // namespace flightwatt::mission
