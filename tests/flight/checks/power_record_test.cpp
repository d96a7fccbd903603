#include "flight/checks/power_record.h"

#include "flight/checks/runs.h"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::size_t first = 100;
constexpr std::size_t last = 1100;  // a thousand samples in flight, one a second

/// A sound record: 20 W in flight, 0.4 W at rest, no two neighbours alike.
PowerRecord sound_record() {
    PowerRecord record;
    for (std::size_t i = 0; i < last + first; ++i) {
        const bool flies = i >= first && i < last;
        const double ripple = 1.0 + 0.01 * std::sin(static_cast<double>(i));
        record.time_s.push_back(static_cast<double>(i));
        record.power_w.push_back((flies ? 20.0 : 0.4) * ripple);
        record.current_a.push_back((flies ? 2.0 : 0.04) * ripple);
        record.throttle_percent.push_back(flies ? 50.0 : 0.0);
        record.altitude_m.push_back(flies ? 100.0 : 0.0);
    }
    record.power_source = "ESC";
    record.in_flight = {{first, last}};
    record.energy_j = 20.0 * static_cast<double>(last - first);
    record.duration_s = static_cast<double>(last - first);
    return record;
}

std::vector<std::size_t> resting() {
    std::vector<std::size_t> samples;
    for (std::size_t i = 0; i < first; ++i) samples.push_back(i);
    return samples;
}

/// What is found where the first `count` samples in flight (from 200 on) are changed.
SampleFindings found(std::size_t count, const std::function<void(PowerRecord&, std::size_t)>& change) {
    auto record = sound_record();
    for (std::size_t i = 200; i < 200 + count; ++i) change(record, i);
    return apply_sample_rules(record, resting());
}

TEST(SampleRules, FindNothingInASoundRecord) {
    const auto findings = found(0, [](PowerRecord&, std::size_t) {});
    EXPECT_THAT(findings.warnings, IsEmpty());
    EXPECT_THAT(findings.faults, IsEmpty());
}

TEST(SampleRules, OfALoadAtRest) {
    const auto loaded = [](std::size_t count, double current_a) {
        auto record = sound_record();
        for (std::size_t i = 0; i < count; ++i) record.current_a[i] = current_a;
        return apply_sample_rules(record, resting()).faults;
    };
    EXPECT_THAT(loaded(11, 5.1), Contains("more than 5 A in 11 % of the samples on the ground with the motor off"));
    EXPECT_THAT(loaded(10, 5.1), IsEmpty());
    EXPECT_THAT(loaded(11, 4.9), IsEmpty());
}

TEST(SampleRules, OfPowerThatStandsStill) {
    const auto stands = [](std::size_t count) {
        return found(count, [](PowerRecord& record, std::size_t i) { record.power_w[i] = 21.0; }).warnings;
    };
    EXPECT_THAT(stands(45), Contains("power stands still at 21.00 W from 200.0 to 244.0 s, 5 % of the flight"));
    EXPECT_THAT(stands(38), IsEmpty()) << "4 % of the energy";
}

TEST(SampleRules, OfACurrentThatStandsStillOrIsAtItsHighest) {
    const auto stands = [](std::size_t count) {
        return found(count, [](PowerRecord& record, std::size_t i) { record.current_a[i] = 1.9; }).warnings;
    };
    EXPECT_THAT(stands(41), Contains(HasSubstr("the current stands still in 4 % of the samples in flight")));
    EXPECT_THAT(stands(40), IsEmpty());
    const auto saturated = [](std::size_t count) {
        return found(2 * count,
                     [](PowerRecord& record, std::size_t i) {
                         if (i % 2 == 0) record.current_a[i] = 2.5;
                     })
            .warnings;
    };
    EXPECT_THAT(saturated(51), Contains(HasSubstr("the current is 2.5 A, its highest, in 5 % of the samples")));
    EXPECT_THAT(saturated(50), IsEmpty());
}

TEST(SampleRules, OfDevicesThatReportNothing) {
    const auto dead = [](std::size_t count, double sink_m_per_s, bool has_throttle = false) {
        return found(count,
                     [&](PowerRecord& record, std::size_t i) {
                         if (!has_throttle) record.throttle_percent.clear();
                         record.power_w[i] = 0.0;
                         record.current_a[i] = 0.0;
                         record.altitude_m[i] -= sink_m_per_s * static_cast<double>(i - 200);
                     })
            .warnings;
    };
    const auto is_dead =
        Contains(HasSubstr("in flight without a descent, the longest from 200 s on: 2 % of the flight"));
    EXPECT_THAT(dead(21, 0.0), is_dead);
    EXPECT_THAT(dead(20, 0.0), Not(is_dead));
    EXPECT_THAT(dead(21, 0.4), is_dead);
    EXPECT_THAT(dead(21, 0.6), Not(is_dead)) << "it glides";
    EXPECT_THAT(dead(21, 0.0, true), is_dead) << "with an open throttle";
    const auto shut =
        found(21, [](PowerRecord& record, std::size_t i) { record.power_w[i] = record.throttle_percent[i] = 0.0; });
    EXPECT_THAT(shut.warnings, Not(is_dead));
}

TEST(SampleRules, OfNegativePower) {
    const auto negative = [](std::size_t count) {
        return found(count, [](PowerRecord& record, std::size_t i) { record.power_w[i] *= -1.0; }).warnings;
    };
    EXPECT_THAT(negative(22), Contains("power is negative in 22 samples in flight, 2 % of the energy"));
    EXPECT_THAT(negative(19), IsEmpty());
}

TEST(SampleRules, OfAnOpenThrottleWithoutPower) {
    const auto powerless = [](std::size_t count, double power_w) {
        return found(count, [&](PowerRecord& record,
                                std::size_t i) { record.power_w[i] = power_w + 1e-6 * static_cast<double>(i); })
            .warnings;
    };
    const auto is_powerless = Contains(HasSubstr("no power in 15 % of the samples in flight"));
    EXPECT_THAT(powerless(151, 0.9), is_powerless);
    EXPECT_THAT(powerless(149, 0.9), Not(is_powerless));
    EXPECT_THAT(powerless(151, 1.1), Not(is_powerless));
}

TEST(SampleRules, OfPowerOutsideOfTheFlight) {
    const auto outside = [](std::size_t count) {
        auto record = sound_record();
        for (std::size_t i = last + 10; i < last + 10 + count; ++i) {
            record.throttle_percent[i] = 31.0;
            record.power_w[i] = 22.0 + 0.01 * static_cast<double>(i % 3);
        }
        return apply_sample_rules(record, resting()).warnings;
    };
    EXPECT_THAT(outside(50), Contains(HasSubstr("of the energy in flight, were drawn outside of it")));
    EXPECT_THAT(outside(44), IsEmpty());
}

TEST(Runs, EndWhereARuleDoesOrItsNeighbourDiffers) {
    const std::vector<double> values{1, 1, 2, 2, 2, 3};
    EXPECT_EQ(runs_of_equal(values, 1).size(), 3U);
    const auto equal = runs_of_equal(values, 3);
    ASSERT_EQ(equal.size(), 1U);
    EXPECT_EQ(equal[0].first, 2U);
    EXPECT_EQ(equal[0].last, 5U);
    const auto even = runs_of({1, 6}, [&](std::size_t i) { return values[i] == 2.0; });
    ASSERT_EQ(even.size(), 1U);
    EXPECT_EQ(even[0].size(), 3U);
    EXPECT_TRUE(runs_of({2, 2}, [](std::size_t) { return true; }).empty());
}

}  // namespace
}  // namespace flightwatt::flight
