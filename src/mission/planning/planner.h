#pragma once

#include "mission/mission.h"
#include "mission/planning/schedule_search.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace flightwatt::mission {

/// A part of a phase in which one configuration runs throughout.
struct MissionSlot : PhaseSegment {
    std::optional<compute::Configuration> fixed;
};

/// The choices of all plans of a problem: configurations with their utility and power.
struct PlanningTables {
    std::vector<compute::Configuration> configurations;  ///< the choices
    std::vector<double> utility_per_s;                   ///< of each of them
    std::vector<double> compute_w;                       ///< of each of them
    std::size_t free_choices = 0;  ///< number of leading ones that may be chosen; the others are only fixed
};

/// Returns the configurations that [plan] allows, without those that draw more than another one of as much utility, and
/// those that the fixed segments run. Throws InputError if the mission states no utility, or has more than a million
/// combinations.
PlanningTables make_planning_tables(const PlanningProblem& problem);

/// Returns the schedule of the mission that demands least energy: the configuration that draws least wherever nothing is
/// fixed (which any dwell time allows). Throws InputError as make_planning_tables does for too many combinations.
Schedule minimum_energy_schedule(const PlanningProblem& problem);

/// Returns the mission with that schedule; one that has a schedule stays as it is.
Mission with_minimum_energy_schedule(const MissionVariant& mission);

/// Returns the configuration that [plan] allows and that draws least.
compute::Configuration min_power_configuration(const PlanningProblem& problem);

/// Returns the mission from `time_s` on: fixed segments, and between them slots that end at multiples of slot_s since
/// their phase began, or where a fixed segment or the phase does. Throws InputError for more than 20000 slots.
std::vector<MissionSlot> make_slots(const PlanningProblem& problem, double time_s = 0.0);

/// Where a plan starts: before the flight, or in it.
struct PlanStart {
    double time_s = 0.0;  ///< of the mission
    double soc_percent = 100.0;
    /// For the dwell time; ignored if it is not among the configurations.
    std::optional<compute::Configuration> running = std::nullopt;
    double running_for_s = 0.0;
    double mechanical_factor = 1.0;  ///< of mechanical power to the model's
    double rc_voltage_v = 0.0;       ///< of a Thévenin battery
};

/// Returns the schedule of most utility of those that end with the reserve, by search_schedule; the one of least energy
/// demand if none does. Takes milliseconds with low limits, for calls in flight.
Plan plan_remaining(const PlanningProblem& problem, const PlanningTables& planner, const PlanStart& start,
                    double reserve_soc_percent, const SearchLimits& limits = {});

}  // namespace flightwatt::mission
