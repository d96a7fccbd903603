#include "telemetry/binary/wire_value.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

TEST(WireValue, IsTheShortestDecimalOfAFloat) {
    for (const double value : {11.62, 0.1, -3.5e-7, 1.5e30, 235.0, 1e-40})
        EXPECT_EQ(shortest_decimal(static_cast<float>(value)), value);
}

TEST(WireValue, TakesWhatIsNoNumberAsItIs) {
    EXPECT_TRUE(std::isnan(shortest_decimal(std::numeric_limits<float>::quiet_NaN())));
    EXPECT_EQ(shortest_decimal(-std::numeric_limits<float>::infinity()), -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::signbit(shortest_decimal(-0.0F)));
}

TEST(WireValue, IsLittleEndian) {
    EXPECT_EQ(wire_bytes(std::uint32_t{0x01020304}), "\x04\x03\x02\x01");
    EXPECT_EQ(wire_number<std::int16_t>("\xFE\xFF"), -2);
    EXPECT_EQ(wire_number<float>(wire_bytes(11.62F).data()), 11.62F);
}

}  // namespace
}  // namespace flightwatt::telemetry
