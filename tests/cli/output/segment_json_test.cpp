// The segmentation of a log as JSON.

#include "cli/output/segment_json.h"

#include "flight/load_flight.h"
#include "helpers/test_paths.h"

#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

TEST(SegmentJson, HoldsPhasesEdgesAndThePowerCheck) {
    const auto series = flight::read_flight(test::source_dir() / "logs" / "opterra_synthetic_01.data");
    const auto phases = segment(series);
    const auto json = to_json(series, phases, check_power_record(series, phases), {"a warning"});
    EXPECT_EQ(json["flight"], "opterra_synthetic_01");
    ASSERT_EQ(json["sorties"].size(), 1U);
    const auto& spans = json["sorties"][0]["phases"];
    ASSERT_EQ(spans.size(), 3U);
    const auto& cruise = phases.sorties[0].phases[1];
    EXPECT_EQ(spans[1]["phase"], "cruise");
    EXPECT_EQ(spans[1]["start_s"], cruise.start.time_s);
    EXPECT_EQ(spans[1]["duration_s"], cruise.duration_s());
    EXPECT_EQ(spans[0]["end_s"], spans[1]["start_s"]);
    EXPECT_EQ(json["sorties"][0]["edges"].size(), 4U);
    EXPECT_TRUE(json["not_flights"].empty());
    EXPECT_EQ(json["warnings"][0], "a warning");
    EXPECT_GT(json["power"]["idle_current"]["samples"], 0);
}

}  // namespace
}  // namespace flightwatt::cli
