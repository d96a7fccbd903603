#include "telemetry/binary/wire_value.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

/// Floats of all bits, of sensors (decimals of few digits) and halfway between decimals, whatever was found before.
TEST(WireValue, IsTheShortestDecimalOfAFloat) {
    std::mt19937_64 random(7);
    const auto below = [&](std::uint64_t end) { return static_cast<int>(random() % end); };
    for (int i = 0; i < 300'000; ++i) {
        float value = 0.0F;
        if (i % 3 == 0) value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        if (i % 3 == 1) value = static_cast<float>((below(2'000'000'000) - 1e9) / std::pow(10.0, below(12)));
        if (i % 3 == 2) value = std::ldexp(static_cast<float>(below(1 << 24)), -below(50));
        if (!std::isfinite(value)) continue;
        int decimals = below(21);
        const double expected = shortest_decimal_general(value);
        ASSERT_EQ(shortest_decimal(value, decimals), expected) << "round " << i;
        ASSERT_EQ(shortest_decimal(value), expected) << "round " << i;
    }
}

TEST(WireValue, TakesWhatIsNoNumberAsItIs) {
    EXPECT_TRUE(std::isnan(shortest_decimal(std::numeric_limits<float>::quiet_NaN())));
    EXPECT_EQ(shortest_decimal(-std::numeric_limits<float>::infinity()), -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::signbit(shortest_decimal(-0.0F)));
}

}  // namespace
}  // namespace flightwatt::telemetry
