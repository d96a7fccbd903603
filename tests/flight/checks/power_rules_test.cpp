#include "flight/checks/power_rules.h"

#include "helpers/power_records.h"

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using test::found_in;
using test::resting;
using test::sortie_of;
using test::sound_record;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::size_t first = 100;
constexpr std::size_t last = 1100;  // a thousand samples in flight, one a second

/// What is found where the first `count` samples in flight (from 200 on) are changed.
test::FoundTexts found(std::size_t count, const std::function<void(PowerRecord&, std::size_t)>& change,
                       std::size_t flown = 1000) {
    auto record = sound_record(flown);
    for (std::size_t i = 200; i < 200 + count; ++i) change(record, i);
    return found_in(std::move(record));
}

TEST(PowerRules, FindNothingInASoundRecord) {
    const auto findings = found(0, [](PowerRecord&, std::size_t) {});
    EXPECT_THAT(findings.warnings, IsEmpty());
    EXPECT_THAT(findings.power_faults, IsEmpty());
}

TEST(PowerRules, OfALoadAtRest) {
    const auto loaded = [](std::size_t count, double current_a, std::size_t at_rest = 100) {
        auto record = sound_record();
        for (std::size_t i = 0; i < count; ++i) record.current_a[i] = current_a;
        return found_in(std::move(record), resting(at_rest)).power_faults;
    };
    EXPECT_THAT(loaded(11, 5.1), Contains("more than 5 A in 11 % of the samples on the ground with the motor off"));
    EXPECT_THAT(loaded(10, 5.1), IsEmpty());
    EXPECT_THAT(loaded(11, 4.9), IsEmpty());
    EXPECT_THAT(loaded(10, 5.1, 20), testing::SizeIs(1));
    EXPECT_THAT(loaded(9, 5.1, 20), IsEmpty());
}

TEST(PowerRules, OfSamplesTooFarApartForAPhase) {
    const auto each = [](double interval_s) {
        auto record = sound_record(100);
        for (auto& time_s : record.time_s) time_s *= interval_s;
        record.energy_j *= interval_s;
        record.duration_s *= interval_s;
        record.sorties = {sortie_of(record, 2.0 * interval_s)};
        record.sorties[0].phases[0].start.time_s -= 0.5 * interval_s;
        return found_in(std::move(record)).warnings;
    };
    EXPECT_THAT(each(10.0),
                testing::ElementsAre("the power is measured every 10 s: the 0.132 Wh of the take-off at 995 s "
                                     "are known within 0.016 Wh (1 sd)"));
    EXPECT_THAT(each(2.1), testing::SizeIs(1));
    EXPECT_THAT(each(2.0), IsEmpty());
}

TEST(PowerRules, OfPowerThatStandsStill) {
    const auto stands = [](std::size_t count, std::size_t flown = 1000) {
        return found(
                   count, [](PowerRecord& record, std::size_t i) { record.power_w[i] = 21.0; }, flown)
            .warnings;
    };
    EXPECT_THAT(stands(45), Contains("power is stuck at 21.00 W from 200.0 to 244.0 s, 5 % of the flight"));
    EXPECT_THAT(stands(38), IsEmpty()) << "4 % of the energy";
    EXPECT_THAT(stands(30, 300), Contains(HasSubstr("power is stuck")));
    EXPECT_THAT(stands(29, 300), IsEmpty());
}

TEST(PowerRules, OfACurrentThatStandsStillOrIsAtItsHighest) {
    const auto stands = [](std::size_t count) {
        return found(count, [](PowerRecord& record, std::size_t i) { record.current_a[i] = 1.9; }).warnings;
    };
    EXPECT_THAT(stands(41), Contains(HasSubstr("the current is stuck in 4 % of the samples in flight")));
    EXPECT_THAT(stands(40), IsEmpty());
    const auto saturated = [](std::size_t count, std::size_t flown = 1000) {
        return found(
                   2 * count,
                   [](PowerRecord& record, std::size_t i) {
                       if (i % 2 == 0) record.current_a[i] = 2.5;
                   },
                   flown)
            .warnings;
    };
    EXPECT_THAT(saturated(51), Contains(HasSubstr("the current is 2.5 A, its highest, in 5 % of the samples")));
    EXPECT_THAT(saturated(50), IsEmpty());
    EXPECT_THAT(saturated(30, 300), Contains(HasSubstr("its highest")));
    EXPECT_THAT(saturated(29, 300), IsEmpty());
}

