#pragma once

#include "mission/simulation.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::report {

/// Returns a parameter for readers: "key bits" for "key_bits".
std::string in_words(const std::string& parameter);

/// A parameter of a component as an axis of a map.
struct QosAxis {
    std::size_t component = 0;
    std::size_t parameter = 0;
    std::string name;           ///< "detection fps"
    std::vector<double> nodes;  ///< profiled values and thirds between them
};

/// The final state of charge [%] with one configuration throughout the mission, over two parameters (the paper's Fig.
/// 4).
struct QosMap {
    QosAxis x;
    QosAxis y;
    std::vector<double> soc_percent;  ///< at the nodes, x varies fastest; NaN if the battery fails
};

/// Computes the map of a mission over its first two parameters; others have their maximum. std::nullopt for fewer than
/// two parameters.
std::optional<QosMap> qos_map(const mission::MissionSetup& mission);

/// Number of drawn flights of each cell of a QosGrid.
inline constexpr std::size_t grid_flights_drawn = 200;

/// The result of one configuration throughout a mission.
struct QosCell {
    mission::Simulation simulation;
    std::optional<double> probability;  ///< probability of keeping the reserve; absent without a known uncertainty
};

/// The results over the profiled values of a mission's first two parameters, at most 8 each; others have their maximum.
struct QosGrid {
    QosAxis x;
    QosAxis y;
    std::vector<QosCell> cells;  ///< x varies fastest
    std::string others = {};     ///< values of further parameters; may be empty
};

/// Simulates the grid of a mission; std::nullopt for fewer than two parameters.
std::optional<QosGrid> qos_grid(const mission::MissionSetup& mission);

// Keys that are equal for missions with an equal part.

/// Returns a key of the mission's mechanical model.
std::string model_key(const mission::MissionSetup& mission);
/// Returns a key of the profiled components.
std::string software_key(const mission::MissionSetup& mission);
/// Returns a key of the values that the map depends on: flight, components and battery.
std::string map_key(const mission::MissionSetup& mission);

}  // namespace flightwatt::report
