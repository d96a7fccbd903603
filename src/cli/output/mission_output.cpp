#include "cli/output/mission_output.h"

#include "base/error.h"
#include "base/units.h"
#include "cli/output/fit_output.h"
#include "cli/output/records.h"
#include "cli/stage.h"
#include "mechanical/mechanical_model.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

void add_to_json(const mission::MonteCarloResult& flights, Json& json) {
    json["probability_below_reserve"] = flights.probability_below_reserve;
    json["probability_below_reserve_standard_error"] = flights.probability_below_reserve_standard_error;
    json["probability_below_reserve_low"] = flights.probability_below_reserve_95.low;
    json["probability_below_reserve_high"] = flights.probability_below_reserve_95.high;
    json["probability_below_reserve_outside_measured"] = flights.probability_below_reserve_outside_measured;
    json["probability_depleted"] = flights.probability_depleted;
    json["probability_battery_failure"] = flights.probability_battery_failure;
    json["samples"] = flights.samples;
    json["seed"] = flights.seed;
    json["final_soc_mean_percent"] = flights.final_soc_mean_percent;
    json["final_soc_sd_percent"] = flights.final_soc_sd_percent;
    auto& quantiles = json["final_soc_quantiles_percent"];
    for (std::size_t i = 0; i < mission::shown_quantiles_percent.size(); ++i)
        quantiles[std::to_string(mission::shown_quantiles_percent[i])] = flights.final_soc_quantiles_percent[i];
    add_sources(flights.sources, json);
}

}  // namespace

void add_sources(const mission::UncertaintySources& sources, Json& json) {
    json["drawn"] = sources.varied;
    json["not_drawn"] = sources.fixed;
}

void warn_of_lost_comments(const StageCall& call, const mission::PlannedMissionText& written) {
    if (written.lost_comments)
        warn(call,
             "the mission's comments and order are not in the result: they are kept where [plan], [policy] and "
             "[[schedule]] are tables of their own, not inline or dotted");
}

void warn_of_setup(const StageCall& call, const mission::MissionSetup& mission) {
    auto warnings = battery_warnings(mission.battery);
    if (mission.mechanical) std::ranges::copy(model_warnings(*mission.mechanical), std::back_inserter(warnings));
    for (const auto& component : mission.compute.components)
        if (auto text = negative_power_warning(component.profile); !text.empty()) warnings.push_back(std::move(text));
    std::ranges::copy(mission.notes, std::back_inserter(warnings));
    for (const auto& warning : warnings) warn(call, fmt::format("{}: {}", mission.name, warning));
}

void note_power_model(const StageCall& call, const mission::MissionSetup& mission) {
    if (mission.power_model) note(call, fmt::format("{}: {}", mission.name, mission::describe(*mission.power_model)));
}

Json to_json(const mission::MissionSummary& summary) {
    Json json;
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
    if (summary.power_model) json["power_model"] = to_json(*summary.power_model);
    if (summary.utility) json["utility"] = *summary.utility;
    if (const auto& decisions = summary.decisions) {
        json["decisions"] = decisions->made;
        json["decisions_without_plan"] = decisions->without_plan;
        json["learned_mechanical_factor"] = decisions->mechanical_factor;
    }
    if (summary.samples) add_to_json(*summary.samples, json);
    if (summary.by_flights) json[by_flights_key] = to_json(*summary.by_flights);
    return json;
}

Json to_json(const mission::EstimatedLanding& landing) {
    return {{"capacity_ah", landing.capacity_ah},
            {"final_soc_percent", optional_json(landing.final_soc_percent)},
            {"fails_at_s", optional_json(landing.fails_at_s)},
            {"keeps_reserve", landing.keeps_reserve}};
}

Json ranking_json(const std::vector<mission::MissionSummary>& ranked) {
    auto records = Json::array();
    for (const auto& summary : ranked) {
        auto record = to_json(summary);
        record["rank"] = records.size() + 1;
        const auto origin = to_string(summary.schedule);
        record["title"] = origin.empty() ? summary.mission : fmt::format("{} ({})", summary.mission, origin);
        if (summary.samples)
            record["chance_below_percent"] = units::percentage(summary.samples->probability_below_reserve, 1.0);
        records.push_back(std::move(record));
    }
    return records;
}

TextTable comparison_table(const std::vector<mission::MissionSummary>& ranked) {
    return table_of(ranking_json(ranked),
                    {"rank", "title: mission", "final_soc_percent .2f", "energy_wh .3f", "mechanical_energy_wh .3f",
                     "compute_energy_wh .3f", "duration_s .1f", "depleted_at_s .1f", "cut_off_at_s? .1f",
                     "utility? .3f", "probability_below_reserve? .4f"});
}

std::string comparison_csv(const std::vector<mission::MissionSummary>& ranked) {
    constexpr int digits = 10;
    return csv_of(ranking_json(ranked),
                  {"rank", "mission", "schedule", "final_soc_percent", "reserve_soc_percent", "keeps_reserve",
                   "energy_wh", "mechanical_energy_wh", "compute_energy_wh", "delivered_energy_wh", "duration_s",
                   "depleted_at_s", "cut_off_at_s", "utility", "probability_below_reserve"},
                  digits);
}

Json to_json(const mission::MissionPlan& plan, const mission::MissionSetup& mission) {
    const bool feasible = plan.plan.feasible;
    Json json;
    json["mission"] = mission.name;
    json["feasible"] = feasible;
    json["utility"] = feasible ? Json(*plan.summary.utility) : nullptr;
    json["bound"] = feasible && plan.plan.bound_is_proven ? Json(plan.plan.utility_bound) : nullptr;
    json["final_soc_percent"] = optional_json(plan.summary.final_soc_percent);
    json["reserve_soc_percent"] = mission.reserve_soc_percent;
    json["margin_percent"] = plan.margin_percent;
    if (mission.power_model) json["power_model"] = to_json(*mission.power_model);
    if (plan.sources) add_sources(*plan.sources, json);
    if (plan.summary.by_flights) json[by_flights_key] = to_json(*plan.summary.by_flights);
    return json;
}

Json to_json(const mission::InfeasibilityReport& report) {
    return {{"short_percent", report.shortfall_percent},
            {"short_wh", report.shortfall_wh},
            {"cut_off_at_s", optional_json(report.cut_off_at_s)},
            {"longest_cruise_s", optional_json(report.cruise_s)},
            {"least_fixed_spare_percent", optional_json(report.min_fixed_surplus_percent)},
            {"largest_reserve_soc_percent", optional_json(report.reserve_soc_percent)},
            {"smallest_capacity_ah", optional_json(report.capacity_ah)}};
}

}  // namespace flightwatt::cli
