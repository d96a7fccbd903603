#include "flight/sources/device_sum.h"

#include "base/number.h"
#include "flight/selected_track.h"
#include "helpers/damaged_logs.h"
#include "helpers/rejected.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// The first sample log, read without its .log, with ENERGY told by four motors: `report` says the lines of one.
template <typename Report>
LoadedFlight with_motors(const Report& report) {
    std::string text;
    test::damaged_sample([&](test::Words& words) {
        if (words[2] != "ENERGY") {
            text += fmt::format("{}\n", fmt::join(words, " "));
            return;
        }
        for (int motor = 0; motor < 4; ++motor) {
            const double part = 0.25 + 0.02 * (motor - 1.5);
            const double current_a = number_or_nan(words[5]) * part;
            text += report(motor, number_or_nan(words[0]), words[1],
                           fmt::format("ESC {:.5f} {} {:.6f} 5000 {} 0", current_a, words[4],
                                       number_or_nan(words[6]) * part, words[4]));
        }
    });
    return segment_and_check(flight_series(parse_telemetry(text, "damaged.data", std::nullopt, flight_messages()), "7"),
                             {});
}

std::string line(double time_s, const std::string& sender, const std::string& fields, int id) {
    return fmt::format("{:.3f} {} {} {}\n", time_s, sender, fields, id);
}

TEST(DeviceSum, IsThePowerOfAllMotors) {
    const auto loaded = with_motors([](int motor, double time_s, const std::string& sender, const std::string& fields) {
        return line(time_s, sender, fields, motor);
    });
    EXPECT_NEAR(test::energy_in_flight_wh(loaded),
                test::energy_in_flight_wh(test::examined(test::damaged_sample([](test::Words&) {}))), 0.01);
    EXPECT_THAT(test::said_of(loaded), Not(HasSubstr("ESC 0")));
}

TEST(DeviceSum, HasNoValueWhereAMotorIsSilent) {
    const auto loaded = with_motors([](int motor, double time_s, const std::string& sender, const std::string& fields) {
        const bool is_silent = motor == 3 && time_s > 300.0 && time_s < 400.0;
        return is_silent ? "" : line(time_s, sender, fields, motor);
    });
    EXPECT_THAT(test::said_of(loaded), AllOf(HasSubstr("ESC 3 is silent at 80 of 628 times"),
                                             HasSubstr("the longest 101 s from 299.5 s on: 20 %")));
    const auto power = power_track(loaded.series);
    EXPECT_TRUE(std::ranges::none_of(power.time_s, [](double t) { return t > 310.0 && t < 390.0; }));
}

TEST(DeviceSum, EndsWhereAMotorFallsSilentForGood) {
    const auto loaded = with_motors([](int motor, double time_s, const std::string& sender, const std::string& fields) {
        return motor == 3 && time_s > 300.0 ? "" : line(time_s, sender, fields, motor);
    });
    EXPECT_THAT(test::said_of(loaded), HasSubstr("ESC 3 is silent at"));
    EXPECT_LT(power_track(loaded.series).time_s.back(), 310.0);
}

TEST(DeviceSum, IsRefusedWhereOneIdStandsForSeveralMotors) {
    EXPECT_THAT(test::rejected([] {
                    with_motors([](int, double time_s, const std::string& sender, const std::string& fields) {
                        return line(time_s, sender, fields, 0);
                    });
                }),
                HasSubstr("ESC 0 reports 4 times at one time, and differently: several devices under one id"));
}

TEST(DeviceSum, IsRefusedWhereAMotorIsSilentFromTheGroundOn) {
    EXPECT_THAT(test::rejected([] {
                    with_motors([](int motor, double time_s, const std::string& sender, const std::string& fields) {
                        return motor == 3 && time_s > 60.0 ? "" : line(time_s, sender, fields, motor);
                    });
                }),
                HasSubstr("ESC 3 is silent at"));
}

TEST(DeviceSum, IsDoubtedWhereOneIdComesInBursts) {
    const auto loaded = with_motors([](int motor, double time_s, const std::string& sender, const std::string& fields) {
        return line(time_s + 0.002 * motor, sender, fields, 0);
    });
    EXPECT_THAT(test::said_of(loaded), HasSubstr("ESC 0 reports in bursts"));
}

TEST(DeviceSum, TakesEqualReportsAtOneTimeOnceAndSaysSo) {
    const auto loaded = with_motors([](int motor, double time_s, const std::string& sender, const std::string& fields) {
        return motor > 0 ? "" : line(time_s, sender, fields, 0) + line(time_s, sender, fields, 0);
    });
    EXPECT_THAT(test::said_of(loaded), HasSubstr("ESC 0 reports up to 2 times at one time"));
    EXPECT_THAT(test::rejected([] {
                    with_motors([](int motor, double time_s, const std::string& sender, const std::string& fields) {
                        if (motor > 0) return std::string();
                        const auto once = line(time_s, sender, fields, 0);
                        return once + once + once + once;
                    });
                }),
                HasSubstr("ESC 0 reports 4 times at one time: several devices under one id"));
}

}  // namespace
}  // namespace flightwatt::flight
