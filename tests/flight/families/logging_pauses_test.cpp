#include "flight/families/logging_pauses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

/// What a pack shows before and after a pause.
struct Pack {
    double voltage_v = 15.0;
    double current_a = 10.0;
    double charge_ah = 1.0;
};

/// A hundred samples, a second apart, on each side of a pause.
FlightSeries paused(double pause_s, const Pack& before, const Pack& after) {
    FlightSeries series;
    series.tracks = {{"voltage_v"}, {"current_a"}, {"charge_ah"}};
    for (int i = 0; i < 200; ++i) {
        const auto& pack = i < 100 ? before : after;
        for (auto& track : series.tracks) track.time_s.push_back(i + (i < 100 ? 0.0 : pause_s - 1.0));
        series.tracks[0].value.push_back(pack.voltage_v);
        series.tracks[1].value.push_back(pack.current_a);
        series.tracks[2].value.push_back(pack.charge_ah);
    }
    series.skipped = {{"damaged", {{50.0, 1, 51}, {99.0 + pause_s, 1, 102}}}};
    return series;
}

TEST(LoggingPauses, SplitWhereTheCounterRestarts) {
    const auto parts = split_at_pauses(paused(61.0, {}, {.charge_ah = 0.05}));
    ASSERT_THAT(parts, SizeIs(2));
    for (const auto& part : parts) {
        EXPECT_THAT(part.tracks.at(0).time_s, SizeIs(100));
        EXPECT_THAT(part.skipped.at(0).lines, SizeIs(1));
    }
    EXPECT_THAT(parts[0].notes, SizeIs(0));
    EXPECT_EQ(parts[1].tracks.at(0).time_s.front(), 160.0);
    EXPECT_THAT(parts[1].notes,
                testing::ElementsAre("the log pauses for 61 s at 99.0 s, and the charge counter restarts: "
                                     "another recording begins"));
    EXPECT_THAT(split_at_pauses(paused(60.0, {}, {.charge_ah = 0.05})), SizeIs(1));
    EXPECT_THAT(split_at_pauses(paused(61.0, {}, {.charge_ah = 0.2})), SizeIs(1));
}

TEST(LoggingPauses, SplitWhereTheVoltageRisesUnderLoad) {
    const auto parts = split_at_pauses(paused(600.0, {}, {.voltage_v = 15.8}));
    ASSERT_THAT(parts, SizeIs(2));
    EXPECT_THAT(parts[1].notes.at(0), HasSubstr("and the voltage has risen from 15.0 to 15.8 V"));
    EXPECT_THAT(split_at_pauses(paused(600.0, {}, {.voltage_v = 15.7})), SizeIs(1));
    EXPECT_THAT(split_at_pauses(paused(600.0, {}, {.voltage_v = 16.2, .current_a = 4.9})), SizeIs(1)) << "unloaded";
    EXPECT_THAT(split_at_pauses({}), SizeIs(1));
}

}  // namespace
}  // namespace flightwatt::flight
