// What simulate and compare print of a mission as JSON.

#include "cli/output/mission_json.h"

#include "helpers/paper_missions.h"
#include "mission/sampled_flights.h"

#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

TEST(MissionJson, HoldsTheSummaryWithNullForNever) {
    auto summary = simulate(test::paper_mission("phased")).summary;
    const auto json = to_json(summary);
    EXPECT_EQ(json["mission"], "phased");
    EXPECT_EQ(json["final_soc_percent"], *summary.final_soc_percent);
    EXPECT_EQ(json["energy_wh"], summary.energy_wh);
    EXPECT_TRUE(json["depleted_at_s"].is_null());
    EXPECT_TRUE(json["cut_off_at_s"].is_null());
    EXPECT_FALSE(json.contains("samples"));
    summary.depleted_at_s = 600.0;
    summary.final_soc_percent.reset();
    EXPECT_EQ(to_json(summary)["depleted_at_s"], 600.0);
    EXPECT_TRUE(to_json(summary)["final_soc_percent"].is_null());
}

TEST(MissionJson, HoldsTheChancesOfSampledFlights) {
    auto summary = simulate(test::paper_mission("phased")).summary;
    summary.samples = mission::SampledFlights{};
    summary.samples->samples = 1000;
    summary.samples->probability_below_reserve = 0.25;
    summary.samples->drawn = {"cruise power"};
    const auto json = to_json(summary);
    EXPECT_EQ(json["samples"], 1000);
    EXPECT_EQ(json["probability_below_reserve"], 0.25);
    EXPECT_EQ(json["drawn"][0], "cruise power");
    EXPECT_EQ(json["final_soc_quantiles_percent"].size(), mission::shown_quantiles_percent.size());
}

}  // namespace
}  // namespace flightwatt::cli
