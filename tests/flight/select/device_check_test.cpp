#include "flight/select/device_check.h"

#include "base/number.h"
#include "helpers/damaged_logs.h"
#include "helpers/selected_tracks.h"
#include "telemetry/log_reader.h"

#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Report {
    double current_a;
    double voltage_v;
};

/// What one of several devices reports, given what the pack draws.
using DeviceReport = std::function<Report(int device, double time_s, Report pack)>;

/// The first sample log, read without its .log, with ENERGY reported by `count` devices, one millisecond after the other.
LoadedFlight with_devices(const std::string& message, int count, const DeviceReport& report) {
    std::string text;
    test::damaged_sample([&](test::Words& words) {
        if (words[2] != "ENERGY") {
            text += fmt::format("{}\n", fmt::join(words, " "));
            return;
        }
        const double time_s = number_or_nan(words[0]);
        for (int device = 0; device < count; ++device) {
            const auto [a, v] = report(device, time_s, {number_or_nan(words[5]), number_or_nan(words[4])});
            text += fmt::format("{:.3f} {} ", time_s + 0.001 * device, words[1]);
            text += message == "ESC" ? fmt::format("ESC {:.5f} {} {:.6f} 5000 {} 0 {}\n", a, v, a * v, v, device)
                                     : fmt::format("POWER_DEVICE 1 {} {:.5f} {}\n", device, a, v);
        }
    });
    return segment_and_check(flight_series(parse_telemetry(text, "damaged.data", std::nullopt, flight_messages()), "7"),
                             {});
}

Report a_quarter(Report pack) { return {pack.current_a / 4.0, pack.voltage_v}; }

TEST(DeviceDoubts, SayNothingOfDevicesThatGoTogether) {
    for (const auto* message : {"ESC", "POWER_DEVICE"}) {
        const auto loaded = with_devices(message, 4, [](int, double, Report pack) { return a_quarter(pack); });
        EXPECT_THAT(test::said_of(loaded), Not(HasSubstr("silent")));
        EXPECT_THAT(test::said_of(loaded), Not(HasSubstr("reports")));
        EXPECT_NEAR(test::energy_in_flight_wh(loaded), 5.017, 0.01);
    }
}

TEST(DeviceDoubts, TellOfAMotorThatReportsNothing) {
    for (const double since_s : {0.0, 120.0, 400.0}) {
        const auto loaded = with_devices("ESC", 4, [&](int motor, double time_s, Report pack) {
            return motor == 3 && time_s > since_s ? Report{0.0, pack.voltage_v} : a_quarter(pack);
        });
        EXPECT_THAT(test::said_of(loaded), HasSubstr("ESC 3 reports almost no power (0.00 W)")) << since_s;
    }
    const auto noise = with_devices("ESC", 2, [](int motor, double time_s, Report pack) {
        return motor == 1 ? Report{0.01 + 0.01 * std::sin(time_s), pack.voltage_v} : a_quarter(pack);
    });
    EXPECT_THAT(test::said_of(noise), HasSubstr("ESC 1 reports almost no power"));
}

TEST(DeviceDoubts, CountAsNothingWhatIsLessThanATwentiethOfTheOthers) {
    const auto with_part = [](double part) {
        return test::said_of(with_devices("ESC", 4, [part](int motor, double, Report pack) {
            const auto report = a_quarter(pack);
            return motor == 3 ? Report{part * report.current_a, report.voltage_v} : report;
        }));
    };
    EXPECT_THAT(with_part(0.045), HasSubstr("ESC 3 reports almost no power"));
    EXPECT_THAT(with_part(0.06), Not(HasSubstr("ESC 3 reports")));
}

TEST(DeviceDoubts, TellOfADeviceThatRepeatsItsLastValue) {
    for (const auto* message : {"ESC", "POWER_DEVICE"}) {
        for (const double value_a : {0.0123, 0.2, 1.5}) {
            const auto loaded = with_devices(message, 4, [&](int device, double time_s, Report pack) {
                return device == 2 && time_s > 40.0 ? Report{value_a, pack.voltage_v} : a_quarter(pack);
            });
            const auto device = std::string(message) + (std::string(message) == "ESC" ? " 2" : " 1/2");
            EXPECT_THAT(test::said_of(loaded), HasSubstr(device + " reports ")) << value_a;
        }
    }
}

