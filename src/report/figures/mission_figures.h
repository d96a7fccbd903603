#pragma once

#include "report/figure.h"
#include "report/sections/simulated_mission.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Figures of missions: software, schedules and quality of service.

namespace flightwatt::report {

/// Profiled power of every component over its first parameter, a panel a component, a line for each value of the
/// others; with 95 % intervals where standard errors are known. `compute` is not empty.
Figure profile_figure(const compute::ComputeModel& compute, const std::string& id);

/// State of charge over time as the paper's Fig. 3, with common phases; below, the schedules, coloured by power. `data`
/// is missions_data() of the missions, which are not empty.
Figure schedule_figure(std::span<const SimulatedMission> missions, const VegaJson& data, const std::string& id);

/// A parameter of a component: an axis of the map.
struct QosAxis {
    std::size_t component = 0;
    std::size_t parameter = 0;
    std::string name;           ///< "detection fps"
    std::vector<double> nodes;  ///< profiled values and thirds between them
};

/// Final state of charge [%] of one configuration throughout, over two parameters (the paper's Fig. 4).
struct QosMap {
    QosAxis x;
    QosAxis y;
    std::vector<double> soc_percent;  ///< at the nodes, x runs fastest; NaN where the battery fails
    std::string others;               ///< values of further parameters; may be empty
    double at(std::size_t i, std::size_t j) const { return soc_percent[j * x.nodes.size() + i]; }
};

/// The map of a mission's model, battery and durations over its first two parameters; others have their maximum.
/// std::nullopt with fewer than two parameters.
std::optional<QosMap> qos_map(const mission::MissionSetup& mission);

/// A configuration that runs throughout.
struct QosCell {
    mission::Simulation simulation;
    std::optional<double> probability;  ///< of keeping the reserve; unknown without uncertainty
};

/// The profiled values of a mission's first two parameters, at most 8 each; others have their maximum.
struct QosGrid {
    QosAxis x;
    QosAxis y;
    std::vector<QosCell> cells;  ///< x runs fastest
};

/// std::nullopt with fewer than two parameters.
std::optional<QosGrid> qos_grid(const mission::MissionSetup& mission);

/// Equal for missions with the same mechanical model, profiled components, or map (flight, components and battery).
std::string model_key(const mission::MissionSetup& mission);
std::string software_key(const mission::MissionSetup& mission);
std::string map_key(const mission::MissionSetup& mission);

/// The map as the paper's Fig. 4: a cell is the mean of its corners.
Figure qos_map_figure(const QosMap& map, const std::string& id);

}  // namespace flightwatt::report
