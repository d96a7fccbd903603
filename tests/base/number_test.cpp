#include "base/number.h"

#include <array>
#include <charconv>
#include <cmath>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt {
namespace {

TEST(ParseNumber, ReadsWhatPaparazziWrites) {
    EXPECT_EQ(parse_number("235."), 235.0);
    EXPECT_EQ(parse_number("-0."), 0.0);
    EXPECT_TRUE(std::signbit(*parse_number("-0.")));
    EXPECT_EQ(parse_number("-3e-06"), -3e-06);
    EXPECT_EQ(parse_number("12.421459"), 12.421459);
    EXPECT_EQ(parse_number(".5"), 0.5);
    EXPECT_EQ(parse_number("+2"), 2.0);
    EXPECT_EQ(parse_number("123456789012345678901"), 123456789012345678901.0);
}

TEST(ParseNumber, RefusesWhatIsNoWholeFiniteNumber) {
    for (const auto* text :
         {"", " ", "12,5", "12.5x", "nan", "inf", "-", ".", "1e", "1 ", " 1", "0x10", "--1", "1.2.3", "1e999"}) {
        EXPECT_FALSE(parse_number(text).has_value()) << "'" << text << "'";
        EXPECT_TRUE(std::isnan(number_or_nan(text))) << "'" << text << "'";
    }
}

TEST(ParseNumber, IsCorrectlyRoundedOnBothPaths) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> mantissa(-1e6, 1e6);
    std::uniform_int_distribution<int> decimals(0, 17);
    for (int i = 0; i < 20000; ++i) {
        char text[64];
        const auto end =
            std::to_chars(text, text + sizeof text, mantissa(random), std::chars_format::fixed, decimals(random)).ptr;
        double expected = 0.0;
        std::from_chars(text, end, expected);
        const auto parsed = parse_number({text, static_cast<std::size_t>(end - text)});
        ASSERT_TRUE(parsed.has_value());
        ASSERT_EQ(*parsed, expected) << std::string(text, end);
    }
}

TEST(LastTrue, ReturnsAValueThatHoldsNearTheFirstThatDoesNot) {
    const double last = last_true(0.0, 8.0, 20, [](double x) { return x < 3.0; });
    EXPECT_LT(last, 3.0);
    EXPECT_NEAR(last, 3.0, 1e-5);
    EXPECT_EQ(last_true(0.0, 8.0, 2, [](double x) { return x < 3.0; }), 2.0);
}

TEST(LastTrue, GoesDownAsWellAsUp) {
    EXPECT_EQ(last_true(8.0, 0.0, 2, [](double x) { return x > 3.0; }), 4.0);
}

TEST(LastTrue, TriesNeitherOfItsEnds) {
    EXPECT_EQ(last_true(1.0, 2.0, 0, [](double) { return false; }), 1.0);
    EXPECT_EQ(last_true(0.0, 1.0, 1, [](double) { return true; }), 0.5);
}

}  // namespace
}  // namespace flightwatt