TEST(DeviceDoubts, TellOfAPowerThatStandsStillWhileTheCurrentGoesOn) {
    std::string text;
    for (int k = 0; k < 800; ++k) {
        for (int motor = 0; motor < 6; ++motor) {
            const double current_a = 1.0 + 0.1 * std::sin(0.1 * k);
            text += fmt::format("{}.{} 7 ESC {:.4f} 12.0 {:.4f} 5000 12.0 0 {}\n", k, motor, current_a,
                                motor == 5 && k > 100 ? 2.5 : 12.0 * current_a, motor);
        }
    }
    const auto series = flight_series(parse_telemetry(text, "x.data", std::nullopt, flight_messages()), "7");
    EXPECT_THAT(find_suspect_devices(series, "ESC"),
                testing::ElementsAre(HasSubstr("ESC 5 reports a constant value (2.50 W)")));
}

TEST(DeviceDoubts, LetElectronicsDrawWhatTheyDraw) {
    for (const bool is_exact : {true, false}) {
        const auto loaded = with_devices("POWER_DEVICE", 2, [&](int device, double time_s, Report pack) {
            if (device == 0) return pack;
            return Report{0.4 + (is_exact ? 0.0 : 0.01 * std::sin(1000.0 * time_s)), 5.0};
        });
        EXPECT_THAT(test::said_of(loaded), Not(HasSubstr("reports"))) << is_exact;
    }
    const auto dead = with_devices("POWER_DEVICE", 2, [](int device, double, Report pack) {
        return device == 0 ? a_quarter(pack) : Report{0.0, pack.voltage_v};
    });
    EXPECT_THAT(test::said_of(dead), HasSubstr("POWER_DEVICE 1/1 reports almost no power"));
}

TEST(DeviceDoubts, TellOfASumThatHoldsOneTwiceOrTakesOneOff) {
    const auto pack_and_parts = with_devices("POWER_DEVICE", 3, [](int device, double, Report pack) {
        return Report{pack.current_a * (device == 0 ? 1.0 : device == 1 ? 0.6 : 0.4), pack.voltage_v};
    });
    EXPECT_THAT(test::said_of(pack_and_parts), HasSubstr("POWER_DEVICE 1/0 reports the sum of all others"));
    const auto reversed = with_devices("POWER_DEVICE", 2, [](int device, double, Report pack) {
        return Report{pack.current_a * (device == 0 ? 1.0 : -0.3), pack.voltage_v};
    });
    EXPECT_THAT(test::said_of(reversed), HasSubstr("POWER_DEVICE 1/1 reports negative power, -43 % of the sum"));
}

TEST(DeviceDoubts, DoNotFaultCircuitsOfOtherVoltages) {
    const auto loaded = with_devices("POWER_DEVICE", 2, [](int device, double, Report pack) {
        return device == 0 ? pack : Report{0.5 * pack.current_a, 5.0};
    });
    EXPECT_THAT(loaded.power.power_faults, testing::IsEmpty());
    EXPECT_THAT(test::said_of(loaded), HasSubstr("the circuits of POWER_DEVICE have 5.0 to 12.3 V"));
    EXPECT_TRUE(select_track(loaded.series, "voltage_v").empty());
    EXPECT_TRUE(select_track(loaded.series, "current_a").empty());
}

TEST(DeviceDoubts, LetLiftMotorsStandWhileThePusherRuns) {
    const auto loaded = with_devices("ESC", 5, [](int motor, double time_s, Report pack) {
        const bool hovers = time_s < 70.0;
        return hovers == (motor == 4) ? Report{0.0, pack.voltage_v} : Report{pack.current_a, pack.voltage_v};
    });
    EXPECT_THAT(test::said_of(loaded), Not(HasSubstr("reports")));
}

