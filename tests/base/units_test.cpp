#include "base/units.h"

#include <gtest/gtest.h>

namespace flightwatt::units {
namespace {

void expect_unit(const char* text, Quantity quantity, double factor) {
    const auto unit = parse_unit(text);
    ASSERT_TRUE(unit.has_value()) << text;
    EXPECT_EQ(unit->quantity, quantity) << text;
    EXPECT_DOUBLE_EQ(unit->factor, factor) << text;
}

TEST(Units, ReadsTheUnitsOfPaparazzi) {
    expect_unit("V", Quantity::volt, 1.0);
    expect_unit("deg celcius", Quantity::celsius, 1.0);
    expect_unit("1e-1V", Quantity::volt, 0.1);
    expect_unit("1e-2A", Quantity::ampere, 0.01);
    expect_unit("decivolt", Quantity::volt, 0.1);
    expect_unit("mAh", Quantity::ampere_hour, 0.001);
    expect_unit("cm/s", Quantity::metre_per_second, 0.01);
    expect_unit("mm", Quantity::metre, 0.001);
    expect_unit("decideg", Quantity::degree, 0.1);
    expect_unit("pprz", Quantity::percent, 100.0 / 9600.0);
}

TEST(Units, ReadsTheUnitsOfTables) {
    expect_unit("ft", Quantity::metre, 0.3048);
    expect_unit("feet", Quantity::metre, 0.3048);
    expect_unit("mph", Quantity::metre_per_second, 0.44704);
    expect_unit("km/h", Quantity::metre_per_second, 1.0 / 3.6);
    expect_unit("kt", Quantity::metre_per_second, 1852.0 / 3600.0);
    expect_unit("mW", Quantity::watt, 1e-3);
    expect_unit("min", Quantity::second, 60.0);
    expect_unit("°", Quantity::degree, 1.0);
}

TEST(Units, KnowsNoOthers) {
    for (const auto* text : {"", "rpm", "byte_mask", "bool", "furlong", "1e-1"}) {
        EXPECT_FALSE(parse_unit(text).has_value()) << text;
    }
}

TEST(Units, ConvertsThereAndBack) {
    EXPECT_DOUBLE_EQ(joule_from_wh(wh_from_joule(18876.0)), 18876.0);
    EXPECT_DOUBLE_EQ(percent_from_pprz(9600.0), 100.0);
    EXPECT_DOUBLE_EQ(pprz_from_percent(percent_from_pprz(4294.0)), 4294.0);
}

}  // namespace
}  // namespace flightwatt::units
