#include "base/number.h"
#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "helpers/damaged_logs.h"
#include "helpers/rejected.h"
#include "helpers/selected_tracks.h"
#include "telemetry/log_reader.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::HasSubstr;

// ENERGY: throttle, voltage, current, power, charge, energy from word 3 on.
enum Field : std::size_t { time = 0, throttle = 3, voltage, current, power, charge, energy };

double value(const test::Words& words, Field field) { return number_or_nan(words[field]); }
void set(test::Words& words, Field field, double to) { words[field] = fmt::format("{:.6f}", to); }
void scale(test::Words& words, Field field, double by) { set(words, field, value(words, field) * by); }

/// The first sample log whose ENERGY messages are changed; `counts` shows whether the counters are left.
LoadedFlight with_energy(bool counts, const std::function<void(test::Words&, int)>& damage) {
    int number = 0;
    return test::examined(test::damaged_sample([&](test::Words& words) {
        if (words[2] != "ENERGY") return;
        if (!counts) words[charge] = words[energy] = "0";
        damage(words, ++number);
    }));
}

double sound_energy_wh() {
    static const double energy_wh = test::energy_in_flight_wh(with_energy(true, [](test::Words&, int) {}));
    return energy_wh;
}

TEST(PowerWarnings, SayNothingOfASoundLog) {
    for (const bool counts : {true, false})
        EXPECT_THAT(texts_of(with_energy(counts, [](test::Words&, int) {}).diagnostics), testing::IsEmpty());
}

TEST(PowerWarnings, LeaveOutWildSamples) {
    const std::vector<std::pair<Field, double>> wild{{power, 900.0},  {power, 1e6},   {power, -300.0}, {current, 250.0},
                                                     {voltage, 99.0}, {voltage, 0.0}, {current, 1e9},  {power, 2e15}};
    for (const bool counts : {true, false}) {
        for (const auto& damage : wild) {
            SCOPED_TRACE(fmt::format("word {} is {}", static_cast<int>(damage.first), damage.second));
            const auto loaded = with_energy(counts, [&](test::Words& words, int number) {
                if (number == 300 || number == 301 || number % 50 == 3) set(words, damage.first, damage.second);
            });
            EXPECT_NEAR(test::energy_in_flight_wh(loaded), sound_energy_wh(), 0.02 * sound_energy_wh());
            EXPECT_THAT(test::said_of(loaded), HasSubstr("are removed"));
        }
    }
}

TEST(PowerWarnings, LeaveOutASpikeThatVoltageAndCurrentShare) {
    const auto loaded = with_energy(false, [](test::Words& words, int number) {
        if (number != 300) return;
        scale(words, current, 20.0);
        scale(words, power, 20.0);
    });
    EXPECT_NEAR(test::energy_in_flight_wh(loaded), sound_energy_wh(), 0.01);
    EXPECT_THAT(test::said_of(loaded), HasSubstr("1 far beyond the neighbouring samples"));
}

TEST(PowerWarnings, TellOfGapsThatCarryEnergy) {
    for (const double jump_s : {600.0, 3600.0}) {
        const auto text = test::damaged_sample([&](test::Words& words) {
            if (words[2] == "ENERGY") words[charge] = words[energy] = "0";
            if (const double time_s = number_or_nan(words[0]); time_s > 300.0)
                words[0] = fmt::format("{:.3f}", time_s + jump_s);
        });
        EXPECT_THAT(test::said_of(test::examined(text)), HasSubstr("of the energy is interpolated across"));
    }
}

TEST(PowerWarnings, NameAClockThatJumpsWhereACounterShowsIt) {
    for (const double jump_s : {40.0, 600.0, 3600.0}) {
        const auto loaded = test::examined(test::damaged_sample([&](test::Words& words) {
            if (const double time_s = number_or_nan(words[0]); time_s > 300.0)
                words[0] = fmt::format("{:.3f}", time_s + jump_s);
        }));
        EXPECT_THAT(test::said_of(loaded), HasSubstr("the clock jumps by "));
        const bool is_fault = !loaded.power.power_faults.empty();
        EXPECT_EQ(is_fault, jump_s > 40.0);
        const double far = is_fault ? 0.02 : 0.1;  // else the gap's straight line is left
        EXPECT_NEAR(test::energy_in_flight_wh(loaded), sound_energy_wh(), far * sound_energy_wh());
    }
    const auto scaled = with_energy(true, [](test::Words& words, int) { scale(words, energy, 0.8); });
    EXPECT_THAT(test::said_of(scaled), testing::Not(HasSubstr("the clock jumps by "))) << "the counter is too low";
}

