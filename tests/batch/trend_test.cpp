#include "batch/trend.h"

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

using testing::HasSubstr;

/// Flights some days apart, with a slope, and scatter of a heavy-tailed kind: Student's t of three degrees of freedom.
std::vector<DatedValue> scattered(std::size_t flights, double per_day, std::mt19937& random) {
    std::uniform_real_distribution<double> apart(0.2, 6.0);
    std::student_t_distribution<double> scatter(3.0);
    std::vector<DatedValue> values;
    double day = 18000.0;
    for (std::size_t i = 0; i < flights; ++i) {
        day += apart(random);
        values.push_back({day, 20.0 + per_day * (day - 18000.0) + 0.5 * scatter(random)});
    }
    return values;
}

TEST(Trend, OfAStraightLineIsItsSlope) {
    std::vector<DatedValue> values;
    for (const double day : {3.0, 0.0, 1.5, 7.0, 10.0, 4.0}) values.push_back({day, 5.0 - 0.25 * day});
    const auto answer = estimate_trend(values);
    ASSERT_TRUE(answer.trend) << answer.no_trend_reason;
    EXPECT_EQ(answer.trend->flights, 6u);
    EXPECT_DOUBLE_EQ(answer.trend->per_day, -0.25);
    EXPECT_DOUBLE_EQ(answer.trend->low_per_day, -0.25);
    EXPECT_DOUBLE_EQ(answer.trend->median, 5.0 - 0.25 * 3.5);
    EXPECT_TRUE(is_significant(*answer.trend));
}

// By hand: of five flights one order in 120 has no inversion, and 4 in 120 one, which is more than 2.5 %. So the
// interval goes from the least of the ten slopes to the greatest.
TEST(Trend, OfFiveFlightsReachesToTheOutermostSlopes) {
    const std::vector<DatedValue> values{{0, 1}, {1, 3}, {2, 2}, {3, 5}, {4, 9}};
    const auto answer = estimate_trend(values);
    ASSERT_TRUE(answer.trend);
    EXPECT_DOUBLE_EQ(answer.trend->low_per_day, -1.0);
    EXPECT_DOUBLE_EQ(answer.trend->high_per_day, 4.0);
    EXPECT_DOUBLE_EQ(answer.trend->per_day, 2.0);  // of -1, 0.5, 1, 1.333, 2 | 2, 2.333, 3, 3.5, 4
    EXPECT_FALSE(is_significant(*answer.trend));
}

TEST(Trend, IsNotMovedByAnOddFlight) {
    std::mt19937 random(7);
    auto values = scattered(20, 0.3, random);
    const auto sound = estimate_trend(values).trend.value();
    values[18].value = 1e6;
    const auto odd = estimate_trend(values).trend.value();
    EXPECT_NEAR(odd.per_day, sound.per_day, 0.1);
    EXPECT_TRUE(is_significant(odd));
}

TEST(Trend, HoldsTheTrueSlopeAsOftenAsItSays) {
    constexpr int rounds = 1500;
    for (const std::size_t flights : {5, 8, 20, 60}) {
        std::mt19937 random(static_cast<unsigned>(flights));
        int held = 0;
        int alarms = 0;
        for (int i = 0; i < rounds; ++i) {
            const auto rising = estimate_trend(scattered(flights, 0.3, random)).trend.value();
            if (rising.low_per_day <= 0.3 && 0.3 <= rising.high_per_day) ++held;
            if (is_significant(estimate_trend(scattered(flights, 0.0, random)).trend.value())) ++alarms;
        }
        const double standard_error = std::sqrt(0.95 * 0.05 * rounds);
        EXPECT_GT(held, 0.95 * rounds - 3.0 * standard_error) << flights;
        EXPECT_LT(alarms, 0.05 * rounds + 3.0 * standard_error) << flights;
        // Few orders of few flights: 1.7 % is the largest chance below 5 % that five of them have.
        EXPECT_GT(alarms, (flights == 5 ? 0.005 : 0.02) * rounds) << flights;
    }
}

TEST(Trend, TakesFlightsAtOneTime) {
    std::vector<DatedValue> values;
    for (int day = 0; day < 8; ++day) {
        values.push_back({static_cast<double>(day), 2.0 * day});
        values.push_back({static_cast<double>(day), 2.0 * day + 0.5});
    }
    const auto answer = estimate_trend(values);
    ASSERT_TRUE(answer.trend) << answer.no_trend_reason;
    EXPECT_NEAR(answer.trend->per_day, 2.0, 1e-12);
    EXPECT_TRUE(is_significant(*answer.trend));
}

TEST(Trend, IsNoneOfTooFewFlightsOrDays) {
    EXPECT_THAT(estimate_trend({}).no_trend_reason, HasSubstr("0 flights, expected 5"));
    const std::vector<DatedValue> four{{0, 1}, {1, 2}, {2, 3}, {3, 4}};
    EXPECT_FALSE(estimate_trend(four).trend);
    EXPECT_THAT(estimate_trend(four).no_trend_reason, HasSubstr("4 flights"));
    std::vector<DatedValue> values;
    for (int i = 0; i < 10; ++i) values.push_back({100.0 + 0.05 * i, static_cast<double>(i)});
    EXPECT_THAT(estimate_trend(values).no_trend_reason, HasSubstr("one day"));
    values.push_back({101.5, 3.0});
    EXPECT_THAT(estimate_trend(values).no_trend_reason, HasSubstr("two days"));
    values.push_back({102.5, 3.0});
    EXPECT_TRUE(estimate_trend(values).trend);
}

}  // namespace
}  // namespace flightwatt::batch
