#pragma once

#include "report/figure.h"
#include "report/simulated_mission.h"

#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::report {

/// A schedule's utility beside what it leaves in the battery.
struct UtilityPoint {
    std::string mission;
    double soc_percent = 0.0;
    double utility = 0.0;
    bool planned = false;
};

/// Utility over final state of charge, a point a mission, with the planned one's reserve and proven bound.
Figure utility_figure(const SimulatedMission& planned, const std::vector<UtilityPoint>& points,
                      const std::string& id);

/// When a component of a mission runs with which quality of service, from start to end as it is seen: equal
/// neighbours are one.
struct Running {
    std::size_t component = 0;
    double start_s = 0.0;  ///< since the mission began
    double end_s = 0.0;
    std::vector<double> qos;
};

std::vector<Running> running_times(const mission::Mission& mission);

/// "fps 32, key_bits 448", or "on" of a component without parameters.
std::string describe_qos(const compute::Component& component, const std::vector<double>& qos);

/// What runs when as a Gantt strip, a row a component.
Figure strip_figure(const SimulatedMission& planned, const std::string& id);

}  // namespace flightwatt::report
