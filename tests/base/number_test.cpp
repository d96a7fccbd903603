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

std::string written(double value) {
    std::array<char, number_buffer_size> text{};
    return {text.data(), write_number(text.data(), value)};
}

TEST(WriteNumber, WritesWhatFmtWrites) {
    for (const double value : {0.0,
                               -0.0,
                               1.0,
                               -1.0,
                               12.5,
                               100.0,
                               0.1,
                               0.0001,
                               0.00010001,
                               0.00009,
                               1e-7,
                               9999999.0,
                               9999999.99999999,
                               10000000.0,
                               1e7 + 0.5,
                               123456.12345678,
                               1e15,
                               1e16,
                               1e300,
                               5e-324,
                               0.1 + 0.2,
                               1.0 / 3.0,
                               -43.123456789,
                               4'812'345.67,
                               1.7976931348623157e308})
        EXPECT_EQ(written(value), fmt::format("{}", value));
}

TEST(WriteNumber, WritesWhatFmtWritesOfDecimalsAndTheirNeighbours) {
    std::mt19937_64 random(5);
    for (int i = 0; i < 200'000; ++i) {
        const auto digits = static_cast<double>(random() % std::uint64_t(std::pow(10.0, 1 + i % 16)));
        const double value = (i % 2 == 0 ? 1.0 : -1.0) * digits / std::pow(10.0, random() % 12);
        for (const double near : {value, std::nextafter(value, 1e300), std::nextafter(value, -1e300)})
            ASSERT_EQ(written(near), fmt::format("{}", near));
    }
}

TEST(WriteNumber, WritesWhatFmtWritesOfAnyDigits) {
    std::mt19937_64 random(11);
    for (int i = 0; i < 200'000; ++i) {
        const double value = std::ldexp(static_cast<double>(random() >> 11), static_cast<int>(random() % 72) - 68);
        for (const double near : {value, -value, value * 57.29577951308232, std::floor(value)})
            ASSERT_EQ(written(near), fmt::format("{}", near));
    }
}

TEST(ParseUnsigned, ReadsWholeIntegersOnly) {
    EXPECT_EQ(parse_unsigned("42"), 42u);
    EXPECT_FALSE(parse_unsigned("-1").has_value());
    EXPECT_FALSE(parse_unsigned("4.2").has_value());
    EXPECT_FALSE(parse_unsigned("").has_value());
}

}  // namespace
}  // namespace flightwatt
