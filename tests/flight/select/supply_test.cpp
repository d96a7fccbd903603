#include "flight/select/supply.h"

#include "flight/select.h"

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

using Power = std::function<double(double time_s)>;

/// 12 W of the motors at rest, then from 20 to 100 s about 280 W.
double motors_w(double time_s) { return time_s < 20.0 ? 12.0 : 280.0 + 20.0 * std::sin(time_s); }

/// What the monitor of a log of 100 s and its ESCs state, at 16 V.
struct Stated {
    Power battery_w;
    Power esc_w;  ///< of each
    int escs = 4;
    double battery_v = 16.0;
};

FlightSeries series_of(const Stated& stated) {
    FlightSeries series;
    const auto add = [&](const std::string& message, const std::string& device, double volts, const Power& watts) {
        const bool is_esc = message == "ESC";
        for (const std::string name : {"power_w", "voltage_v", "current_a"}) {
            const auto source = name == "power_w" ? (is_esc ? "ESC" : "BAT.Volt * BAT.Curr") : message + ".X";
            Track track{.name = name, .source = source, .device = device};
            for (int i = 0; i < 1000; ++i) {
                track.time_s.push_back(0.1 * i);
                const double power_w = watts(0.1 * i);
                track.value.push_back(name == "power_w" ? power_w : name == "voltage_v" ? volts : power_w / volts);
            }
            series.tracks.push_back(std::move(track));
        }
    };
    add("BAT", "0", stated.battery_v, stated.battery_w);
    for (int esc = 0; esc < stated.escs; ++esc) add("ESC", fmt::format("{}", esc), 15.9, stated.esc_w);
    series.monitor_capacities_ah["0"] = 5.0;
    return series;
}

Power parts(double part) {
    return [part](double time_s) { return part * motors_w(time_s); };
}

TEST(Supply, OfAFewMotorsIsTheBatterys) {
    const auto data = select_tracks(series_of({parts(1.0), parts(1.0 / 6.0), 4}));
    EXPECT_EQ(data.power_w.source, "BAT.Volt * BAT.Curr");
    EXPECT_THAT(data.power_w.notes, IsEmpty());
}

TEST(Supply, IsTheBatterysWhereEscsAreNoisyOrHaveAnOffset) {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0.0, 60.0);
    const auto noisy =
        select_tracks(series_of({parts(1.0), [&](double t) { return motors_w(t) / 4 + noise(random); }}));
    EXPECT_THAT(noisy.power_w.notes, IsEmpty());
    const auto offset = select_tracks(series_of({parts(1.0), [](double t) { return 70.0 + motors_w(t) / 4; }}));
    EXPECT_EQ(offset.power_w.source, "BAT.Volt * BAT.Curr");
    EXPECT_THAT(offset.power_w.notes, Contains(HasSubstr("check the scales of both")));
}

TEST(Supply, OfElectronicsAloneIsNotThatOfTheEscs) {
    const auto avionics = [](double time_s) { return 7.0 + 0.2 * std::sin(time_s); };
    const auto data = select_tracks(series_of({avionics, parts(0.25), 4, 12.1}));
    EXPECT_NEAR(value_at(data.power_w, 50.0), motors_w(50.0), 1e-9);
    EXPECT_NEAR(value_at(data.current_a, 50.0), motors_w(50.0) / 15.9, 1e-9);
    EXPECT_EQ(data.voltage_v.value.front(), 15.9);
    EXPECT_FALSE(data.stated_capacity_ah) << "of the other pack";
    EXPECT_THAT(data.circuits, IsEmpty());
    EXPECT_THAT(data.power_w.not_chosen, Contains("the ESCs draw 226 W on average, but BAT 0 gives 7 W and does not "
                                                  "rise with them: it is not their supply"));
}

TEST(Supply, WithoutARestIsOnlyDoubted) {
    const auto flying = [](double time_s) { return motors_w(time_s + 20.0) / 4; };
    const auto data = select_tracks(series_of({[](double) { return 100.0; }, flying}));
    EXPECT_EQ(data.power_w.source, "BAT.Volt * BAT.Curr");
    EXPECT_THAT(data.power_w.notes, Contains(HasSubstr("perhaps too small")));
}

TEST(Supply, OfMoreThanAllEscsDrawIsDoubted) {
    const auto notes = [](double part, double motors) {
        auto series = series_of({parts(part), parts(0.25)});
        series.firmware = "rotorcraft";
        series.motors = motors;
        return select_tracks(series).power_w.notes;
    };
    EXPECT_THAT(notes(2.0, 4.0), Contains(HasSubstr("BAT 0 gives 2.00 times the power of all 4 ESCs")));
    EXPECT_THAT(notes(1.1, 4.0), IsEmpty()) << "ESCs measure roughly";
    EXPECT_THAT(notes(2.0, 6.0), IsEmpty()) << "two have no telemetry";
    EXPECT_THAT(notes(6.0, 4.0), IsEmpty()) << "these measure no current";
}

TEST(Supply, WithoutACurrentIsThatOfTheEscsWithTheVoltageOfTheBattery) {
    const auto data = select_tracks(series_of({[](double) { return 0.0; }, parts(0.25)}));
    EXPECT_NEAR(value_at(data.power_w, 50.0), motors_w(50.0), 1e-9);
    EXPECT_EQ(data.voltage_v.value.front(), 16.0);
    EXPECT_EQ(data.stated_capacity_ah, 5.0);
    EXPECT_THAT(data.power_w.not_chosen, Contains("the batteries' power is 0 throughout"));
}

TEST(Supply, IsUnknownWhereEscsOfSomeMotorsAloneMeasureIt) {
    for (const auto& battery_w : {Power([](double) { return 0.0; }), Power([](double) { return 7.0; })}) {
        auto series = series_of({battery_w, parts(1.0 / 6.0), 4});
        series.motors = 6.0;
        const auto data = select_tracks(series);
        EXPECT_THAT(data.power_w.time_s, IsEmpty());
        EXPECT_THAT(data.power_w.not_chosen, Contains(HasSubstr("the current of 4 of 6 motors")));
    }
}

}  // namespace
}  // namespace flightwatt::flight
