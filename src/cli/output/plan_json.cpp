#include "cli/output/plan_json.h"

namespace flightwatt::cli {

nlohmann::ordered_json to_json(const mission::MissionPlan& plan, const mission::MissionSetup& mission) {
    const bool feasible = plan.plan.feasible;
    nlohmann::ordered_json json;
    json["mission"] = mission.name;
    json["feasible"] = feasible;
    json["utility"] = feasible ? nlohmann::ordered_json(*plan.summary.utility) : nullptr;
    json["bound"] = feasible && plan.plan.bound_is_proven ? nlohmann::ordered_json(plan.plan.bound) : nullptr;
    json["final_soc_percent"] = optional_json(plan.summary.final_soc_percent);
    json["reserve_soc_percent"] = mission.reserve_soc_percent;
    json["margin_percent"] = plan.margin_percent;
    return json;
}

nlohmann::ordered_json to_json(const mission::InfeasibilityReport& report) {
    nlohmann::ordered_json json;
    json["short_percent"] = report.short_percent;
    json["short_wh"] = report.short_wh;
    json["cut_off_at_s"] = optional_json(report.cut_off_at_s);
    json["longest_cruise_s"] = optional_json(report.cruise_s);
    json["least_fixed_spare_percent"] = optional_json(report.fixed_spare_percent);
    json["largest_reserve_soc_percent"] = optional_json(report.reserve_soc_percent);
    json["smallest_capacity_ah"] = optional_json(report.capacity_ah);
    return json;
}

}  // namespace flightwatt::cli