TEST(PowerWarnings, TellOfAnOffsetThatTheCountersShare) {
    for (const double offset_a : {0.4, 4.9}) {
        const auto loaded = with_energy(true, [&](test::Words& words, int number) {
            const double hours = 1.1 * number / 3600.0;
            set(words, power, value(words, power) + offset_a * value(words, voltage));
            set(words, current, value(words, current) + offset_a);
            set(words, charge, value(words, charge) + offset_a * hours);
            set(words, energy, value(words, energy) + offset_a * 12.4 * hours);
        });
        EXPECT_THAT(test::said_of(loaded), HasSubstr("at rest on the ground"));
    }
}

TEST(PowerWarnings, TellOfUnitsThatNoPackHas) {
    const auto by_ten = with_energy(true, [](test::Words& words, int) {
        for (const auto field : {voltage, power, energy}) scale(words, field, 10.0);
    });
    EXPECT_THAT(test::said_of(by_ten), HasSubstr("more than 14 LiPo cells"));
    const auto by_a_tenth = with_energy(true, [](test::Words& words, int) {
        for (const auto field : {voltage, power, energy}) scale(words, field, 0.1);
    });
    EXPECT_THAT(test::said_of(by_a_tenth), HasSubstr("less than a LiPo cell's"));
    const auto by_a_hundredth = with_energy(true, [](test::Words& words, int) {
        for (const auto field : {current, power, charge, energy}) scale(words, field, 0.01);
    });
    EXPECT_THAT(test::said_of(by_a_hundredth), HasSubstr("less than an aircraft needs"));
}

TEST(PowerWarnings, TellOfASensorThatFails) {
    const auto stuck = with_energy(false, [](test::Words& words, int number) {
        if (number > 200 && number < 260) words[power] = "24.500000", words[current] = "1.96", words[voltage] = "12.5";
    });
    EXPECT_THAT(test::said_of(stuck), HasSubstr("power is stuck at 24.50 W"));
    const auto silent = with_energy(false, [](test::Words& words, int number) {
        if (number > 200 && number < 320) words[power] = words[current] = "0";
    });
    EXPECT_THAT(test::said_of(silent), HasSubstr("no power in"));
    const auto reversed = with_energy(false, [](test::Words& words, int number) {
        if (number > 200 && number < 240) scale(words, power, -1.0), scale(words, current, -1.0);
    });
    EXPECT_THAT(test::said_of(reversed), HasSubstr("power is negative in 39 samples"));
}

TEST(PowerWarnings, TellOfACurrentThatHangsOrIsSaturated) {
    const auto draw = [](test::Words& words, double current_a) {
        set(words, current, current_a);
        set(words, power, current_a * value(words, voltage));
    };
    const auto hangs = with_energy(false, [&](test::Words& words, int number) {
        if (number > 100 && number < 300) draw(words, 2.9);
    });
    EXPECT_THAT(texts_of(hangs.diagnostics), testing::Contains(HasSubstr("the current is stuck in ")));
    const auto saturated =
        with_energy(false, [&](test::Words& words, int) { draw(words, std::min(value(words, current), 2.4)); });
    EXPECT_THAT(texts_of(saturated.diagnostics),
                testing::Contains(HasSubstr("the current is 2.4 A, its highest, in ")));
}

TEST(PowerWarnings, LeaveABatteryThatReportsSlowerThanTheLog) {
    test::Words last;
    const auto slow = with_energy(false, [&](test::Words& words, int number) {
        if (number % 40 == 1) last = words;
        for (const auto field : {voltage, current, power}) words[field] = last[field];
    });
    EXPECT_THAT(texts_of(slow.diagnostics), testing::Each(testing::Not(HasSubstr("stuck"))));
}

TEST(PowerWarnings, TellOfANegativeCurrentAtRest) {
    const auto loaded = with_energy(false, [](test::Words& words, int) {
        set(words, current, value(words, current) - 0.4);
        set(words, power, value(words, current) * value(words, voltage));
    });
    EXPECT_THAT(test::said_of(loaded), HasSubstr("the current is -0.37 A at rest on the ground"));
}

