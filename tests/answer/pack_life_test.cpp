#include "answer/pack_life.h"

#include "helpers/steady_mission.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::answer {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// 55.6 points of a full pack, 2 % more or less; with a reserve of 20 % it takes 71 to 72 % of the capacity.
mission::PreparedMission prepared() {
    auto steady = test::steady_mission();
    steady.setup.reserve_soc_percent = 20.0;
    steady.setup.uncertainty.level_sd_percent[flight::Phase::cruise] = 2.0;
    return mission::prepare_mission(steady);
}

/// A pack over 100 days from 1 January 2026, whose capacity falls by `a_day` percent of its mean.
Pack worn(double a_day) {
    constexpr double january = 20454.0;
    Pack pack;
    pack.resistance_ohm = 0.001;
    pack.first_s = january * seconds_per_day;
    pack.last_s = (january + 100.0) * seconds_per_day;
    pack.capacity.answer.trend = batch::Trend{10, 100.0, -a_day, -1.25 * a_day, -0.75 * a_day};
    pack.capacity.first_day = january;
    pack.capacity.last_day = january + 100.0;
    return pack;
}

TEST(PackLife, IsAsLongAsTheTrendLeavesTheReserve) {
    // 28.2 % less than in the middle, at 0.2 % a day: 141 days after it, 20 February + 141.
    EXPECT_THAT(mission_life(worn(0.2), prepared()),
                testing::ContainsRegex("until 2026-07-(09|10|11|12) \\(2026-06-1"));
    EXPECT_THAT(mission_life(worn(0.2), prepared()), HasSubstr("to later than 2026-07-20)"));
}

TEST(PackLife, IsNotExtendedBeyondWhatTheFlightsShow) {
    EXPECT_EQ(mission_life(worn(0.02), prepared()), "not within what the flights show (until 2026-07-20)");
    auto unproven = worn(0.2);
    unproven.capacity.answer.trend->high_per_day = 0.1;
    EXPECT_EQ(mission_life(unproven, prepared()), "not within what the flights show");
    EXPECT_EQ(mission_life(worn(-0.2), prepared()), "not within what the flights show") << "it gets better";
}

TEST(PackLife, StatesWhyItIsUnknown) {
    auto other = worn(0.2);
    other.cells = 6;
    auto of_three = prepared();
    of_three.setup.battery.cells = 3;
    EXPECT_EQ(mission_life(other, of_three), "unknown: its battery has 3 cells, and the pack 6");
    EXPECT_THAT(mission_life(Pack(), prepared()), StartsWith("unknown: no resistance"));
    auto certain = prepared();
    certain.setup.uncertainty = {};
    EXPECT_THAT(mission_life(worn(0.2), certain), StartsWith("unknown: "));
}

}  // namespace
}  // namespace flightwatt::answer
