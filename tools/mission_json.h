#pragma once

#include "json_text.h"
#include "mission/simulation.h"

#include <optional>

namespace flightwatt {

/// The summary as simulate and compare print it; null stands for "never".
inline nlohmann::ordered_json to_json(const MissionSummary& summary) {
    const auto or_null = [](const std::optional<double>& value) {
        return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
    };
    nlohmann::ordered_json json;
    json["mission"] = summary.mission;
    if (!summary.schedule.empty()) json["schedule"] = summary.schedule;
    json["final_soc_percent"] = or_null(summary.final_soc_percent);
    json["energy_wh"] = summary.energy_wh;
    json["mechanical_energy_wh"] = summary.mechanical_energy_wh;
    json["compute_energy_wh"] = summary.compute_energy_wh;
    json["delivered_energy_wh"] = summary.delivered_energy_wh;
    json["duration_s"] = summary.duration_s;
    json["depleted_at_s"] = or_null(summary.depleted_at_s);
    json["cut_off_at_s"] = or_null(summary.cut_off_at_s);
    json["feasible"] = summary.feasible;
    json["reserve_soc_percent"] = summary.reserve_soc_percent;
    json["keeps_reserve"] = summary.keeps_reserve;
    if (summary.utility) json["utility"] = *summary.utility;
    return json;
}

}  // namespace flightwatt
