#pragma once

#include "mission/mission.h"
#include "mission/planning/depletion_table.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace flightwatt::mission {

/// What all plans of a mission have in common, whenever they are made: configurations with their worth, and
/// what they drain.
struct Planner {
    DrainTable drains;                ///< its configurations are the choices
    std::vector<double> worth_per_s;  ///< of each of them
    std::size_t free_choices = 0;     ///< the first so many may be chosen; the others are only fixed
    DrainTable mechanical_drains;     ///< of one configuration, in which nothing runs
};

/// The configurations that the mission's [plan] allows, without those that draw more than another one that is
/// worth as much, and those that its fixed stretches run. Throws InputError if the mission states no utility,
/// or has more than a million combinations.
///
/// Of a battery whose source follows its charge, the table is along the voltage that the schedule keeps which
/// drains least, raised by the course's error. Where nothing charges, every other schedule is below it at any
/// time, as less power leaves more charge and a smaller RC voltage: so none drains less than this table says.
Planner make_planner(const Mission& mission);

/// The same choices, with what they drain along a course of the source's voltage.
Planner along(const Mission& mission, Planner planner, const SourceVoltage& source);

/// The mission with the schedule that drains least: the configuration that draws least wherever nothing is
/// fixed (which any dwell time allows). A mission that has a schedule stays as it is.
Mission with_least_schedule(const Mission& mission);

/// The configuration that the mission's [plan] allows and that draws least.
compute::Configuration weakest_configuration(const Mission& mission);

/// A part of a phase in which one configuration runs throughout.
struct MissionSlot {
    flight::Phase phase = flight::Phase::takeoff;
    double from_s = 0.0;  ///< since the phase began
    double to_s = 0.0;
    std::optional<compute::Configuration> fixed;
};

/// The mission from `time_s` on: fixed stretches, and between them slots that end at multiples of slot_s
/// since their phase began, or where a fixed stretch or the phase does. Throws InputError for more than 20000
/// slots.
std::vector<MissionSlot> slots_of(const Mission& mission, double time_s = 0.0);

}  // namespace flightwatt::mission
