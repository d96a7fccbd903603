#include "flight/select/device_sum.h"

#include "base/number.h"
#include "helpers/damaged_logs.h"
#include "helpers/rejected.h"
#include "helpers/selected_tracks.h"
#include "telemetry/log_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// The first sample log, read without its .log, with ENERGY reported by four motors: `report` states the lines of one.
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
                                             HasSubstr("the longest 101 s from 299.5 s: 20 %")));
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
                HasSubstr("ESC 0 reports 4 times at one time, and differently: several devices have this id"));
}

TEST(DeviceSum, IsRefusedWhereAMotorIsSilentFromTheGroundOn) {
    EXPECT_THAT(test::rejected([] {
                    with_motors([](int motor, double time_s, const std::string& sender, const std::string& fields) {
                        return motor == 3 && time_s > 60.0 ? "" : line(time_s, sender, fields, motor);
                    });
                }),
                HasSubstr("ESC 3 is silent at"));
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
                HasSubstr("ESC 0 reports 4 times at one time: several devices have this id"));
}

/// A motor that reports 1 W at these times.
Track motor(const std::string& id, const std::vector<double>& time_s) {
    return {.name = "power_w",
            .source = "ESC.power",
            .device = id,
            .time_s = time_s,
            .value = std::vector<double>(time_s.size(), 1.0)};
}

DeviceSum sum_of(const std::vector<Track>& motors) {
    FlightSeries series;
    series.tracks = motors;
    return sum_over_devices(devices_of(series, "power_w", "ESC"));
}

std::vector<double> each_second(int count, double from_s = 0.0) {
    std::vector<double> time_s;
    for (int i = 0; i < count; ++i) time_s.push_back(from_s + i);
    return time_s;
}

/// At how many of 101 times, a second apart, there is a sum with a motor that reports at these.
std::size_t summed_with(const std::vector<double>& time_s) {
    return sum_of({motor("0", each_second(101)), motor("1", time_s)}).track.time_s.size();
}

TEST(DeviceSum, HasNoValueInPausesOfMoreThanFiveIntervals) {
    const auto pauses = [](double from_s, double pause_s) {
        auto time_s = each_second(51, from_s - 50.0);
        for (double t = from_s + pause_s; t < 100.0; t += 1.0) time_s.push_back(t);
        return summed_with(time_s);
    };
    EXPECT_EQ(pauses(50.0, 4.9), 101U);
    EXPECT_EQ(pauses(50.0, 5.1), 97U);
    EXPECT_EQ(pauses(50.15, 10.0), 101U - 8U) << "51 s is within 0.9 s of the last report, as 60 s of the next";
    EXPECT_EQ(pauses(50.05, 10.0), 101U - 9U);
}

TEST(DeviceSum, HasNoValueMoreThanThreeIntervalsOutsideOfTheReports) {
    EXPECT_EQ(summed_with(each_second(98, 2.9)), 101U);
    EXPECT_EQ(summed_with(each_second(98, 3.1)), 100U);
    EXPECT_EQ(summed_with(each_second(98, 0.1)), 101U) << "to 97.1 s";
    EXPECT_EQ(summed_with(each_second(97, 0.9)), 100U) << "to 96.9 s";
}

TEST(DeviceSum, IsNoneWithLessThanAQuarterOfTheTimes) {
    EXPECT_EQ(summed_with(each_second(23)), 26U);
    EXPECT_EQ(summed_with(each_second(22)), 0U) << "25 of 101";
}

TEST(DeviceSum, IsOfDevicesThatReportMoreThanRarely) {
    const auto is_rare = [](int reports, std::size_t most) {
        return reports_rarely({"ESC 1", "1", motor("1", each_second(reports)), {}}, most);
    };
    EXPECT_TRUE(is_rare(9, 1000));
    EXPECT_FALSE(is_rare(10, 1000)) << "one percent";
    EXPECT_TRUE(is_rare(2, 30));
    EXPECT_FALSE(is_rare(3, 30));
    EXPECT_FALSE(is_rare(2, 29));
}

TEST(DeviceSum, IsRefusedWhereRepeatedReportsDifferOrAreThree) {
    // A motor of a hundred reports, and of so many a second and a third at the same time, of which some differ.
    const auto is_refused = [](int second, int differing, int third = 0) {
        std::vector<Track> motors{motor("0", each_second(100)), motor("0~2", each_second(second))};
        for (std::size_t i = 0; i < static_cast<std::size_t>(differing); ++i) motors[1].value[i] = 2.0;
        if (third > 0) motors.push_back(motor("0~3", each_second(third)));
        return !sum_of(motors).ambiguity.empty();
    };
    EXPECT_TRUE(is_refused(6, 6));
    EXPECT_FALSE(is_refused(5, 5)) << "less is damage";
    EXPECT_TRUE(is_refused(20, 11));
    EXPECT_FALSE(is_refused(20, 10)) << "half of them";
    EXPECT_TRUE(is_refused(20, 0, 6));
    EXPECT_FALSE(is_refused(20, 0, 5));
    EXPECT_FALSE(is_refused(20, 0));
}

}  // namespace
}  // namespace flightwatt::flight
