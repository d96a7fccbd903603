#pragma once

#include "mission/simulation.h"

#include <optional>

namespace flightwatt::mission {

/// A plan of a whole mission that Runge-Kutta has flown.
struct MissionPlan {
    Plan plan;                                ///< its bound is of the mission as stated, whatever Runge-Kutta says
    Mission mission;                          ///< the mission with the plan's schedule
    MissionSummary summary;                   ///< of that, simulated
    double margin_percent = 0.0;              ///< kept above the reserve for the sake of the probability
    double probability_standard_error = 0.0;  ///< of the chance to keep the reserve, as it is computed
    std::optional<UncertaintySources> sources = std::nullopt;  ///< what may differ with that probability
};

/// Plans a mission and simulates the result; where that ends below the reserve (by rounding, or because a full battery
/// refused charge, which tables do not know), plans anew with more to spare. The bound holds nevertheless, as the first
/// plan depletes the battery no more than the simulation.
///
/// With `probability`, the reserve is kept by that part of the flights which flight_of makes of the plan
/// (sampling/flight_draws.h), battery failures counted as below it: margins above the reserve are tried until the
/// plan's flights do (sampling/landing_distribution.h). The bound is then that of schedules which, flown as stated, keep
/// reserve and margin. Infeasible plans are returned as such. Throws InputError if the mission states no utility, or
/// too many choices; with `probability` also as require_known_spread does.
MissionPlan plan_mission(const PlanningProblem& problem, const std::optional<double>& probability = std::nullopt);

/// Whether something says how a mission's flights differ.
bool has_uncertainty(const MissionSetup& mission);

/// Throws InputError, which says what is missing and how to get it, where nothing does.
void require_uncertainty(const MissionSetup& mission);

/// Throws InputError where a mission does not say how its flights differ: the level of each phase that is flown;
/// without a mechanical model anything.
void require_known_spread(const MissionSetup& mission);

/// What the flown mission comes to, labelled as optimal (its bound is within 0.1 %) or planned.
MissionSummary summary_with_origin(const MissionPlan& plan);

}  // namespace flightwatt::mission
