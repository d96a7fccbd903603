#pragma once

#include "flight/flight_phases.h"
#include "report/figure.h"
#include "report/sections/simulated_mission.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The figures of missions: software, schedules, plans and quality of service.

namespace flightwatt::report {

/// The profiled power of every component over its first parameter, a panel a component; one line for each
/// value of the other parameters together. Points are what was profiled, with
/// 95 % intervals where standard errors are known. A component without parameters is a single point. The model has
/// a component.
Figure profile_figure(const compute::ComputeModel& compute, const std::string& id);

/// State of charge over time, a line a mission, as the paper's Fig. 3, with the phases of the first mission
/// marked where all have the same; the digitised curves as points beside missions of their names; and below,
/// on the same time axis, a strip a mission with the power of what it runs. `missions` is not empty.
Figure schedule_figure(std::span<const SimulatedMission> missions, const PublishedFigures& published,
                       const std::string& id);

/// A schedule's utility beside what it leaves in the battery.
struct UtilityPoint {
    std::string mission;
    double soc_percent = 0.0;
    double utility = 0.0;
    bool planned = false;
};

/// Utility over final state of charge, a point a mission, with the planned one's reserve and proven bound.
Figure utility_figure(const SimulatedMission& planned, const std::vector<UtilityPoint>& points, const std::string& id);

/// When a component of a mission runs with which quality of service, in seconds since the mission began: equal
/// neighbours are one.
struct RunInterval : flight::TimeInterval {
    std::size_t component = 0;
    std::vector<double> qos;
};

std::vector<RunInterval> run_intervals(const mission::Mission& mission);

/// "fps 32, key_bits 448", or "on" of a component without parameters.
std::string describe_qos(const compute::Component& component, const std::vector<double>& qos);

/// What runs when as a Gantt strip, a row a component.
Figure strip_figure(const SimulatedMission& planned, const std::string& id);

/// A parameter of a component: an axis of the map.
struct QosAxis {
    std::size_t component = 0;
    std::size_t parameter = 0;
    std::string name;           ///< "detection fps"
    std::vector<double> nodes;  ///< profiled values and thirds between them, rising
};

/// State of charge [%] at the end of a mission that runs one configuration throughout, over two qualities of
/// service (the paper's Fig. 4).
struct QosMap {
    QosAxis x;
    QosAxis y;
    std::vector<double> soc_percent;  ///< at the nodes, x runs fastest; NaN where it cannot be delivered
    std::string others;               ///< what the further parameters stood at; empty without any
    double at(std::size_t i, std::size_t j) const { return soc_percent[j * x.nodes.size() + i]; }
};

/// The map of a mission's model, battery and durations, whatever its schedule says; its first two parameters
/// are the axes, further ones stand at their greatest value. std::nullopt with fewer than two parameters.
std::optional<QosMap> qos_map(const mission::MissionSetup& mission);

/// Whether two missions have the same mechanical model, the same profiled components, and the same map over quality of
/// service: flight, components and battery.
bool have_same_model(const mission::MissionSetup& a, const mission::MissionSetup& b);
bool have_same_software(const mission::MissionSetup& a, const mission::MissionSetup& b);
bool have_same_map(const mission::MissionSetup& a, const mission::MissionSetup& b);

/// The map as the paper's Fig. 4: a cell is the mean of its four corners, and the configurations that the
/// missions run are marked. `published` are digitised cells of the same axes, drawn as points of their own
/// colour on the same scale: one that agrees is hardly seen.
Figure qos_map_figure(const QosMap& map, std::span<const SimulatedMission> missions,
                      const std::vector<PublishedCell>& published, const std::string& id);

}  // namespace flightwatt::report