/// What devices at 12 V are suspected of that report a hundred times, one second apart, given the current of each.
std::vector<std::string> doubts_of(const std::string& message, int count,
                                   const std::function<double(int device, int second)>& current_a) {
    std::string text;
    for (int second = 0; second < 100; ++second) {
        for (int device = 0; device < count; ++device) {
            const double a = current_a(device, second);
            const double time_s = second + 0.001 * device;
            text += message == "ESC"
                        ? fmt::format("{:.3f} 7 ESC {:.5f} 12 {:.5f} 5000 12 0 {}\n", time_s, a, 12.0 * a, device)
                        : fmt::format("{:.3f} 7 POWER_DEVICE 1 {} {:.5f} 12\n", time_s, device, a);
        }
    }
    return find_suspect_devices(flight_series(parse_telemetry(text, "x.data", std::nullopt, flight_messages()), "7"),
                                message);
}

double wavering_a(int second) { return 4.0 + 0.01 * std::sin(second); }

TEST(DeviceDoubts, CountFromFourPercentOfTheEnergyOn) {
    const auto silent_for = [](int seconds) {
        return doubts_of("ESC", 4, [seconds](int motor, int second) {
            return motor == 3 && second < seconds ? 0.0 : wavering_a(second);
        });
    };
    EXPECT_THAT(silent_for(15), testing::IsEmpty()) << "3.9 % of what all draw";
    EXPECT_THAT(silent_for(17), testing::ElementsAre(HasSubstr("ESC 3 reports almost no power"))) << "4.4 %";
    const auto turned = [](double fraction) {
        return doubts_of("POWER_DEVICE", 2, [fraction](int device, int second) {
            return device == 0 ? wavering_a(second) : -fraction * wavering_a(second);
        });
    };
    EXPECT_THAT(turned(0.035), testing::IsEmpty());
    EXPECT_THAT(turned(0.05), testing::ElementsAre(HasSubstr("POWER_DEVICE 1/1 reports negative power, -5 %")));
}

TEST(DeviceDoubts, CountAMotorAsOffWhereTheOthersDrawAFifthOfTheirUpperQuartile) {
    const auto off_while_others_draw = [](double fraction, int before_s = 26) {
        return doubts_of("ESC", 4, [=](int motor, int second) {
            if (second < before_s) return wavering_a(second);
            return motor == 3 ? 0.001 * std::sin(second) : fraction * wavering_a(second);
        });
    };
    EXPECT_THAT(off_while_others_draw(0.19), testing::IsEmpty());
    EXPECT_THAT(off_while_others_draw(0.21), testing::ElementsAre(HasSubstr("ESC 3 reports almost no power")));
    EXPECT_THAT(off_while_others_draw(0.19, 24), testing::ElementsAre(HasSubstr("ESC 3"))) << "less than a quarter";
}

TEST(DeviceDoubts, TakeThirtyReportsAlikeForAValueThatIsRepeated) {
    const auto repeats = [](int times) {
        return doubts_of("ESC", 4, [times](int motor, int second) {
            return motor == 3 && second >= 40 && second < 40 + times ? 8.0 : wavering_a(second);
        });
    };
    EXPECT_THAT(repeats(29), testing::IsEmpty());
    EXPECT_THAT(repeats(30), testing::ElementsAre(HasSubstr("ESC 3 reports a constant value (96.00 W)")));
}

TEST(DeviceDoubts, TakeASteadyLoadOfAQuarterOfTheEnergyForASensorThatIsStuck) {
    const auto steady = [](double fraction) {
        return doubts_of("POWER_DEVICE", 2, [fraction](int device, int second) {
            return device == 0 ? (1.0 - fraction) * wavering_a(second) : 4.0 * fraction;
        });
    };
    EXPECT_THAT(steady(0.24), testing::IsEmpty());
    EXPECT_THAT(steady(0.26), testing::ElementsAre(HasSubstr("POWER_DEVICE 1/1 reports a constant value")));
}

