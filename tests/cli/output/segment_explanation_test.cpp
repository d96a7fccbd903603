// What `segment --explain` prints.

#include "cli/output/segment_explanation.h"

#include "flight/load_flight.h"
#include "helpers/test_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

TEST(Explanation, GivesTheReasonsOfEveryEdgeAndThePowerRecord) {
    const auto series = flight::read_flight(test::source_dir() / "logs" / "opterra_synthetic_01.data");
    const auto phases = segment(series);
    auto power = check_power_record(series, phases);
    const auto table = edges_table(series, phases);
    ASSERT_EQ(table.rows.size(), 4U);
    EXPECT_EQ(table.rows[0][0], "1");
    EXPECT_EQ(table.rows[0][2], fmt::format("{:.1f}", phases.sorties[0].phases[0].start.time_s));
    auto text = explanation(series, phases, power);
    EXPECT_THAT(text, HasSubstr(to_text(table)));
    EXPECT_THAT(text, HasSubstr("idle current on the ground: "));
    EXPECT_THAT(text, HasSubstr(fmt::format("gaps in flight: {}", power.gaps.size())));
    power.idle.reset();
    text = explanation(series, phases, power);
    EXPECT_THAT(text, testing::Not(HasSubstr("idle current")));
}

TEST(WitnessText, NamesWitnessesBeforeWhatIsNearby) {
    flight::ExplainedEdge edge;
    EXPECT_EQ(witness_text(edge), "-");
    edge.witnesses.resize(1);
    edge.witnesses[0].what = "TAKEOFF";
    edge.witnesses[0].time_s = 40.0;
    edge.witnesses[0].after_s = -0.4;
    edge.nearby = edge.witnesses;
    EXPECT_EQ(witness_text(edge), "TAKEOFF at 40.0 s (-0.4 s); nearby: TAKEOFF at 40.0 s (-0.4 s)");
}

}  // namespace
}  // namespace flightwatt::cli
