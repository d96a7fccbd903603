#pragma once

#include "report/figure.h"
#include "report/figures/mission_figures.h"
#include "report/sections/simulated_mission.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

/// Data in the page, as JSON, that the page's script draws (web/drawings.js).
namespace flightwatt::report {

/// Returns a number with that many decimals; null for NaN and infinity.
VegaJson rounded_json(double value, int decimals);

/// Returns the HTML element "data-ID" with JSON.
std::string data_block(const std::string& id, const VegaJson& data);

/// Returns the curve of the state of charge [%], the charge at landing (null: the battery fails at end_s) and the
/// duration.
VegaJson curve_data(const mission::Simulation& simulation);

/// Returns the curve, the band of 5 to 95 % of the drawn flights, phases, reserve and outcome of each mission, in their
/// order.
VegaJson missions_data(std::span<const SimulatedMission> missions);

/// Returns the curve, probability and utility of each cell, x varying fastest. `missions` are the indices of the
/// missions with the same flight.
VegaJson quality_data(const QosGrid& grid, const std::vector<std::size_t>& missions, double reserve_percent);

}  // namespace flightwatt::report
