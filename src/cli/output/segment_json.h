#pragma once

#include "flight/power_check.h"
#include "flight/segmentation.h"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace flightwatt::cli {

/// What `segment --json` prints: sorties with phases and edges, what is no flight, the power check and the
/// warnings. null stands for what is not known.
nlohmann::ordered_json to_json(const flight::FlightSeries& series, const flight::FlightPhases& phases,
                               const flight::PowerReport& power, const std::vector<std::string>& warnings);

}  // namespace flightwatt::cli
