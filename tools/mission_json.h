#pragma once

#include "mission/simulation.h"

#include <string>

#include <nlohmann/json.hpp>

namespace flightwatt {

/// The summary as simulate and compare print it; null stands for "never".
inline nlohmann::ordered_json to_json(const MissionSummary& summary) {
    const auto or_null = [](const std::optional<double>& value) {
        return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
    };
    nlohmann::ordered_json json;
    json["mission"] = summary.mission;
    json["final_soc_percent"] = or_null(summary.final_soc_percent);
    json["energy_wh"] = summary.energy_wh;
    json["mechanical_energy_wh"] = summary.mechanical_energy_wh;
    json["compute_energy_wh"] = summary.compute_energy_wh;
    json["delivered_energy_wh"] = summary.delivered_energy_wh;
    json["duration_s"] = summary.duration_s;
    json["depleted_at_s"] = or_null(summary.depleted_at_s);
    json["feasible"] = summary.feasible;
    return json;
}

/// Indented, with a line break at its end. A name that is not UTF-8 (a file's) does not spoil the answer.
inline std::string json_text(const nlohmann::ordered_json& json) {
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace flightwatt