TEST(PowerWarnings, LeaveOutShortDropoutsWhileTheThrottleIsOpen) {
    for (const int length : {1, 2, 3}) {
        const auto loaded = with_energy(false, [&](test::Words& words, int number) {
            if (number % 20 < length) words[power] = words[current] = "0";
        });
        EXPECT_NEAR(test::energy_in_flight_wh(loaded), sound_energy_wh(), 0.02 * sound_energy_wh()) << length;
        EXPECT_THAT(test::said_of(loaded), HasSubstr("at 0 for up to three samples with the throttle open")) << length;
        EXPECT_EQ(select_track(loaded.series, "current_a").time_s, power_track(loaded.series).time_s);
    }
}

TEST(PowerWarnings, LeaveAMotorThatIsCutForShort) {
    const auto loaded = with_energy(false, [](test::Words& words, int number) {
        if (number % 40 < 2) words[power] = words[current] = words[throttle] = "0";
    });
    EXPECT_THAT(texts_of(loaded.diagnostics), testing::IsEmpty());
    EXPECT_EQ(power_track(loaded.series).time_s.size(), 628U);
}

TEST(PowerWarnings, TellOfBriefChangesThatTheThrottleDoesNotShare) {
    for (const double factor : {0.0, 0.05, 0.25, 0.5, 2.0, 2.9}) {
        for (const int length : {1, 2, 4}) {
            if (factor == 0.0 && length < 4) continue;  // left out
            const auto loaded = with_energy(false, [&](test::Words& words, int number) {
                if (number % (7 * length) >= length) return;
                scale(words, power, factor);
                scale(words, current, factor);
            });
            EXPECT_THAT(test::said_of(loaded), HasSubstr("samples without the throttle"))
                << length << " times " << factor;
        }
    }
}

TEST(PowerWarnings, TellOfPowerThatIsNotWhatItIsAtTheSameThrottle) {
    for (const double factor : {0.5, 2.0}) {
        const auto loaded = with_energy(false, [&](test::Words& words, int number) {
            if (number < 200 || number > 270) return;
            scale(words, power, factor);
            scale(words, current, factor);
        });
        EXPECT_THAT(test::said_of(loaded), HasSubstr("power differs from the usual power at the same throttle"));
    }
}

TEST(PowerWarnings, TellOfPowerThatEndsEarly) {
    const auto ends_early = test::examined(test::damaged_sample([](test::Words& words) {
        if (words[2] == "ENERGY" && number_or_nan(words[0]) > 500.0) words.clear();
    }));
    EXPECT_THAT(test::said_of(ends_early), HasSubstr("power is logged to 500 s, altitude to 7"));
}

TEST(PowerWarnings, TellOfManyShortGapsTogether) {
    const auto text = test::damaged_sample([](test::Words& words) {
        if (words[2] == "ENERGY") words[charge] = words[energy] = "0";
        const double time_s = number_or_nan(words[0]);
        words[time] = fmt::format("{:.3f}", time_s + 5.0 * std::clamp(std::floor((time_s - 64.0) / 50.0), 0.0, 12.0));
    });
    EXPECT_THAT(test::said_of(test::examined(text)), HasSubstr("gaps in the power, "));
}

TEST(PowerWarnings, TellOfJumpsOfTheClockThatLeaveNoGapInThePower) {
    const auto text = test::damaged_sample([](test::Words& words) {
        if (words[2] == "ENERGY") words[charge] = words[energy] = "0";
        const double time_s = number_or_nan(words[0]);
        words[time] = fmt::format("{:.3f}", time_s + 2.0 * std::clamp(std::floor((time_s - 64.0) / 20.0), 0.0, 30.0));
    });
    EXPECT_THAT(test::said_of(test::examined(text)), HasSubstr("no message came, or the clock jumped"));
}

TEST(PowerWarnings, TellOfACurrentThatDrifts) {
    const auto drifts = with_energy(false, [](test::Words& words, int) {
        const double drift_a = 0.0005 * std::max(0.0, value(words, time) - 64.0);
        set(words, power, value(words, power) + drift_a * value(words, voltage));
        set(words, current, value(words, current) + drift_a);
    });
    EXPECT_THAT(test::said_of(drifts), HasSubstr("does its sensor drift?"));
}

TEST(PowerWarnings, TellOfAClimbWithoutPower) {
    const auto late = with_energy(
        false, [](test::Words& words, int) { words[time] = fmt::format("{:.3f}", value(words, time) + 10.0); });
    EXPECT_THAT(test::said_of(late), HasSubstr("without power: was it towed, or is the power logged late?"));
}

