#include "base/clock_time.h"

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

double seconds_of(std::string_view text) {
    const auto time = parse_clock_time(text);
    return time ? time->time_s : -1.0;
}

TEST(ClockTime, ReadsTimesOfTheDayAndDates) {
    EXPECT_DOUBLE_EQ(seconds_of("10:17:15.060"), 37035.06);
    EXPECT_DOUBLE_EQ(seconds_of("0:00:01,5"), 1.5);
    EXPECT_DOUBLE_EQ(seconds_of("2026-01-02"), 1767312000.0);
    EXPECT_DOUBLE_EQ(seconds_of("2026-01-02 10:00:00"), 1767348000.0);
    EXPECT_DOUBLE_EQ(seconds_of("2026/01/02 10:00:00"), 1767348000.0);
    EXPECT_DOUBLE_EQ(seconds_of("2026-01-02T10:00:00.25Z"), 1767348000.25);
    EXPECT_DOUBLE_EQ(seconds_of("2026-01-02T10:00:00+01:30"), 1767348000.0 - 5400.0);
    EXPECT_DOUBLE_EQ(seconds_of("2026-01-02T10:00:00-0130"), 1767348000.0 + 5400.0);
    EXPECT_DOUBLE_EQ(seconds_of("2026-01-02T10:00:00+02"), 1767348000.0 - 7200.0);
    EXPECT_FALSE(parse_clock_time("10:00:00")->has_date);
    EXPECT_FALSE(parse_clock_time("2026-01-02")->has_time);
}

TEST(ClockTime, ReadsTwelveHours) {
    EXPECT_DOUBLE_EQ(seconds_of("12:00:01.5 AM"), 1.5);
    EXPECT_DOUBLE_EQ(seconds_of("11:59:59am"), 43199.0);
    EXPECT_DOUBLE_EQ(seconds_of("12:00:00 pm"), 43200.0);
    EXPECT_DOUBLE_EQ(seconds_of("2026-01-02 1:00:00 PM"), 1767312000.0 + 46800.0);
}

TEST(ClockTime, ReadsNothingThatMayBeAnotherTime) {
    for (const auto* text :
         {"", "10", "10:17", "01:05.5", "24:00:00", "10:60:00", "13:00:00 PM", "0:10:00 AM", "10:00:00 P", "1/2/2026",
          "06/04/2018 22:29:00", "2026-02-30", "2026-01-02T", "2026-01-02 10:00:00 +1", "0m 0.1s"})
        EXPECT_FALSE(parse_clock_time(text)) << text;
}

TEST(TimeColumn, ReadsNumbersInTheirUnit) {
    TimeColumn us(1e-6);
    EXPECT_EQ(us.read("5100000"), 5.1);
    EXPECT_EQ(us.read("X"), std::nullopt);
    EXPECT_EQ(us.start_clock_s(), std::nullopt);
    TimeColumn minutes(60.0);
    EXPECT_EQ(minutes.read("1.5"), 90.0);
    TimeColumn unix_ms(1e-3, true);
    EXPECT_EQ(unix_ms.read("2000"), 0.0);
    EXPECT_EQ(unix_ms.read("1000"), -1.0);
    EXPECT_EQ(unix_ms.start_clock_s(), 2.0);
}

TEST(TimeColumn, ContinuesAcrossMidnight) {
    TimeColumn clock;
    EXPECT_EQ(clock.read("23:59:59.0"), 0.0);
    EXPECT_EQ(clock.read("00:00:00.5"), 1.5);
    EXPECT_EQ(clock.read("23:59:59.5"), 0.5) << "out of order";
    EXPECT_EQ(clock.read("00:00:01"), 2.0);
    EXPECT_EQ(clock.read("12"), std::nullopt) << "of another kind";
    EXPECT_EQ(clock.start_clock_s(), std::nullopt);
}

TEST(TimeColumn, UsesTheDate) {
    TimeColumn clock;
    EXPECT_EQ(clock.read("23:59:59", "2026-01-02"), 0.0);
    EXPECT_EQ(clock.read("00:00:01", "2026-01-03"), 2.0);
    EXPECT_EQ(clock.read("00:00:01", "2026-01-02"), -86398.0) << "the date counts, not midnight";
    EXPECT_DOUBLE_EQ(clock.start_clock_s().value_or(0.0), 1767312000.0 + 86399.0);
    TimeColumn both;
    EXPECT_EQ(both.read("2026-01-02T10:00:00Z"), 0.0);
    EXPECT_DOUBLE_EQ(both.start_clock_s().value_or(0.0), 1767348000.0);
    TimeColumn numbers(1e-3);
    EXPECT_EQ(numbers.read("1500", "2026-01-02 10:00:00"), 1.5) << "a log's own clock keeps its zero";
    EXPECT_DOUBLE_EQ(numbers.start_clock_s().value_or(0.0), 1767348000.0 - 1.5);
}

}  // namespace
}  // namespace flightwatt
