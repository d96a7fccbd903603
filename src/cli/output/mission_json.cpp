#include "cli/output/mission_json.h"

namespace flightwatt::cli {

namespace {

void add_to_json(const mission::SampledFlights& flights, nlohmann::ordered_json& json) {
    json["probability_below_reserve"] = flights.probability_below_reserve;
    json["probability_below_reserve_standard_error"] = flights.probability_below_reserve_standard_error;
    json["probability_below_reserve_low"] = flights.probability_below_reserve_95.low;
    json["probability_below_reserve_high"] = flights.probability_below_reserve_95.high;
    json["probability_depleted"] = flights.probability_depleted;
    json["probability_battery_failure"] = flights.probability_battery_failure;
    json["samples"] = flights.samples;
    json["seed"] = flights.seed;
    json["final_soc_mean_percent"] = flights.final_soc_mean_percent;
    json["final_soc_sd_percent"] = flights.final_soc_sd_percent;
    auto& quantiles = json["final_soc_quantiles_percent"];
    for (std::size_t i = 0; i < mission::shown_quantiles_percent.size(); ++i)
        quantiles[std::to_string(mission::shown_quantiles_percent[i])] =
            flights.final_soc_quantiles_percent[i];
    json["drawn"] = flights.drawn;
    json["not_drawn"] = flights.not_drawn;
}

}  // namespace

nlohmann::ordered_json to_json(const mission::MissionSummary& summary) {
    nlohmann::ordered_json json;
    json["mission"] = summary.mission;
    if (summary.schedule != mission::ScheduleOrigin::given) json["schedule"] = to_string(summary.schedule);
    json["final_soc_percent"] = optional_json(summary.final_soc_percent);
    json["energy_wh"] = summary.energy_wh;
    json["mechanical_energy_wh"] = summary.mechanical_energy_wh;
    json["compute_energy_wh"] = summary.compute_energy_wh;
    json["delivered_energy_wh"] = summary.delivered_energy_wh;
    json["duration_s"] = summary.duration_s;
    json["depleted_at_s"] = optional_json(summary.depleted_at_s);
    json["cut_off_at_s"] = optional_json(summary.cut_off_at_s);
    json["feasible"] = summary.feasible;
    json["reserve_soc_percent"] = summary.reserve_soc_percent;
    json["keeps_reserve"] = summary.keeps_reserve;
    if (summary.utility) json["utility"] = *summary.utility;
    if (const auto& decisions = summary.decisions) {
        json["decisions"] = decisions->made;
        json["decisions_without_plan"] = decisions->without_plan;
        json["learned_mechanical_factor"] = decisions->mechanical_factor;
    }
    if (summary.samples) add_to_json(*summary.samples, json);
    return json;
}

}  // namespace flightwatt::cli
