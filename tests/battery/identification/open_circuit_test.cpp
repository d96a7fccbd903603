// The charts, and what they replace: the capacity, and the end of the curve.

#include "battery/identification/open_circuit.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

/// A fit that followed three cells from full down to `last_cell_v` while drawing 1.2 Ah.
CircuitFit fit_down_to(double last_cell_v) {
    CircuitFit fit;
    fit.knots_ah = {0.0, 0.6, 1.2};
    fit.open_circuit_v = {12.5, (12.5 + 3.0 * last_cell_v) / 2.0, 3.0 * last_cell_v};
    return fit;
}

TEST(LipoChart, HasThePublishedVoltages) {
    EXPECT_DOUBLE_EQ(chart_voltage_v(Chemistry::lipo, 100.0), 4.20);
    EXPECT_DOUBLE_EQ(chart_voltage_v(Chemistry::lipo, 50.0), 3.84);
    EXPECT_DOUBLE_EQ(chart_voltage_v(Chemistry::lipo, 0.0), 3.27);
    EXPECT_DOUBLE_EQ(chart_voltage_v(Chemistry::lipo, 97.5), 0.5 * (4.15 + 4.20));
}

TEST(LipoChart, EndsWhereItIsFullAndEmpty) {
    EXPECT_DOUBLE_EQ(chart_voltage_v(Chemistry::lipo, 120.0), 4.20);
    EXPECT_DOUBLE_EQ(chart_voltage_v(Chemistry::lipo, -5.0), 3.27);
}

TEST(Charts, Rise) {
    for (const auto chemistry : {Chemistry::lipo, Chemistry::nmc, Chemistry::high_voltage})
        for (double soc_percent = 0.5; soc_percent < 100.0; soc_percent += 0.5)
            EXPECT_GT(chart_voltage_v(chemistry, soc_percent), chart_voltage_v(chemistry, soc_percent - 0.5))
                << to_string(chemistry) << " at " << soc_percent;
}

TEST(LipoCells, AreAsManyAsTheRestingVoltageNeeds) {
    EXPECT_EQ(lipo_cells(12.6), 3);
    EXPECT_EQ(lipo_cells(12.75), 3) << "4.25 V a cell is still charged";
    EXPECT_EQ(lipo_cells(12.76), 3) << "four would be nearly empty";
    EXPECT_EQ(lipo_cells(13.15), 4);
    EXPECT_EQ(lipo_cells(4.2), 1);
    EXPECT_EQ(lipo_cells(16.8), 4);
    EXPECT_EQ(lipo_cells(25.2), 6);
    EXPECT_EQ(lipo_cells(0.0), 1);
}

TEST(LipoCells, AreRejectedWhereTheVoltageExcludesThem) {
    EXPECT_NO_THROW(require_possible_cells("a", 13.5, 3)) << "4.5 V a cell";
    EXPECT_NO_THROW(require_possible_cells("a", 12.5, 5)) << "2.5 V a cell";
    EXPECT_THROW(require_possible_cells("a", 13.51, 3), UsageError);
    EXPECT_THROW(require_possible_cells("a", 12.49, 5), UsageError);
    try {
        require_possible_cells("a", 12.498, 2);
        FAIL() << "two cells of 6.25 V were accepted";
    } catch (const UsageError& error) {
        EXPECT_STREQ(
            error.what(),
            "--cells 2: a, the fullest flight, rests at 12.498 V, 6.249 V a cell, and lithium cells rest at 2.5 to 4.5 "
            "V: expected 3 to 4 cells");
    }
}

TEST(LipoCells, AreDoubtfulOutsideOfTheChart) {
    EXPECT_EQ(cells_warning(12.6, 3, false), "");
    EXPECT_EQ(cells_warning(3.0 * 3.27, 3, true), "");
    EXPECT_NE(cells_warning(3.0 * 3.269, 3, true).find("below an empty LiPo cell (3.27 V)"), std::string::npos);
    EXPECT_EQ(cells_warning(6.0 * 4.25, 6, true), "");
    EXPECT_NE(cells_warning(6.0 * 4.251, 6, true).find("above a full LiPo cell (4.20 V)"), std::string::npos);
}

TEST(LipoCells, MayBeOneLessOfHighVoltage) {
    const double full_v = 6.0 * 4.35;  // six cells that a guess takes for seven
    EXPECT_EQ(lipo_cells(full_v), 6) << "seven would be nearly empty";
    EXPECT_EQ(lipo_cells(6.0 * 4.38 - 1e-9), 7) << "more than a quarter is left in seven";
    EXPECT_EQ(lipo_cells(5.0 * 4.381), 6) << "more than full high-voltage cells";
    EXPECT_EQ(cells_warning(full_v, 7, false),
              "7 cells assumed, at 3.73 V each; 6 full high-voltage cells rest at 4.35 V each: give --cells");
    EXPECT_EQ(cells_warning(full_v, 7, true), "") << "seven were given";
    EXPECT_NE(cells_warning(6.0 * 4.449, 7, false), "");
    EXPECT_EQ(cells_warning(6.0 * 4.451, 7, false), "") << "more than a full cell of any chemistry";
    EXPECT_EQ(cells_warning(4.1, 1, false), "");
}

