// What segment states of a log, in words and as JSON.

#include "cli/output/segment_output.h"

#include "flight/load_flight.h"
#include "flight/power_check.h"
#include "flight/select.h"
#include "helpers/test_paths.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

TEST(Explanation, GivesTheReasonsOfEveryEdgeAndThePowerRecord) {
    const auto data = select_tracks(flight::read_flight(test::source_dir() / "logs" / "opterra_synthetic_01.data"));
    const auto phases = segment(data);
    auto power = check_power_record(data, phases);
    const auto table = edges_table(data, phases);
    ASSERT_EQ(table.rows.size(), 4U);
    EXPECT_EQ(table.rows[2][1], "start of landing");
    EXPECT_EQ(table.rows[2][8], "Land Right AF-TD");
    EXPECT_EQ(table.rows[0][0], "1");
    EXPECT_EQ(table.rows[0][2], fmt::format("{:.1f}", phases.sorties[0].phases[0].start.time_s));
    auto text = explanation(data, phases, power, {});
    EXPECT_THAT(text, HasSubstr(to_text(table)));
    EXPECT_THAT(text, HasSubstr("idle current mean: "));
    EXPECT_THAT(text, HasSubstr(fmt::format("gaps in flight: {}", power.gaps.size())));
    power.idle.reset();
    text = explanation(data, phases, power, {});
    EXPECT_THAT(text, testing::Not(HasSubstr("idle current")));
}

TEST(SegmentJson, HoldsPhasesEdgesAndThePowerCheck) {
    const auto data = select_tracks(flight::read_flight(test::source_dir() / "logs" / "opterra_synthetic_01.data"));
    const auto phases = segment(data);
    const auto power = check_power_record(data, phases);
    const Diagnostics found{{Severity::warning, "a kind", "a warning"}};
    const auto json = record_json(SegmentedFlight{&data, &phases, &power, &found});
    EXPECT_EQ(json["flight"], "opterra_synthetic_01");
    ASSERT_EQ(json["sorties"].size(), 1U);
    const auto& spans = json["sorties"][0]["phases"];
    ASSERT_EQ(spans.size(), 3U);
    const auto& cruise = phases.sorties[0].phases[1];
    EXPECT_EQ(spans[1]["phase"], "cruise");
    EXPECT_EQ(spans[1]["start_s"], cruise.start.time_s);
    EXPECT_EQ(spans[1]["duration_s"], cruise.duration_s());
    EXPECT_EQ(spans[0]["end_s"], spans[1]["start_s"]);
    ASSERT_EQ(json["rejected_activities"].size(), 1U);
    EXPECT_EQ(json["rejected_activities"][0]["what"], phases.ground_events[0].what);
    EXPECT_EQ(json["warnings"][0], "a warning");
    EXPECT_EQ(json["diagnostics"][0]["severity"], "warning");
    EXPECT_GT(json["power"]["idle_current"]["samples"], 0);
}

}  // namespace
}  // namespace flightwatt::cli