TEST(PowerRules, OfDevicesThatReportNothing) {
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
    EXPECT_THAT(dead(21, 0.45), is_dead);
    EXPECT_THAT(dead(21, 0.6), Not(is_dead)) << "it glides";
    EXPECT_THAT(dead(21, 0.0, true), is_dead) << "with an open throttle";
    const auto shut =
        found(21, [](PowerRecord& record, std::size_t i) { record.power_w[i] = record.throttle_percent[i] = 0.0; });
    EXPECT_THAT(shut.warnings, Not(is_dead));
}

TEST(PowerRules, OfDevicesThatReportNothingForFiveSecondsAndMore) {
    const auto dead_for = [](std::size_t samples) {
        auto record = sound_record();
        record.throttle_percent.clear();
        for (std::size_t i = 200; i < 400; ++i)
            if (i % 20 < samples) record.power_w[i] = 0.0;
        return found_in(std::move(record)).warnings;
    };
    EXPECT_THAT(dead_for(6), Contains(HasSubstr("in flight without a descent")));
    EXPECT_THAT(dead_for(5), Not(Contains(HasSubstr("in flight without a descent"))));
}

TEST(PowerRules, OfNegativePower) {
    const auto negative = [](std::size_t count) {
        return found(count, [](PowerRecord& record, std::size_t i) { record.power_w[i] *= -1.0; }).warnings;
    };
    EXPECT_THAT(negative(22), Contains("power is negative in 22 samples in flight, 2 % of the energy"));
    EXPECT_THAT(negative(19), IsEmpty());
}

