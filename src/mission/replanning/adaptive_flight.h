#pragma once

#include "mission/disturbance.h"
#include "mission/planning/planner.h"
#include "mission/simulation.h"

#include <optional>
#include <vector>

namespace flightwatt::mission {

/// What a flight controller knows beforehand: the mission as it was stated, and how that depletes the battery.
struct AdaptivePlanner {
    /// A Thévenin battery is a constant source here, at the voltage midway between the initial state of
    /// charge and the reserve; charge then counts as its energy at that voltage.
    PlanningProblem known;
    std::optional<battery::OpenCircuitVoltage> open_circuit;  ///< of a Thévenin battery
    Planner planner;
};

/// Throws as make_planner does, and std::invalid_argument for a problem without a policy.
AdaptivePlanner make_adaptive_planner(const PlanningProblem& problem);

struct AdaptiveFlight {
    std::vector<ScheduleSegment> schedule;  ///< that came about
    AdaptiveDecisions decisions;
};

/// Flies `actual`, the mission as it really is (other durations, battery, powers), under disturbances that
/// the policy does not know. At each decision it makes the best plan of the rest (plan_rest) anew, from the
/// state of charge reached, the part of the phase flown (an aircraft knows how much of its way lies behind
/// it), and the factor m of mechanical power that it has learned: with observed depletion O, predicted depletion F and
/// mechanical part M of that, over t seconds so far,
///     m = 1 + gain (O - F) / M,  gain = t / (t + learning time),
/// the posterior mean if m has standard deviation s beforehand (mechanical_sd) and a flight's mean power
/// over t has variance s^2 (learning time) / t about its level. Above the reserve it keeps the quantile of
/// `probability` of what may still come, with R seconds left that deplete the battery mechanically by M_R,
///     s M_R sqrt(learning time / (t + learning time) + learning time / R).
/// An interval that depletes more than twice the predicted (or charges) is a jump of the charge, not wind: it is
/// answered, but nothing learned. Where no plan keeps that, what demands least energy is run; fixed segments are
/// kept in any case. A cut-off voltage is not taken into account.
AdaptiveFlight fly_adaptively(const AdaptivePlanner& planner, const MissionSetup& actual,
                              const std::vector<Disturbance>& disturbances);

}  // namespace flightwatt::mission
