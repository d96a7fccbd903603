// The options of drawing flights, and missions and plans as JSON.

#include "cli/output/mission_output.h"

#include "base/error.h"
#include "helpers/paper_missions.h"
#include "mission/plan.h"
#include "mission/sampled_flights.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

StageCall call_with(const std::vector<std::string>& arguments) {
    StageDefinition stage;
    add_sampling_options(stage);
    StageCall call;
    namespace po = boost::program_options;
    po::store(po::command_line_parser(arguments).options(stage.options).run(), call.options);
    return call;
}

TEST(SamplingOptions, AreNoneWithoutSamples) {
    EXPECT_FALSE(sampling_options(call_with({}), false));
    EXPECT_THROW(sampling_options(call_with({"--seed", "3"}), false), UsageError) << "it belongs to --samples";
}

TEST(SamplingOptions, HoldNumberSeedAndBands) {
    const auto options = sampling_options(call_with({"--samples", "500", "--seed", "3"}), true);
    ASSERT_TRUE(options);
    EXPECT_EQ(options->samples, 500U);
    EXPECT_EQ(options->seed, 3U);
    EXPECT_GT(options->band_points, 0U);
    EXPECT_EQ(sampling_options(call_with({"--samples", "500"}), false)->seed, 1U);
}

TEST(SamplingOptions, RefuseWhatIsNoWholeNumber) {
    for (const auto* text : {"-5", "1.5", "many"}) {
        EXPECT_THROW(sampling_options(call_with({std::string("--samples=") + text}), false), UsageError) << text;
    }
}

TEST(MissionJson, HoldsTheSummaryWithNullForNever) {
    auto summary = simulate(test::paper_mission("phased")).summary;
    const auto json = to_json(summary);
    EXPECT_EQ(json["mission"], "phased");
    EXPECT_EQ(json["final_soc_percent"], *summary.final_soc_percent);
    EXPECT_EQ(json["energy_wh"], summary.energy_wh);
    EXPECT_TRUE(json["depleted_at_s"].is_null());
    EXPECT_TRUE(json["cut_off_at_s"].is_null());
    EXPECT_FALSE(json.contains("samples"));
    EXPECT_FALSE(json.contains("power_model")) << "its file does not tell how it predicts";
    summary.power_model = mechanical::HeldOutScore{"physical", 4, 2.7};
    EXPECT_EQ(to_json(summary)["power_model"],
              nlohmann::ordered_json({{"model", "physical"}, {"flights", 4}, {"mean_absolute_error_percent", 2.7}}));
    summary.depleted_at_s = 600.0;
    summary.final_soc_percent.reset();
    EXPECT_EQ(to_json(summary)["depleted_at_s"], 600.0);
    EXPECT_TRUE(to_json(summary)["final_soc_percent"].is_null());
}

TEST(MissionJson, HoldsTheLandingThatTheFlightsIndicate) {
    auto summary = simulate(test::paper_mission("phased")).summary;
    EXPECT_FALSE(to_json(summary).contains(by_flights_key));
    summary.by_flights = mission::EstimatedLanding{2.05, 59.7, std::nullopt, true};
    const auto json = to_json(summary)[by_flights_key];
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
    const auto json = to_json(summary);
    EXPECT_EQ(json["samples"], 1000);
    EXPECT_EQ(json["probability_below_reserve"], 0.25);
    EXPECT_EQ(json["drawn"][0], "cruise power");
    EXPECT_EQ(json["final_soc_quantiles_percent"].size(), mission::shown_quantiles_percent.size());
}

TEST(PlanJson, HoldsUtilityAndProvenBound) {
    const auto problem = test::paper_problem("plan");
    const auto plan = plan_mission(problem);
    const auto json = to_json(plan, problem.setup);
    EXPECT_TRUE(json["feasible"].get<bool>());
    EXPECT_EQ(json["utility"], *plan.summary.utility);
    EXPECT_GE(json["bound"].get<double>(), json["utility"].get<double>());
    EXPECT_EQ(json["reserve_soc_percent"], problem.setup.reserve_soc_percent);
}

TEST(PlanJson, HasNullForWhatAnInfeasiblePlanLacks) {
    auto problem = test::paper_problem("plan");
    problem.setup.reserve_soc_percent = 60.0;
    const auto json = to_json(plan_mission(problem), problem.setup);
    EXPECT_FALSE(json["feasible"].get<bool>());
    EXPECT_TRUE(json["utility"].is_null());
    EXPECT_TRUE(json["bound"].is_null());
}

TEST(InfeasibilityJson, HasNullForMeasuresThatAreNotEnough) {
    mission::InfeasibilityReport report;
    report.shortfall_percent = 2.5;
    report.capacity_ah = 4.0;
    const auto json = to_json(report);
    EXPECT_EQ(json["short_percent"], 2.5);
    EXPECT_EQ(json["smallest_capacity_ah"], 4.0);
    EXPECT_TRUE(json["longest_cruise_s"].is_null());
}

}  // namespace
}  // namespace flightwatt::cli
