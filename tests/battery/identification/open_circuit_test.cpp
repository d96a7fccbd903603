// The LiPo chart, and what it stands in for: the capacity, and the end of the curve.

#include "battery/identification/open_circuit.h"

#include "base/error.h"

#include <algorithm>

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
    EXPECT_DOUBLE_EQ(lipo_chart_voltage_v(100.0), 4.20);
    EXPECT_DOUBLE_EQ(lipo_chart_voltage_v(50.0), 3.84);
    EXPECT_DOUBLE_EQ(lipo_chart_voltage_v(0.0), 3.27);
    EXPECT_DOUBLE_EQ(lipo_chart_voltage_v(97.5), 0.5 * (4.15 + 4.20));
}

TEST(LipoChart, EndsWhereItIsFullAndEmpty) {
    EXPECT_DOUBLE_EQ(lipo_chart_voltage_v(120.0), 4.20);
    EXPECT_DOUBLE_EQ(lipo_chart_voltage_v(-5.0), 3.27);
    EXPECT_EQ(lipo_chart_soc_percent(4.3), 100.0);
    EXPECT_EQ(lipo_chart_soc_percent(4.20), 100.0);
    EXPECT_EQ(lipo_chart_soc_percent(3.0), 0.0);
}

TEST(LipoChart, RisesAndIsInverted) {
    for (double soc_percent = 0.5; soc_percent < 100.0; soc_percent += 0.5) {
        EXPECT_GT(lipo_chart_voltage_v(soc_percent), lipo_chart_voltage_v(soc_percent - 0.5)) << soc_percent;
        EXPECT_NEAR(lipo_chart_soc_percent(lipo_chart_voltage_v(soc_percent)), soc_percent, 1e-9);
    }
}

TEST(LipoCells, AreAsManyAsTheRestingVoltageNeeds) {
    EXPECT_EQ(lipo_cells(12.6), 3);
    EXPECT_EQ(lipo_cells(12.75), 3) << "4.25 V a cell is still charged";
    EXPECT_EQ(lipo_cells(12.76), 4);
    EXPECT_EQ(lipo_cells(4.2), 1);
    EXPECT_EQ(lipo_cells(16.8), 4);
    EXPECT_EQ(lipo_cells(25.2), 6);
    EXPECT_EQ(lipo_cells(0.0), 1);
}

TEST(OpenCircuit, TakesTheCapacityThatIsGivenOrFlown) {
    EXPECT_EQ(capacity_of(fit_down_to(3.8), 0.0, 3, 2.2).value_ah, 2.2);
    EXPECT_EQ(capacity_of(fit_down_to(3.8), 0.0, 3, 2.2).origin, CapacityOrigin::given);
    EXPECT_THROW(capacity_of(fit_down_to(3.8), 0.0, 3, 1.1), UsageError);
    const auto flown = capacity_of(fit_down_to(3.4), 0.0, 3, std::nullopt);
    EXPECT_EQ(flown.value_ah, 1.2);
    EXPECT_EQ(flown.origin, CapacityOrigin::flown);
}

TEST(OpenCircuit, ReadsTheCapacityOffTheChartOtherwise) {
    const auto half = capacity_of(fit_down_to(3.84), 0.0, 3, std::nullopt);
    EXPECT_EQ(half.origin, CapacityOrigin::chart);
    EXPECT_NEAR(half.value_ah, 2.4, 1e-9);
    ASSERT_TRUE(half.interval_ah);
    EXPECT_NEAR(half.interval_ah->low, 1.2 / (100.0 - lipo_chart_soc_percent(3.84 - 1.96 * 0.03)) * 100.0, 1e-3);
    EXPECT_GT(half.interval_ah->high, 2.9);
    const auto unsure =
        capacity_of(fit_down_to(3.84), 3.0 * 0.03, 3, std::nullopt);  // the voltage as much as the chart
    EXPECT_LT(unsure.interval_ah->low, half.interval_ah->low);
    EXPECT_GT(unsure.interval_ah->high, half.interval_ah->high);
    EXPECT_THROW(capacity_of(fit_down_to(4.19), 0.0, 3, std::nullopt), NoAnswerError);
}

TEST(OpenCircuit, GoesOnInParallelToTheChart) {
    const auto [curve, error_v, known_to] = extended_curve(fit_down_to(3.84), {0.01, 0.02, 0.03}, 2.4, 3);
    EXPECT_DOUBLE_EQ(known_to, 50.0);
    EXPECT_EQ(curve.soc_percent.front(), 0.0);
    EXPECT_EQ(curve.soc_percent.back(), 100.0);
    EXPECT_EQ(curve.voltage_v.back(), 12.5);
    EXPECT_NEAR(curve.voltage_v.front(), 3.0 * 3.27, 1e-9);
    EXPECT_TRUE(std::is_sorted(curve.voltage_v.begin(), curve.voltage_v.end()));
    EXPECT_EQ(curve.soc_percent.size(), 13U);  // 0 to 45 in steps of 5, and the three knots
    EXPECT_NEAR(error_v.front(), 0.0949, 1e-4);
    EXPECT_EQ(error_v.back(), 0.01);
}

TEST(OpenCircuit, NeedsNoChartWhereAllWasFlown) {
    const auto [curve, error_v, known_to] = extended_curve(fit_down_to(3.4), {0.01, 0.02, 0.03}, 1.2, 3);
    EXPECT_EQ(known_to, 0.0);
    EXPECT_EQ(curve.soc_percent, (std::vector<double>{0.0, 50.0, 100.0}));
    EXPECT_EQ(error_v, (std::vector<double>{0.03, 0.02, 0.01}));
}

}  // namespace
}  // namespace flightwatt::battery
