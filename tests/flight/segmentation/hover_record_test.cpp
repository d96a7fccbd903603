#include "flight/segmentation/hover_record.h"

#include "flight/segmentation.h"

#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::IsEmpty;

/// Ten samples a second: idle at a quarter of the throttle, hovering from 20 to 60 s and from 70 to 100 s at 1.5 m, with
/// a barometer that drifts by 2 m.
FlightSeries hopping_copter() {
    FlightSeries series;
    series.firmware = "rotorcraft";
    Track throttle{.name = "throttle_percent", .source = "CTUN.ThO"};
    Track altitude{.name = "altitude_m", .source = "BARO.Alt"};
    Track power{.name = "power_w", .source = "BAT.Volt * BAT.Curr"};
    for (int i = 0; i < 1200; ++i) {
        const double time_s = 0.1 * i;
        const bool flies = (time_s >= 20.0 && time_s < 60.0) || (time_s >= 70.0 && time_s < 100.0);
        for (auto* track : {&throttle, &altitude, &power}) track->time_s.push_back(time_s);
        throttle.value.push_back(flies ? 50.0 + i % 3 : 12.0);
        altitude.value.push_back((flies ? 1.5 : 0.0) + time_s / 60.0);
        power.value.push_back(flies ? 200.0 : 30.0);
    }
    series.tracks = {altitude, throttle, power};
    return series;
}

Track state(const char* name, std::vector<double> time_s, std::vector<double> value) {
    return {.name = name, .source = "EV.Id", .time_s = std::move(time_s), .value = std::move(value)};
}

TEST(HoverRecord, IsThatOfARotorcraftWhoseStateIsKnown) {
    auto series = hopping_copter();
    EXPECT_THAT(segment(series).sorties, IsEmpty()) << "too low for a flight";
    series.tracks.push_back(state("armed", {5.0}, {1.0}));
    const auto sorties = segment(series).sorties;
    ASSERT_EQ(sorties.size(), 1U) << "armed throughout, as if it descended";
    EXPECT_NEAR(sorties[0].start_s(), 20.0, 0.6);
    EXPECT_NEAR(sorties[0].end_s(), 99.5, 0.6);
    series.firmware = "fixedwing";
    EXPECT_THAT(segment(series).sorties, IsEmpty());
}

TEST(HoverRecord, IsSeparatedByALanding) {
    auto series = hopping_copter();
    series.tracks.push_back(state("landed", {19.0, 62.0, 69.0, 101.0}, {0.0, 1.0, 0.0, 1.0}));
    const auto sorties = segment(series).sorties;
    ASSERT_EQ(sorties.size(), 2U);
    EXPECT_NEAR(sorties[0].end_s(), 59.5, 0.6);
    EXPECT_NEAR(sorties[1].start_s(), 70.0, 0.6);
    EXPECT_EQ(segment(series).rests.size(), 3U);
}

TEST(LandDetector, ConfirmsAnEdgeIfItReportsAllTheTime) {
    Track detector = state("landed", {}, {});
    for (int i = 0; i < 20; ++i) {
        detector.time_s.push_back(i);
        detector.value.push_back(i < 5 || i > 15 ? 1.0 : 0.0);
    }
    EXPECT_EQ(confirmed_by_detector(detector, 6.5, false), 5.0);
    EXPECT_EQ(confirmed_by_detector(detector, 7.5, false), 7.5) << "too far";
    EXPECT_EQ(confirmed_by_detector(detector, 6.5, true), 6.5) << "the other turn";
    EXPECT_EQ(confirmed_by_detector(detector, 15.0, true), 16.0);
    EXPECT_EQ(confirmed_by_detector(state("landed", {5.0}, {0.0}), 6.5, false), 6.5);
}

}  // namespace
}  // namespace flightwatt::flight