TEST(PowerRules, OfAnOpenThrottleWithoutPower) {
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

TEST(PowerRules, OfASensorThatIsDeadWithAnOpenThrottle) {
    const auto dead = [](std::size_t count, double power_w = 0.0, double throttle_percent = 50.0,
                         std::size_t flown = 1000) {
        return found(
                   count,
                   [&](PowerRecord& record, std::size_t i) {
                       record.power_w[i] = power_w;
                       record.throttle_percent[i] = throttle_percent;
                   },
                   flown)
            .power_faults;
    };
    EXPECT_THAT(dead(501),
                Contains("no power in 50 % of the samples in flight with more than 30 % throttle: its sensor "
                         "does not measure what the motor draws there"));
    EXPECT_THAT(dead(500), IsEmpty());
    EXPECT_THAT(dead(900, 0.19), testing::SizeIs(1)) << "1 % of the largest power is the sensor's noise";
    EXPECT_THAT(dead(900, 0.22), IsEmpty());
    EXPECT_THAT(dead(900, 0.0, 10.0), IsEmpty()) << "it glides";
    EXPECT_THAT(dead(32, 0.0, 50.0, 150), IsEmpty());
    auto launched = sound_record();
    for (std::size_t i = 120; i < last; ++i) launched.power_w[i] = launched.throttle_percent[i] = 0.0;
    for (std::size_t i = 200; i < 228; ++i) launched.throttle_percent[i] = 60.0;
    EXPECT_THAT(found_in(std::move(launched)).power_faults, IsEmpty()) << "28 s of an open throttle";
}

TEST(PowerRules, OfAVoltageThatStandsStill) {
    const auto stands = [](double rest_a, double changed_v = 12.6) {
        auto record = sound_record();
        record.voltage_v.assign(record.time_s.size(), 12.6);
        record.voltage_v[500] = changed_v;
        for (std::size_t i = 0; i < first; ++i) record.current_a[i] = rest_a;
        return found_in(std::move(record)).warnings;
    };
    const auto is_constant = Contains(
        "the voltage is 12.6 V throughout while the current varies: it is not that of the "
        "pack (but of a receiver, or a constant), so that the energy is approximate at most");
    EXPECT_THAT(stands(0.05), is_constant);
    EXPECT_THAT(stands(0.05, 12.5), testing::Not(is_constant));
    auto record = sound_record();
    record.voltage_v.assign(record.time_s.size(), 12.6);
    record.current_a.assign(record.time_s.size(), 2.0);
    EXPECT_THAT(found_in(std::move(record)).warnings, testing::Not(is_constant)) << "with that current, too";
}

TEST(PowerRules, OfAVoltageThatStandsStillFromAMomentOn) {
    const auto stands = [](std::size_t count, double step_a = 0.2) {
        auto record = sound_record();
        record.voltage_v.assign(record.time_s.size(), 12.6);
        for (std::size_t i = first; i < last; ++i) {
            const bool is_stuck = i >= 200 && i < 200 + count;
            record.voltage_v[i] = is_stuck ? 12.0 : 12.6 - 0.001 * static_cast<double>(i - first);
            record.current_a[i] = 2.0 + step_a * static_cast<double>(i % 3);
            record.power_w[i] = record.voltage_v[i] * record.current_a[i];
        }
        return found_in(std::move(record)).warnings;
    };
    const auto is_told = Contains(HasSubstr("the voltage stays at 12 V from 200.0 to "));
    EXPECT_THAT(stands(400), is_told);
    EXPECT_THAT(stands(150), testing::Not(is_told));
    EXPECT_THAT(stands(400, 0.0), testing::Not(is_told)) << "with the current, as in a glide";
}

/// In a flight that has just begun, or with a sample every 5 s, a voltage in steps of 0.1 V was called stuck.
TEST(PowerRules, OfAVoltageThatIsEqualInAFewSamples) {
    const auto stands = [](std::size_t count) {
        auto record = sound_record();
        record.in_flight = {{first, first + 2 * count}};
        record.duration_s = 2.0 * static_cast<double>(count);
        record.voltage_v.assign(record.time_s.size(), 12.0);
        for (std::size_t i = first; i < last; ++i) {
            record.voltage_v[i] = i < first + count ? 12.0 : 12.6 - 0.001 * static_cast<double>(i - first);
            record.current_a[i] = 2.0 + 0.2 * static_cast<double>(i % 3);
        }
        return found_in(std::move(record)).warnings;
    };
    const auto is_told = Contains(HasSubstr("the voltage stays at 12 V"));
    EXPECT_THAT(stands(9), testing::Not(is_told));
    EXPECT_THAT(stands(12), is_told);
}

TEST(PowerRules, OfPowerOutsideOfTheFlight) {
    const auto outside = [](std::size_t count, double power_w = 22.0) {
        auto record = sound_record();
        for (std::size_t i = last + 10; i < last + 10 + count; ++i) {
            record.throttle_percent[i] = 31.0;
            record.power_w[i] = power_w + 0.01 * static_cast<double>(i % 3);
        }
        return found_in(std::move(record)).warnings;
    };
    EXPECT_THAT(outside(50), Contains(HasSubstr("of the energy in flight, were drawn outside of it")));
    EXPECT_THAT(outside(44), IsEmpty());
    EXPECT_THAT(outside(31, 45.0), testing::SizeIs(1));
    EXPECT_THAT(outside(29, 45.0), IsEmpty());
}

TEST(PowerRules, OfACurrentAtRest) {
    const auto at_rest = [](double rest_a, double in_flight_factor) {
        auto record = sound_record();
        for (std::size_t i = 0; i < record.time_s.size(); ++i) {
            const bool flies = i >= first && i < last;
            record.current_a[i] = flies ? in_flight_factor * record.current_a[i] : rest_a;
        }
        return found_in(std::move(record)).warnings;
    };
    const auto is_loaded = Contains(HasSubstr("A at rest on the ground, "));
    EXPECT_THAT(at_rest(1.01, 20.0), is_loaded) << "2.5 % of the mean";
    EXPECT_THAT(at_rest(0.99, 20.0), IsEmpty());
    EXPECT_THAT(at_rest(0.101, 1.0), is_loaded) << "5 % of the mean";
    EXPECT_THAT(at_rest(0.099, 1.0), IsEmpty());
    auto unthrottled = sound_record();
    for (std::size_t i = 0; i < first; ++i) unthrottled.current_a[i] = 0.2;
    EXPECT_THAT(found_in(unthrottled).warnings, Contains(HasSubstr("--correct-idle-offset removes it")));
    unthrottled.throttle_percent.clear();
    EXPECT_THAT(
        found_in(std::move(unthrottled)).warnings,
        Contains("the current is 0.20 A at rest on the ground, 10 % of the mean in flight: idling motors, as no "
                 "throttle shows them off, electronics, or an offset of the sensor"));
}

TEST(PowerRules, OfVoltagesThatNoPackHas) {
    const auto at = [](double low_v, double high_v) {
        auto record = sound_record();
        record.voltage_v.assign(record.time_s.size(), high_v);
        for (std::size_t i = 200; i < 300; ++i) record.voltage_v[i] = low_v;
        record.current_a.clear();
        return found_in(std::move(record)).warnings;
    };
    EXPECT_THAT(at(60.1, 60.1), Contains(HasSubstr("that of more than 14 LiPo cells")));
    EXPECT_THAT(at(59.9, 59.9), IsEmpty());
    EXPECT_THAT(at(2.4, 2.4), Contains(HasSubstr("less than a LiPo cell's")));
    EXPECT_THAT(at(2.6, 2.6), IsEmpty());
    EXPECT_THAT(at(5.4, 10.0),
                Contains("the voltage falls from 10 to 5.4 V, too far for a pack: is its sensor damaged?"));
    EXPECT_THAT(at(5.6, 10.0), IsEmpty());
}

TEST(PowerRules, OfPowerThatIsFarFromThatAtTheSameThrottle) {
    const auto unusual = [](std::size_t count, double power_w) {
        auto record = sound_record();
        for (std::size_t i = 600; i < last; ++i) record.throttle_percent[i] = 60.0;
        for (std::size_t i = 200; i < 200 + count; ++i) record.power_w[i] = power_w;
        return found_in(std::move(record)).warnings;
    };
    const auto is_unusual = Contains(HasSubstr("power differs from the usual power at the same throttle in "));
    EXPECT_THAT(unusual(42, 40.0), is_unusual);
    EXPECT_THAT(unusual(42, 40.0), Contains(HasSubstr("42 samples in flight: 0 % of the energy less, 4 % more")));
    EXPECT_THAT(unusual(38, 40.0), Not(is_unusual));
    EXPECT_THAT(unusual(150, 12.5), is_unusual);
    EXPECT_THAT(unusual(150, 13.5), Not(is_unusual));
    EXPECT_THAT(unusual(150, 31.5), is_unusual);
    EXPECT_THAT(unusual(150, 30.0), Not(is_unusual));
    auto record = sound_record();
    for (std::size_t i = 200; i < 350; ++i) record.power_w[i] = 12.5;
    EXPECT_THAT(found_in(std::move(record)).warnings, Not(is_unusual)) << "one throttle throughout";
}

TEST(PowerRules, OfAMeanThatNothingFliesOn) {
    const auto of_mean = [](double mean_w) {
        auto record = sound_record();
        record.energy_j = mean_w * record.duration_s;
        return found_in(std::move(record)).warnings;
    };
    EXPECT_THAT(of_mean(2.9),
                Contains("the mean power of 2.9 W in flight is less than an aircraft needs: is its unit W?"));
    EXPECT_THAT(of_mean(3.1), IsEmpty());
    EXPECT_THAT(of_mean(19.9e3), IsEmpty());
    EXPECT_THAT(of_mean(20.1e3),
                Contains("the mean power of 2.01e+04 W in flight is more than a small aircraft draws: is "
                         "its unit W?"));
}

TEST(PowerRules, OfAMeanBelowZeroAndOfPowerThatDoesNotChange) {
    const auto faults_at = [](double power_w, double last_w, std::size_t flown = 1000) {
        auto record = sound_record(flown);
        for (std::size_t i = first; i < first + flown; ++i) record.power_w[i] = power_w;
        record.power_w[first + flown - 1] = last_w;
        return found_in(std::move(record)).power_faults;
    };
    EXPECT_THAT(faults_at(-0.1, 0.0), Contains("power is negative on average in flight"));
    EXPECT_THAT(faults_at(0.1, 0.0), IsEmpty());
    EXPECT_THAT(faults_at(0.1, 0.1), Contains("power does not change in flight"));
    EXPECT_THAT(faults_at(0.1, 0.1, 10), testing::SizeIs(1));
    EXPECT_THAT(faults_at(0.1, 0.1, 9), IsEmpty());
}

TEST(PowerRules, OfPowerThatIsNotVoltageTimesCurrent) {
    const auto apart = [](double factor, double scale = 1.0) {
        auto record = sound_record();
        for (auto& power_w : record.power_w) power_w *= scale;
        for (std::size_t i = 0; i < record.time_s.size(); ++i)
            record.voltage_v.push_back(record.power_w[i] / (factor * record.current_a[i]));
        return found_in(std::move(record)).power_faults;
    };
    EXPECT_THAT(apart(1.11),
                Contains("the power of ESC is 11 % away from voltage times current: its energy is uncertain"));
    EXPECT_THAT(apart(1.09), IsEmpty());
    EXPECT_THAT(apart(2.0, 0.11), testing::SizeIs(1)) << "1.1 W";
    EXPECT_THAT(apart(2.0, 0.09), IsEmpty()) << "0.9 W";
}

TEST(PowerRules, OfCountersThatRunBackOrContradict) {
    const auto runs_back = [](double by_wh) {
        auto record = sound_record();
        for (std::size_t i = 0; i < record.time_s.size(); ++i)
            record.energy_wh.value.push_back(0.01 * static_cast<double>(i) - (i < 500 ? 0.0 : by_wh));
        return found_in(std::move(record)).power_faults;
    };
    EXPECT_THAT(runs_back(0.6), Contains("the energy counter ran back by 6 % of its count in flight"));
    EXPECT_THAT(runs_back(0.45), IsEmpty());
    const auto late_by = [](std::size_t samples) {
        auto record = sound_record();
        for (std::size_t i = 0; i < record.time_s.size(); ++i)
            record.energy_wh.value.push_back(0.01 * static_cast<double>(i % 20 < samples ? i - i % 20 : i + 10));
        return found_in(std::move(record)).power_faults;
    };
    EXPECT_THAT(late_by(3), IsEmpty()) << "a link with two ways has overtaken them";
    EXPECT_THAT(late_by(4), Contains(HasSubstr("the energy counter ran back by")));
    const auto away = [](double percent, double rounding_percent) {
        auto record = sound_record();
        record.charge_ah.closure_percent = percent;
        record.charge_ah.rounding_percent = rounding_percent;
        return found_in(std::move(record));
    };
    EXPECT_THAT(away(-10.1, 0.0).power_faults,
                Contains("the measured integral in flight is -10.1 % away from the on-board charge counter"));
    EXPECT_THAT(away(-10.1, 0.0).warnings, IsEmpty()) << "printed as a fault";
    EXPECT_THAT(away(9.9, 0.0).power_faults, IsEmpty());
    EXPECT_THAT(away(10.5, 1.0).power_faults, IsEmpty());
    EXPECT_THAT(away(3.5, 1.0).warnings, IsEmpty());
}

TEST(PowerRules, OfPhasesThatDifferFromTheCounter) {
    const auto differs = [](double takeoff_s, double in_takeoff, double in_cruise, double resolution_wh = 0.0) {
        auto record = sound_record();
        double counted_wh = 0.0;
        for (std::size_t i = 0; i < record.time_s.size(); ++i) {
            const double since_s = record.time_s[i] - record.time_s[first];
            counted_wh += record.power_w[i] / (since_s <= takeoff_s ? in_takeoff : in_cruise) / 3600.0;
            record.energy_wh.value.push_back(counted_wh);
        }
        record.energy_wh.closure_percent = 0.0;
        record.energy_wh.resolution = resolution_wh;
        record.sorties = {sortie_of(record, takeoff_s)};
        return found_in(std::move(record)).warnings;
    };
    EXPECT_THAT(differs(0.0, 1.0, 1.11), Contains(HasSubstr("cruise at 100 s: ")));
    EXPECT_THAT(differs(0.0, 1.0, 1.09), IsEmpty());
    EXPECT_THAT(differs(70.0, 1.5, 1.0), Contains(HasSubstr("take-off at 100 s: "))) << "2.3 % of the flight";
    EXPECT_THAT(differs(50.0, 1.5, 1.0), IsEmpty()) << "1.7 % of the flight";
    EXPECT_THAT(differs(0.0, 1.0, 1.2, 0.225), testing::SizeIs(1)) << "0.46 Wh more than 10 %";
    EXPECT_THAT(differs(0.0, 1.0, 1.2, 0.238), IsEmpty());
}

TEST(PowerRules, OfACurrentAtRestThatDrifts) {
    const auto drifts = [](double by_a) {
        auto record = sound_record();
        record.sorties = {sortie_of(record)};
        auto at_rest = resting();
        for (auto i = last; i < record.time_s.size(); ++i) {
            record.current_a[i] += by_a;
            at_rest.push_back(i);
        }
        return found_in(std::move(record), at_rest).warnings;
    };
    const auto does_drift = Contains(HasSubstr("A before sortie 1 and "));
    EXPECT_THAT(drifts(0.11), does_drift);
    EXPECT_THAT(drifts(0.09), Not(does_drift));
}

TEST(PowerRules, OfAltitudesThatPauseOrGoOnForLonger) {
    const auto with_altitudes = [](double from_s, double pause_s) {
        auto record = sound_record();
        record.sorties = {sortie_of(record)};
        for (double t = from_s; t < 1200.0; t += 1.0)
            if (t <= 500.0 || t >= 500.0 + pause_s) record.altitude_time_s.push_back(t);
        return found_in(std::move(record)).warnings;
    };
    EXPECT_THAT(with_altitudes(0.0, 62.0),
                Contains("1 gaps in the altitude in flight, 62 s in all: no message came, or the clock jumped; 6 % of "
                         "the energy is in them, and no counter confirms it"));
    EXPECT_THAT(with_altitudes(0.0, 60.0), IsEmpty());
    EXPECT_THAT(with_altitudes(-65.0, 0.0),
                Contains("power is logged from 0 s, altitude from -65 s: earlier power is missing"));
    EXPECT_THAT(with_altitudes(-62.0, 0.0), IsEmpty()) << "5 % of the log";
    const auto in_short_log = [](double from_s) {
        auto record = sound_record(300);
        for (double t = from_s; t < 500.0; t += 1.0) record.altitude_time_s.push_back(t);
        return found_in(std::move(record)).warnings;
    };
    EXPECT_THAT(in_short_log(-31.0), testing::SizeIs(1));
    EXPECT_THAT(in_short_log(-29.0), IsEmpty());
}

TEST(PowerRules, OfAClimbWithoutPower) {
    const auto towed = [](std::size_t samples, double power_w, double climb_m_per_s, std::size_t strong = 0) {
        auto record = sound_record();
        for (std::size_t i = last - strong; i < last; ++i) record.power_w[i] *= 2.0;
        record.sorties = {sortie_of(record, 60.0)};
        for (std::size_t i = first; i < last; ++i)
            record.altitude_m[i] = climb_m_per_s * static_cast<double>(i - first);
        for (std::size_t i = first; i < first + samples; ++i) record.power_w[i] = power_w;
        return found_in(std::move(record)).warnings;
    };
    const auto is_towed = Contains(HasSubstr("without power: was it towed"));
    EXPECT_THAT(towed(5, 1.9, 2.6), is_towed) << "10.4 m";
    EXPECT_THAT(towed(5, 1.9, 2.4), Not(is_towed)) << "9.6 m";
    EXPECT_THAT(towed(5, 2.1, 2.6), Not(is_towed)) << "a tenth of the power";
    EXPECT_THAT(towed(3, 1.9, 20.0), is_towed);
    EXPECT_THAT(towed(2, 1.9, 20.0), Not(is_towed));
    EXPECT_THAT(towed(5, 3.9, 2.6, 260), is_towed) << "a tenth of the upper quartile";
    EXPECT_THAT(towed(5, 3.9, 2.6, 240), Not(is_towed));
}

/// With gaps of so many seconds more than usual from sample 600 on, each 20 samples, and the counter's closure.
std::vector<std::string> found_with_gaps(const std::vector<double>& gaps_s, std::optional<double> closure_percent) {
    auto record = sound_record();
    for (std::size_t gap = 0; gap < gaps_s.size(); ++gap)
        for (std::size_t i = 601 + 20 * gap; i < record.time_s.size(); ++i) record.time_s[i] += gaps_s[gap];
    record.sorties = {sortie_of(record)};
    record.charge_ah.closure_percent = closure_percent;
    return found_in(std::move(record)).warnings;
}

TEST(PowerRules, OfGapsAndCounters) {
    EXPECT_THAT(found_with_gaps({51.0}, {}),
                Contains("1 gap in the power, 52 s in all, the longest 52 s from 600.0 s: 5 % of the energy is "
                         "interpolated across, and no counter confirms it"));
    EXPECT_THAT(found_with_gaps({40.0}, {}), Contains(HasSubstr("longest 41 s from 600.0 s: 4 % of the energy is")));
    EXPECT_THAT(found_with_gaps({38.0}, {}), IsEmpty());
    EXPECT_THAT(found_with_gaps({51.0}, 2.9), IsEmpty()) << "the counter confirms it";
    EXPECT_THAT(found_with_gaps({25.0, 19.5}, {}), testing::SizeIs(1)) << "2 % in the second";
    EXPECT_THAT(found_with_gaps({25.0, 18.5}, {}), IsEmpty());
    EXPECT_THAT(found_with_gaps(std::vector<double>(10, 5.1), {}), testing::SizeIs(1)) << "5 % in all";
    EXPECT_THAT(found_with_gaps(std::vector<double>(10, 4.9), {}), IsEmpty());
    EXPECT_THAT(found_with_gaps({0.0}, -3.1),
                Contains("the measured integral in flight is -3.1 % away from the on-board charge counter"));
}

}  // namespace
}  // namespace flightwatt::flight