TEST(OpenCircuit, TakesTheMedianOfWhatIsProbable) {
    const std::vector<CapacityHypothesis> posterior{{1.0, 0.0, 0.2}, {2.0, 0.0, 0.5}, {3.0, 0.0, 0.3}};
    const auto capacity = estimate_capacity(1.0, posterior, std::nullopt);
    EXPECT_EQ(capacity.value_ah, 2.0);
    EXPECT_EQ(capacity.origin, CapacityOrigin::chart);
    ASSERT_TRUE(capacity.interval_ah);
    EXPECT_EQ(*capacity.interval_ah, (Interval{1.0, 3.0}));
    EXPECT_EQ(estimate_capacity(1.95, posterior, std::nullopt).origin, CapacityOrigin::measured);
    EXPECT_THROW(estimate_capacity(0.05, posterior, std::nullopt), NoResultError);
    EXPECT_EQ(estimate_capacity(1.0, posterior, 2.2).value_ah, 2.2);
    EXPECT_EQ(estimate_capacity(1.0, posterior, 2.2).origin, CapacityOrigin::given);
    EXPECT_FALSE(estimate_capacity(1.0, posterior, 2.2).interval_ah);
}

TEST(OpenCircuit, GoesOnInParallelToTheChart) {
    const auto extended = extrapolate_curve(fit_down_to(3.84), {0.01, 0.02, 0.03}, Chemistry::lipo, 2.4, 0.0);
    const auto& curve = extended.curve;
    EXPECT_DOUBLE_EQ(extended.known_down_to_percent, 50.0);
    EXPECT_DOUBLE_EQ(extended.known_up_to_percent, 100.0);
    EXPECT_EQ(curve.soc_percent.front(), 0.0);
    EXPECT_EQ(curve.soc_percent.back(), 100.0);
    EXPECT_EQ(curve.voltage_v.back(), 12.5);
    EXPECT_NEAR(curve.voltage_v.front(), 3.0 * 3.27, 1e-9);
    EXPECT_TRUE(std::is_sorted(curve.voltage_v.begin(), curve.voltage_v.end()));
    EXPECT_EQ(curve.soc_percent.size(), 13U);  // 0 to 45 in steps of 5, and the three knots
    const double far_v = extrapolation_sd_v(Chemistry::lipo, 0.0, 50.0);
    EXPECT_NEAR(extended.standard_error_v.front(), std::hypot(0.03, 3.0 * far_v), 1e-9);
    EXPECT_EQ(extended.standard_error_v.back(), 0.01);
}

TEST(OpenCircuit, GoesOnAboveWhatWasFlownToo) {
    const auto extended =
        extrapolate_curve(fit_down_to(3.84), {0.01, 0.02, 0.03}, Chemistry::lipo, 2.4, 0.6);  // from 75 to 25 %
    const auto& [soc, volts] = extended.curve;
    EXPECT_DOUBLE_EQ(extended.known_up_to_percent, 75.0);
    EXPECT_DOUBLE_EQ(extended.known_down_to_percent, 25.0);
    EXPECT_EQ(soc.back(), 100.0);
    EXPECT_NEAR(volts.back(), 12.5 + 3.0 * (4.20 - 3.98), 1e-9);
    const auto nmc = extrapolate_curve(fit_down_to(3.84), {0.01, 0.02, 0.03}, Chemistry::nmc, 2.4, 0.6);
    EXPECT_NEAR(nmc.curve.voltage_v.back(), 12.5 + 3.0 * (4.19 - 3.96), 1e-9);
    EXPECT_TRUE(std::ranges::adjacent_find(soc, std::greater_equal<>()) == soc.end());
}

TEST(OpenCircuit, NeedsNoChartWhereAllWasFlown) {
    const auto extended = extrapolate_curve(fit_down_to(3.4), {0.01, 0.02, 0.03}, Chemistry::lipo, 1.2, 0.0);
    EXPECT_EQ(extended.known_down_to_percent, 0.0);
    EXPECT_EQ(extended.curve.soc_percent, (std::vector<double>{0.0, 50.0, 100.0}));
    EXPECT_EQ(extended.standard_error_v, (std::vector<double>{0.03, 0.02, 0.01}));
}

TEST(OpenCircuit, EndsWhereACapacityThatWasGivenEnds) {
    const auto extended = extrapolate_curve(fit_down_to(3.4), {0.01, 0.02, 0.03}, Chemistry::lipo, 1.15, 0.0);
    EXPECT_EQ(extended.curve.soc_percent.size(), 3U);
    EXPECT_EQ(extended.curve.soc_percent.front(), 0.0);
    EXPECT_EQ(extended.curve.voltage_v.front(), 3.0 * 3.4);
}

}  // namespace
}  // namespace flightwatt::battery
