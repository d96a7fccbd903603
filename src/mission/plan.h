#pragma once

#include "mission/simulation.h"

#include <optional>

namespace flightwatt::mission {

/// A plan of a whole mission, simulated.
struct MissionPlan {
    Plan plan;                                                 ///< its bound is that of the mission as stated
    Mission mission;                                           ///< the mission with the plan's schedule
    MissionSummary summary;                                    ///< of that, simulated
    double margin_percent = 0.0;                               ///< above the reserve, for the probability
    double probability_standard_error = 0.0;                   ///< of the computed probability
    std::optional<UncertaintySources> sources = std::nullopt;  ///< varied for that probability
};

/// Plans a mission and simulates the result; plans again with a stricter reserve where the simulation misses it by
/// rounding. With `probability`, that fraction of the plan's drawn flights (sampling/landing_distribution.h) keeps the
/// reserve; the bound is then that of all which keep the reserve as modelled, without a margin. Infeasible plans are
/// returned as such. Where the lines over an area are chosen, too, plans the schedule for each of the ways to cover it,
/// beginning with the greatest bound, until no other one can have more utility; the bound is that of all. Of infeasible
/// ones, returns the one with the most charge left. Throws InputError without utilities or for too many choices, with
/// `probability` also as require_known_spread.
MissionPlan plan_mission(const PlanningProblem& problem, const std::optional<double>& probability = std::nullopt);

/// Whether the variability of any quantity between flights is known.
bool has_uncertainty(const MissionSetup& mission);

/// Throws InputError with a remedy where it is not.
void require_uncertainty(const MissionSetup& mission);

/// Throws InputError unless the variability of each flown phase's mean power is known; without a mechanical model, that
/// of any quantity.
void require_known_spread(const MissionSetup& mission);

/// Summary of the plan, labelled as optimal (within 0.1 % of its bound), planned or infeasible.
MissionSummary summary_with_origin(const MissionPlan& plan);

}  // namespace flightwatt::mission
