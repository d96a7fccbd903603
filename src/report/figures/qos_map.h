#pragma once

#include "mission/mission.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

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

/// Whether two missions have the same map: the same flight, components and battery.
bool have_same_map(const mission::MissionSetup& a, const mission::MissionSetup& b);

}  // namespace flightwatt::report
