#include "mission/sampling/flight_lines.h"

#include "base/statistics.h"
#include "helpers/steady_mission.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

/// Its flights lose 55.6 +- 2.78 points.
Mission uncertain_level() {
    auto mission = test::steady_mission();
    mission.uncertainty.level_sd_percent[flight::Phase::cruise] = 5.0;
    return mission;
}

/// Flights with more than 21 W are cut off, all others keep 39 % and more.
Mission cut_off_above_21_w() {
    auto mission = uncertain_level();
    mission.battery.resistance_ohm = 0.5;
    mission.battery.capacity_ah = 2.0;
    // 21 W from 10 V behind 0.5 ohm: I = (10 - sqrt(100 - 4 * 0.5 * 21)) / (2 * 0.5)
    mission.cutoff_voltage_v = 10.0 - 0.5 * (10.0 - std::sqrt(58.0));
    return mission;
}

TEST(FlightLines, FindWhereFlightsFallBelow) {
    const auto mission = uncertain_level();
    const auto spreads = collect_uncertainty(mission);
    const LineSampler lines(mission, spreads);
    EXPECT_NEAR(lines.nominal_percent(), 100.0 - 20.0 / 0.36, 1e-9);
    EXPECT_NEAR(lines.sd_percent(), 1.0 / 0.36, 1e-9);
    EXPECT_FALSE(lines.some_fail());
    LineSearch search;
    lines.find_thresholds(0, lines.nominal_percent() - 3.0 * lines.sd_percent(), search);
    EXPECT_NEAR(search.threshold, 3.0, 1e-3);
}

TEST(FlightLines, RememberWhatTheyFlew) {
    const auto mission = cut_off_above_21_w();
    const auto spreads = collect_uncertainty(mission);
    const LineSampler lines(mission, spreads);
    LineSamplingEstimate below(lines, 30.0);
    EXPECT_NEAR(below.chance(), 0.5 * std::erfc(std::sqrt(0.5)), 1e-3);  // 5 % above 20 W
    const auto flown = lines.flown();
    below.move_to(10.0);  // fails at once: the same flights
    EXPECT_EQ(lines.flown(), flown);
    EXPECT_NEAR(below.chance(), 0.5 * std::erfc(std::sqrt(0.5)), 1e-3);
    EXPECT_TRUE(lines.some_fail());
}

TEST(FlightLines, TellTheSameChanceInAnyDirection) {
    auto mission = uncertain_level();
    mission.uncertainty.duration_sd_s[flight::Phase::cruise] = 100.0;
    const auto spreads = collect_uncertainty(mission);
    LineSampler lines(mission, spreads);
    LineSamplingEstimate before(lines, 30.0);
    const auto lines_before = before.lines();
    before.double_lines();
    EXPECT_EQ(before.lines(), 2 * lines_before);
    const double chance = before.chance();
    const double error = before.standard_error();
    EXPECT_GT(chance, 0.005);
    lines.redirect_to_failures(before.searches());
    const LineSamplingEstimate after(lines, 30.0);
    EXPECT_NEAR(after.chance(), chance, 4.0 * (error + after.standard_error()) + 1e-5);
}

}  // namespace
}  // namespace flightwatt::mission
