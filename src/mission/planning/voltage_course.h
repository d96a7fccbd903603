#pragma once

#include "mission/mission.h"

#include <optional>
#include <vector>

namespace flightwatt::mission {

/// The voltage before the series resistor over a mission: straight lines between points, the ends' values
/// beyond them.
struct VoltageCourse {
    std::vector<double> time_s;  ///< of the mission, rising strictly
    std::vector<double> voltage_v;
    double error_v = 0.0;  ///< what the straight lines may be off, by how they bend from one to the next
};

/// [V] at a time of the mission.
double voltage_v(const VoltageCourse& course, double time_s);

/// The course of a mission with a schedule, simulated as if there was no cut-off; none if the battery does
/// not last.
std::optional<VoltageCourse> voltage_course_of(const MissionSetup& mission,
                                               const std::vector<ScheduleSegment>& schedule);

}  // namespace flightwatt::mission
