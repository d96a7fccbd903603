#pragma once

#include "report/figure.h"
#include "report/figures/mission_figures.h"
#include "report/sections/simulated_mission.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

/// Data that the page's own script draws (web/drawings.js), as JSON in the page.
namespace flightwatt::report {

/// A number with that many decimals, or null.
VegaJson rounded_json(double value, int decimals);

/// The element "data-ID".
std::string data_block(const std::string& id, const VegaJson& data);

/// Curve of the state of charge [%], charge at landing (null: the battery fails at end_s), duration.
VegaJson curve_data(const mission::Simulation& simulation);

/// Each mission's curve, band of 5 to 95 % of the drawn flights, phases, reserve and outcome, in the order given.
VegaJson missions_data(std::span<const SimulatedMission> missions);

/// Each cell's curve, probability and utility, x running fastest; `missions` are indices of those of the same flight.
VegaJson quality_data(const QosGrid& grid, const std::vector<std::size_t>& missions, double reserve_percent);

}  // namespace flightwatt::report
