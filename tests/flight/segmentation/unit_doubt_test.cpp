#include "flight/segmentation.h"
#include "flight/segmentation/flight_rejection.h"
#include "flight/selected_track.h"
#include "helpers/flown_points.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using test::columns_of;
using test::sortie;
using testing::HasSubstr;

TEST(UnitDoubt, ComparesWithTheClimbRate) {
    const auto warning_of = [](double factor) {
        auto columns = columns_of(sortie(100));
        auto series = test::series_of(columns);
        Track climb{.name = "climb_m_per_s", .source = "GPS.climb", .time_s = columns.time_s};
        const auto& altitude_m = columns.altitude_m;
        for (std::size_t i = 0; i < altitude_m.size(); ++i) {
            climb.value.push_back(i == 0 ? 0.0 : (altitude_m[i] - altitude_m[i - 1]) / 1.1);
        }
        series.tracks.push_back(climb);
        for (auto& track : series.tracks) {
            if (track.name != "altitude_m") continue;
            for (auto& value : track.value) value *= factor;
        }
        const auto warnings = segment(series).warnings;
        return warnings.empty() ? std::string() : warnings.front();
    };
    EXPECT_EQ(warning_of(1.0), "");
    EXPECT_EQ(warning_of(1.65), "");
    EXPECT_THAT(warning_of(1.75), HasSubstr("is one of them in another unit than m?"));
    EXPECT_THAT(warning_of(3.28084),
                HasSubstr("times as much as the climb rate of GPS.climb says: is one of them in feet?"));
    EXPECT_THAT(warning_of(0.3048), HasSubstr("is one of them in feet?"));
}

TEST(UnitDoubt, ComparesWithOtherAltitudes) {
    auto series = test::series_of(columns_of(sortie(100)));
    auto gps = select_track(series, "altitude_m");
    gps.source = "GPS.alt";
    for (auto& value : gps.value) value = 100.0 * value;
    series.tracks.push_back(gps);
    EXPECT_THAT(
        segment(series).warnings,
        testing::Contains(HasSubstr("series CSV moves 0.01 times as much as GPS.alt says: is one of them in cm?")));
}

struct Climb {
    double own_m;  ///< in ten seconds
    double gps_m;
    int windows;  ///< of ten seconds
};

/// What is doubted of an altitude that climbs so beside another.
std::string doubt_of(const std::vector<Climb>& climbs) {
    FlightSeries series;
    series.tracks = {{.name = "altitude_m", .source = "ESTIMATOR.z", .time_s = {0.0, 1.0}, .value = {0.0, 1.0}},
                     {.name = "altitude_m", .source = "GPS.alt", .time_s = {0.0}, .value = {0.0}}};
    auto& gps = series.tracks.back();
    ResampledFlight grid;
    grid.altitude_m = {0.0};
    for (const auto& [own_m, gps_m, windows] : climbs) {
        for (int step = 0; step < 20 * windows; ++step) {
            grid.altitude_m.push_back(grid.altitude_m.back() + own_m / 20.0);
            gps.time_s.push_back(gps.time_s.back() + grid.step_s);
            gps.value.push_back(gps.value.back() + gps_m / 20.0);
        }
    }
    grid.pieces = {{0, grid.size()}};
    return suspected_unit_error(series, grid);
}

TEST(UnitDoubt, IsOfFiveWindowsOfTenSecondsInWhichOneMovesByFiveMetres) {
    EXPECT_NE(doubt_of({{5.1, 2.5, 9}}), "");
    EXPECT_EQ(doubt_of({{4.9, 2.4, 9}}), "");
    EXPECT_NE(doubt_of({{10.0, 5.0, 5}}), "");
    EXPECT_EQ(doubt_of({{10.0, 5.0, 4}}), "");
}

TEST(UnitDoubt, IsOfMotionsThatHaveToDoWithEachOther) {
    EXPECT_NE(doubt_of({{40.0, 10.0, 13}, {0.0, 10.0, 7}}), "") << "a correlation of 0.806";
    EXPECT_EQ(doubt_of({{40.0, 10.0, 12}, {0.0, 10.0, 8}}), "") << "0.775";
}

TEST(UnitDoubt, NamesTheUnitNearToTheFactor) {
    for (const auto& [factor, unit] : {std::pair{3.28084, "feet"}, std::pair{100.0, "cm"}, std::pair{1000.0, "mm"}}) {
        const auto asks_for = [](const std::string& name) { return HasSubstr("in " + name + "?"); };
        EXPECT_THAT(doubt_of({{0.81 * 10.0 * factor, 10.0, 9}}), asks_for(unit));
        EXPECT_THAT(doubt_of({{1.24 * 10.0 * factor, 10.0, 9}}), asks_for(unit));
        EXPECT_THAT(doubt_of({{0.79 * 10.0 * factor, 10.0, 9}}), asks_for("another unit than m"));
        EXPECT_THAT(doubt_of({{1.26 * 10.0 * factor, 10.0, 9}}), asks_for("another unit than m"));
    }
}

}  // namespace
}  // namespace flightwatt::flight
