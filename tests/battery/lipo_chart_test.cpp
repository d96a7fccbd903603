#include "battery/lipo_chart.h"

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

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
    EXPECT_EQ(lipo_cells(0.0), 1);
}

}  // namespace
}  // namespace flightwatt::battery