TEST(DeviceDoubts, KnowTheUsualPartOfACircuitFromATenthOfTheEnergyOn) {
    const auto stuck_after = [](int seconds) {
        return doubts_of("POWER_DEVICE", 2, [seconds](int device, int second) {
            if (device == 0) return wavering_a(second);
            return second < seconds ? 0.5 * wavering_a(second) : 2.0;
        });
    };
    EXPECT_THAT(stuck_after(10), testing::IsEmpty()) << "it is at what it usually draws";
    EXPECT_THAT(stuck_after(9), testing::ElementsAre(HasSubstr("POWER_DEVICE 1/1 reports a constant value")));
}

TEST(DeviceDoubts, TakeADeviceForTheSumOfTheOthersWithinATwentieth) {
    const auto sum_times = [](double factor) {
        return doubts_of("POWER_DEVICE", 3, [factor](int device, int second) {
            return device == 0 ? factor * 2.0 * wavering_a(second) : wavering_a(second);
        });
    };
    EXPECT_THAT(sum_times(0.96), testing::ElementsAre(HasSubstr("1/0 reports the sum of all others")));
    EXPECT_THAT(sum_times(0.945), testing::IsEmpty());
}

TEST(DeviceDoubts, AreNotLookedForAmongMoreThan32) {
    const auto equal = [](int count) {
        return doubts_of("ESC", count, [](int motor, int second) { return motor == 5 ? 0.0 : wavering_a(second); });
    };
    EXPECT_THAT(equal(33), testing::ElementsAre("33 ESC devices: too many to compare them"));
    EXPECT_THAT(equal(32), testing::IsEmpty()) << "one of 32 draws 3.1 %";
    EXPECT_THAT(equal(20), testing::ElementsAre(HasSubstr("ESC 5 reports almost no power")));
}

TEST(DeviceDoubts, TakeVoltagesForDifferentFromATenthOn) {
    const auto reason_at = [](double second_v) {
        std::string text;
        for (int k = 0; k < 60; ++k)
            text += fmt::format("{} 7 POWER_DEVICE 1 0 2.0 12\n{}.1 7 POWER_DEVICE 1 1 2.0 {}\n", k, k, second_v);
        return differing_voltages_reason(
            flight_series(parse_telemetry(text, "x.data", std::nullopt, flight_messages()), "7"));
    };
    EXPECT_EQ(reason_at(13.1), "");
    EXPECT_THAT(reason_at(13.3), HasSubstr("have 12.0 to 13.3 V"));
}

TEST(DeviceDoubts, NameIdsThatAreMissingBetweenOthers) {
    const auto doubts_with = [](const std::vector<std::string>& ids) {
        std::string text;
        for (int k = 0; k < 60; ++k)
            for (const auto& id : ids)
                text += fmt::format("{} 7 POWER_DEVICE {} {:.3f} 12.0\n", k, id, 2.0 + 0.1 * std::sin(0.1 * k));
        return find_suspect_devices(
            flight_series(parse_telemetry(text, "x.data", std::nullopt, flight_messages()), "7"), "POWER_DEVICE");
    };
    EXPECT_THAT(doubts_with({"1 0", "1 2", "1 3"}),
                testing::ElementsAre("POWER_DEVICE 1 is missing between 0 and 2: the sum is without its power"));
    EXPECT_THAT(doubts_with({"1 0", "1 3", "1 4", "1 5"}),
                testing::ElementsAre(HasSubstr("1, 2 are missing between 0 and 3")));
    EXPECT_THAT(doubts_with({"1 0", "1 1", "1 2"}), testing::IsEmpty());
    EXPECT_THAT(doubts_with({"1 5", "1 9"}), testing::IsEmpty()) << "numbered by other rules";
    EXPECT_THAT(doubts_with({"1 0", "2 0", "3 0"}), testing::IsEmpty()) << "one circuit a node";
}

}  // namespace
}  // namespace flightwatt::flight
