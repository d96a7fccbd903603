#pragma once

#include "cli/output/json_text.h"
#include "mission/infeasibility_report.h"

#include <optional>

namespace flightwatt::cli {

/// A plan; null stands for what an infeasible one does not have.
inline nlohmann::ordered_json to_json(const mission::MissionPlan& plan, const mission::Mission& mission) {
    const bool feasible = plan.plan.feasible;
    nlohmann::ordered_json json;
    json["mission"] = mission.name;
    json["feasible"] = feasible;
    json["utility"] = feasible ? nlohmann::ordered_json(*plan.summary.utility) : nullptr;
    json["bound"] = feasible && plan.plan.bound_is_proven ? nlohmann::ordered_json(plan.plan.bound) : nullptr;
    json["final_soc_percent"] =
        plan.summary.final_soc_percent ? nlohmann::ordered_json(*plan.summary.final_soc_percent) : nullptr;
    json["reserve_soc_percent"] = mission.reserve_soc_percent;
    json["margin_percent"] = plan.margin_percent;
    return json;
}

inline nlohmann::ordered_json to_json(const mission::Shortfall& shortfall) {
    const auto or_null = [](const std::optional<double>& value) {
        return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
    };
    nlohmann::ordered_json json;
    json["short_percent"] = shortfall.short_percent;
    json["short_wh"] = shortfall.short_wh;
    json["cut_off_at_s"] = or_null(shortfall.cut_off_at_s);
    json["longest_cruise_s"] = or_null(shortfall.cruise_s);
    json["least_fixed_spare_percent"] = or_null(shortfall.fixed_spare_percent);
    json["largest_reserve_soc_percent"] = or_null(shortfall.reserve_soc_percent);
    json["smallest_capacity_ah"] = or_null(shortfall.capacity_ah);
    return json;
}

}  // namespace flightwatt::cli