TEST(PowerWarnings, TellOfTheCounterFromThreePercentOn) {
    const auto apart = with_energy(true, [](test::Words& words, int) { scale(words, energy, 1.06); });
    EXPECT_THAT(test::said_of(apart), HasSubstr("away from the on-board energy counter"));
    const auto near = with_energy(true, [](test::Words& words, int) { scale(words, energy, 1.02); });
    EXPECT_THAT(texts_of(near.diagnostics), testing::IsEmpty());
}

/// The first sample log with four ESCs instead of ENERGY. `report`: amperes, volts and watts of each, from the pack's.
LoadedFlight with_escs(const std::function<void(double time_s, double& amps, double& volts, double& watts)>& report) {
    std::string text;
    test::damaged_sample([&](test::Words& words) {
        if (words[2] != "ENERGY") {
            text += fmt::format("{}\n", fmt::join(words, " "));
            return;
        }
        double amps = value(words, current) / 4.0;
        double volts = value(words, voltage);
        double watts = amps * volts;
        report(value(words, time), amps, volts, watts);
        for (int motor = 0; motor < 4; ++motor)
            text += fmt::format("{:.3f} {} ESC {:.5f} {} {:.6f} 5000 {} 0 {}\n", value(words, time) + 0.001 * motor,
                                words[1], amps, volts, watts, volts, motor);
    });
    return segment_and_check(flight_series(parse_telemetry(text, "x.data", std::nullopt, flight_messages()), "7"), {});
}

TEST(PowerWarnings, CompareThePowerOfEscsWithVoltageTimesCurrent) {
    const auto compares = HasSubstr("away from voltage times current");
    const auto scaled = [](double by) {
        return with_escs([by](double, double&, double&, double& watts) { watts *= by; });
    };
    EXPECT_THAT(scaled(1.11).power.power_faults, testing::Contains(compares));
    EXPECT_THAT(texts_of(scaled(1.055).diagnostics), testing::Contains(compares));
    EXPECT_THAT(texts_of(scaled(1.045).diagnostics), Not(testing::Contains(compares)));
}

TEST(PowerWarnings, TellOfDevicesThatAllReportNothingInFlight) {
    const auto dead_for = [](double dead_s) {
        return with_escs([dead_s](double time_s, double& amps, double&, double& watts) {
            if (time_s > 200.0 && time_s < 200.0 + dead_s) amps = watts = 0.0;
        });
    };
    const auto dead = testing::Contains(HasSubstr("in flight without a descent, the longest from 20"));
    EXPECT_THAT(texts_of(dead_for(40.0).diagnostics), dead);
    EXPECT_THAT(texts_of(dead_for(8.0).diagnostics), Not(dead)) << "2 % of the flight";
    EXPECT_THAT(texts_of(dead_for(0.0).diagnostics), Not(dead)) << "it glides down with its motor off";
}

TEST(PowerWarnings, CompareEachPhaseWithItsCounterAlsoWhereTheWholeIsDoubtful) {
    const auto lacking = [](double in_takeoff) {
        return with_energy(true, [in_takeoff](test::Words& words, int) {
            const double by = value(words, time) < 92.0 ? in_takeoff : 0.95;
            scale(words, power, by);
            scale(words, current, by);
            words[charge] = "0";
        });
    };
    const auto whole = testing::Contains(HasSubstr("away from the on-board energy counter"));
    const auto phase = testing::Contains(testing::ContainsRegex("take-off at .* Wh were measured and .* Wh counted"));
    EXPECT_THAT(texts_of(lacking(0.5).diagnostics), testing::AllOf(whole, phase));
    EXPECT_THAT(texts_of(lacking(0.95).diagnostics), testing::AllOf(whole, Not(phase)));
}

TEST(PowerWarnings, KnowACounterByItsDecimalsHoweverSeldomItIsLogged) {
    const auto rare = with_energy(true, [](test::Words& words, int number) {
        scale(words, power, 0.94);
        scale(words, current, 0.94);
        words[charge] = "0";
        if (number % 18 != 0) words.clear();
    });
    EXPECT_THAT(texts_of(rare.diagnostics), testing::Contains(HasSubstr("away from the on-board energy counter")));
    const auto& sortie = rare.phases.sorties.at(0);
    EXPECT_GT(PowerStatistics(rare.data).between(sortie.start_s(), sortie.end_s()).gaps, 10U) << "counted in time";
}

}  // namespace
}  // namespace flightwatt::flight
