// Missions and plans as JSON.

#include "cli/output/mission_output.h"

#include "base/error.h"
#include "helpers/paper_missions.h"
#include "mission/plan.h"
#include "mission/sampled_flights.h"

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

mission::MissionSummary outcome(const std::string& name, std::optional<double> soc,
                                std::optional<double> depleted = {}) {
    mission::MissionSummary summary;
    summary.mission = name;
    summary.final_soc_percent = soc;
    summary.depleted_at_s = depleted;
    summary.energy_wh = 10.0;
    summary.mechanical_energy_wh = 4.0;
    summary.compute_energy_wh = 6.0;
    summary.duration_s = 688.0;
    return summary;
}

TEST(ComparisonTable, HasARowAMission) {
    const auto table = table_of(ranked_missions({outcome("a", 5.126), outcome("b", 0.0, 580.345), outcome("c", {})}));
    EXPECT_EQ(to_csv(table),
              "rank,mission,final state of charge [%],reserve [%],energy [Wh],mechanical [Wh],computing [Wh],"
              "duration [s],empty at [s]\n"
              "1,a,5.13,0.00,10.000,4.000,6.000,688.0,-\n2,b,0.00,0.00,10.000,4.000,6.000,688.0,580.3\n"
              "3,c,-,0.00,10.000,4.000,6.000,688.0,-\n");
}

TEST(ComparisonTable, HasRareColumnsWhereAMissionHasThem) {
    auto cut_off = outcome("cut off", 40.0);
    cut_off.cut_off_at_s = 500.0;
    cut_off.schedule = mission::ScheduleOrigin::planned;
    const auto table = table_of(ranked_missions({outcome("lasts", 2.0), cut_off, outcome("early", 0.0, 100.0)}));
    EXPECT_EQ(table.header.back(), "cut off at [s]");
    EXPECT_EQ(table.header[2], "schedule");
    EXPECT_EQ(table.rows[1].back(), "500.0");
    EXPECT_EQ(table.rows[1][1], "cut off");
    EXPECT_EQ(table.rows[1][2], "planned");
    EXPECT_EQ(table.rows[2].back(), "-");
}

TEST(ComparisonCsv, HasEveryColumnWithItsDigits) {
    const auto csv = csv_of(ranked_missions({outcome("a", 100.0 / 3.0)}), 10);
    EXPECT_EQ(csv.substr(csv.find('\n') + 1), "1,a,,33.33333333,0,false,10,4,6,0,688,,,,\n");
}

TEST(MissionJson, HoldsTheSummaryWithNullForNever) {
    auto summary = simulate(test::paper_mission("phased")).summary;
    const auto json = record_json(summary);
    EXPECT_EQ(json["mission"], "phased");
    EXPECT_EQ(json["final_soc_percent"], *summary.final_soc_percent);
    EXPECT_EQ(json["energy_wh"], summary.energy_wh);
    EXPECT_TRUE(json["depleted_at_s"].is_null());
    EXPECT_TRUE(json["cut_off_at_s"].is_null());
    EXPECT_FALSE(json.contains("samples"));
    EXPECT_FALSE(json.contains("power_model")) << "its file does not show how it predicts";
    summary.power_model = mechanical::HeldOutScore{"physical", 4, 2.7};
    EXPECT_EQ(record_json(summary)["power_model"],
              nlohmann::ordered_json({{"model", "physical"}, {"flights", 4}, {"mean_absolute_error_percent", 2.7}}));
    summary.depleted_at_s = 600.0;
    summary.final_soc_percent.reset();
    EXPECT_EQ(record_json(summary)["depleted_at_s"], 600.0);
    EXPECT_TRUE(record_json(summary)["final_soc_percent"].is_null());
}

TEST(MissionJson, HoldsTheLandingThatTheFlightsIndicate) {
    auto summary = simulate(test::paper_mission("phased")).summary;
    EXPECT_FALSE(record_json(summary).contains("with_capacity_of_flights"));
    summary.by_flights = mission::EstimatedLanding{2.05, 59.7, std::nullopt, true};
    const auto json = record_json(summary)["with_capacity_of_flights"];
    EXPECT_EQ(json["capacity_ah"], 2.05);
    EXPECT_EQ(json["final_soc_percent"], 59.7);
    EXPECT_TRUE(json["fails_at_s"].is_null());
    EXPECT_EQ(json["keeps_reserve"], true);
}

TEST(MissionJson, HoldsTheChancesOfSampledFlights) {
    auto summary = simulate(test::paper_mission("phased")).summary;
    summary.samples = mission::MonteCarloResult{};
    summary.samples->samples = 1000;
    summary.samples->probability_below_reserve = 0.25;
    summary.samples->sources.varied = {"cruise power"};
    const auto json = record_json(summary);
    EXPECT_EQ(json["samples"], 1000);
    EXPECT_EQ(json["probability_below_reserve"], 0.25);
    EXPECT_EQ(json["varied"][0], "cruise power");
    EXPECT_EQ(json["final_soc_quantiles_percent"].size(), mission::shown_quantiles_percent.size());
    summary.samples->variability_is_known = false;
    for (const auto* key : {"final_soc_mean_percent", "final_soc_sd_percent", "final_soc_quantiles_percent"})
        EXPECT_TRUE(record_json(summary)[key].is_null()) << key;
}

TEST(PlanJson, HoldsUtilityAndProvenBound) {
    const auto problem = test::paper_problem("plan");
    const auto plan = plan_mission(problem);
    const auto json = record_json(PlanOutput{&plan, &problem.setup});
    EXPECT_TRUE(json["feasible"].get<bool>());
    EXPECT_EQ(json["utility"], *plan.summary.utility);
    EXPECT_GE(json["bound"].get<double>(), json["utility"].get<double>());
    EXPECT_EQ(json["reserve_soc_percent"], problem.setup.reserve_soc_percent);
}

TEST(PlanJson, HasNullForWhatAnInfeasiblePlanLacks) {
    auto problem = test::paper_problem("plan");
    problem.setup.reserve_soc_percent = 60.0;
    const auto plan = plan_mission(problem);
    const auto json = record_json(PlanOutput{&plan, &problem.setup});
    EXPECT_FALSE(json["feasible"].get<bool>());
    EXPECT_TRUE(json["utility"].is_null());
    EXPECT_TRUE(json["bound"].is_null());
}

TEST(InfeasibilityJson, HasNullForMeasuresThatAreNotEnough) {
    mission::InfeasibilityReport report;
    report.shortfall_percent = 2.5;
    report.capacity_ah = 4.0;
    const auto problem = test::paper_problem("plan");
    const auto plan = plan_mission(problem);
    const auto json = record_json(PlanOutput{&plan, &problem.setup, &report})["shortfall"];
    EXPECT_EQ(json["short_percent"], 2.5);
    EXPECT_EQ(json["smallest_capacity_ah"], 4.0);
    EXPECT_TRUE(json["longest_cruise_s"].is_null());
}

}  // namespace
}  // namespace flightwatt::cli
