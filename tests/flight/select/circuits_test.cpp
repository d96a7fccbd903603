#include "flight/select/circuits.h"

#include "base/error.h"
#include "flight/phase_statistics.h"
#include "flight/select.h"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A monitor in a log of 100 s: its current is a part of the vehicle's, which rises from 1 to 20 A.
struct Logged {
    std::string message;
    std::string device;
    double volts;
    std::function<double(double)> current_a;
    double counter_step_ah = 0.001;
};

FlightSeries series_of(const std::vector<Logged>& monitors) {
    FlightSeries series;
    for (const auto* name : {"voltage_v", "current_a", "power_w", "charge_ah"}) {
        for (const auto& [message, device, volts, current_a, counter_step_ah] : monitors) {
            const bool is_power = name == std::string("power_w");
            Track track{.name = name,
                        .source = is_power ? message + ".Volt * " + message + ".Curr" : message + ".X",
                        .device = device};
            for (int i = 0; i < 100; ++i) {
                const double amperes = current_a(1.0 + 0.19 * i + 0.5 * std::sin(i));
                const double values[] = {volts, amperes, volts * amperes, counter_step_ah * i};
                track.time_s.push_back(i);
                track.value.push_back(values[is_power                           ? 2
                                             : name == std::string("voltage_v") ? 0
                                             : name == std::string("current_a") ? 1
                                                                                : 3]);
            }
            series.tracks.push_back(std::move(track));
        }
    }
    return series;
}

/// Sets the electrical tracks of a monitor to 0 from a sample on; `also_voltage`: of all.
FlightSeries failing_from(std::size_t sample, const std::string& device, bool also_voltage, FlightSeries series) {
    for (auto& track : series.tracks)
        if (track.device == device && (also_voltage || track.name != "voltage_v"))
            for (auto i = sample; i < track.value.size() && track.name != "charge_ah"; ++i) track.value[i] = 0.0;
    return series;
}

std::function<double(double)> times(double part) {
    return [part](double amperes) { return part * amperes; };
}

double first_w(const FlightSeries& series) { return select_tracks(series).power_w.value.at(0); }

TEST(Circuits, SumPacksOfOneVoltage) {
    const auto data = select_tracks(series_of({{"BAT", "0", 16.0, times(0.52)}, {"BAT", "1", 16.0, times(0.48)}}));
    EXPECT_NEAR(data.power_w.value.at(0), 16.0, 1e-9);
    EXPECT_NEAR(data.current_a.value.at(0), 1.0, 1e-9);
    EXPECT_EQ(data.voltage_v.value.at(0), 16.0);
    EXPECT_NEAR(data.charge_ah.value.at(99), 2.0 * 0.099, 1e-9);
    ASSERT_EQ(data.circuits.size(), 1U);
    EXPECT_EQ(data.circuits[0].name, "BAT 0 and BAT 1");
}

TEST(Circuits, SumTheSecondMonitorOfItsOwnMessage) {
    EXPECT_NEAR(first_w(series_of({{"BAT", "", 16.0, times(0.52)}, {"BAT2", "1", 16.0, times(0.48)}})), 16.0, 1e-9);
    EXPECT_NEAR(first_w(series_of({{"CURR", "", 16.0, times(0.52)}, {"CUR2", "1", 16.0, times(0.48)}})), 16.0, 1e-9);
}

TEST(Circuits, OfDifferentVoltagesAddTheirPowerButNotTheirCurrent) {
    const auto data = select_tracks(series_of({{"BAT", "0", 24.0, times(1.0)}, {"BAT", "1", 49.0, times(2.0)}}));
    EXPECT_NEAR(data.power_w.value.at(0), 24.0 + 98.0, 1e-9);
    EXPECT_NEAR(data.current_a.value.at(0), 2.0, 1e-9) << "of the circuit with more power";
    EXPECT_EQ(data.voltage_v.value.at(0), 49.0);
    const auto shares = circuit_shares(data, {});
    ASSERT_EQ(shares.size(), 2U);
    EXPECT_EQ(shares[0].name, "BAT 1");
    EXPECT_NEAR(shares[0].percent, 100.0 * 98.0 / 122.0, 1e-9);
    EXPECT_EQ(select_circuit(data, 2).voltage_v.value.at(0), 24.0);
    EXPECT_THROW(select_circuit(data, 3), InputError);
}

TEST(Circuits, OfOtherNumbersOfCellsAreApartThoughOneSagsToTheVoltageOfTheOther) {
    auto series = series_of({{"BAT", "0", 15.5, times(1.0)}, {"BAT", "1", 12.4, times(0.1)}});
    auto& of_motors = series.tracks.front();
    ASSERT_EQ(of_motors.name, "voltage_v");
    for (std::size_t i = 0; i < 10; ++i) of_motors.value[i] = 16.8;
    series.monitor_capacities_ah = {{"0", 5.0}, {"1", 2.2}};
    const auto data = select_tracks(series);
    ASSERT_EQ(data.circuits.size(), 2U);
    EXPECT_EQ(data.circuits[0].name, "BAT 0");
    EXPECT_EQ(data.stated_capacity_ah, 5.0) << "the pack of the electronics does not feed the motors";
    const auto low = select_tracks(series_of({{"BAT", "0", 6.4, times(1.0)}, {"BAT", "1", 6.5, times(0.6)}}));
    EXPECT_EQ(low.circuits.size(), 1U) << "nearly empty";
    const auto unlike = select_tracks(series_of({{"BAT", "0", 16.6, times(1.0)}, {"BAT", "1", 14.0, times(0.6)}}));
    EXPECT_EQ(unlike.circuits.size(), 1U) << "one of two of 4 cells is nearly empty";
}

TEST(Circuits, LeaveOutAMonitorThatIsTheSumOfTwoOthers) {
    const std::vector<Logged> logged{
        {"BAT", "0", 16.0, times(1.0)}, {"BAT", "1", 16.0, times(0.6)}, {"BAT", "2", 16.0, times(0.4)}};
    const auto data = select_tracks(series_of(logged));
    EXPECT_NEAR(data.power_w.value.at(0), 16.0, 1e-9);
    EXPECT_THAT(data.power_w.notes, Contains(HasSubstr("BAT 0 (16.00 V, 10.41 A) is not counted: the sum of others")));
}

TEST(Circuits, LeaveOutAMonitorThatIsASumByItsParameter) {
    auto series = series_of({{"BAT", "0", 16.0, times(1.2)}, {"BAT", "1", 16.0, times(0.9)}});
    EXPECT_NEAR(first_w(series), 2.1 * 16.0, 1e-9);
    series.monitor_kinds["0"] = sum_monitor;
    EXPECT_NEAR(first_w(series), 0.9 * 16.0, 1e-9);
}

TEST(Circuits, KnowByParametersWhichMonitorsMeasureOnePack) {
    auto series = series_of({{"BAT", "0", 16.0, times(1.0)}, {"BAT", "1", 16.0, times(0.93)}});
    EXPECT_NEAR(first_w(series), 1.93 * 16.0, 1e-9);
    series.monitor_kinds["1"] = same_pins_monitor;
    EXPECT_NEAR(first_w(series), 16.0, 1e-9);
    auto equal = series_of({{"BAT", "0", 16.0, times(1.0)}, {"BAT", "1", 16.0, times(1.01)}});
    EXPECT_NEAR(first_w(equal), 16.0, 1e-9) << "by their currents";
    equal.monitor_kinds["0"] = equal.monitor_kinds["1"] = smart_pack_monitor;
    EXPECT_NEAR(first_w(equal), 2.01 * 16.0, 1e-9);
}

TEST(Circuits, StateTheCapacityOfThePacksThatCountOnlyWhereEachIsStated) {
    auto series = series_of({{"BAT", "0", 16.0, times(1.0)}, {"BAT", "1", 16.0, times(0.6)}});
    series.monitor_capacities_ah["0"] = 5.0;
    EXPECT_FALSE(select_tracks(series).stated_capacity_ah);
    series.monitor_capacities_ah["1"] = 3.0;
    EXPECT_NEAR(select_tracks(series).stated_capacity_ah.value(), 8.0, 1e-12);
    series.monitor_kinds["0"] = sum_monitor;
    EXPECT_NEAR(select_tracks(series).stated_capacity_ah.value(), 3.0, 1e-12);
}

TEST(Circuits, StateTheMonitorsOfTheirPacksAndTheirParts) {
    using Monitors = std::vector<MonitorShare>;
    const auto series = series_of({{"BAT", "2", 16.0, times(0.5)}, {"BAT", "0", 16.0, times(0.75)}});
    const auto shared = select_tracks(series).monitors;
    ASSERT_EQ(shared.size(), 2U);
    EXPECT_EQ(shared[0].number, 1);
    EXPECT_NEAR(shared[0].part, 0.6, 1e-12);
    EXPECT_EQ(shared[1].number, 3);
    const auto apart = select_tracks(series_of({{"BAT", "", 24.0, times(1.0)}, {"BAT2", "1", 49.0, times(2.0)}}));
    EXPECT_EQ(apart.monitors, (Monitors{{2, 1.0}}));
    EXPECT_EQ(select_circuit(apart, 2).monitors, (Monitors{{1, 1.0}}));
}

TEST(Circuits, StateTheCellsWherePacksAgree) {
    auto series = series_of({{"BAT", "0", 16.0, times(1.0)}, {"BAT", "1", 16.0, times(0.6)}});
    EXPECT_FALSE(select_tracks(series).stated_cells);
    series.monitor_cells["1"] = 4.0;
    EXPECT_EQ(select_tracks(series).stated_cells, 4);
    series.monitor_cells["0"] = 5.0;
    EXPECT_FALSE(select_tracks(series).stated_cells);
}

TEST(Circuits, CountAPackThatTwoMonitorsSeeOnceAndSaySo) {
    const auto second = [](double part_of, double volts) {
        return series_of({{"BAT", "0", 16.0, times(1.0)}, {"BAT", "1", volts, times(part_of)}});
    };
    const auto data = select_tracks(second(1.02, 16.1));
    EXPECT_NEAR(data.power_w.value.at(0), 16.0, 1e-9);
    EXPECT_THAT(data.power_w.notes, Contains(HasSubstr("both measure one pack")));
    EXPECT_GT(first_w(second(0.92, 16.0)), 30.0) << "packs in parallel share the current unevenly";
    EXPECT_GT(first_w(second(1.0, 16.5)), 30.0) << "another voltage";
    auto by_escs = second(0.88, 16.0);
    by_escs.monitor_kinds["1"] = escs_monitor;
    EXPECT_NEAR(first_w(by_escs), 16.0, 1e-9);
}

TEST(Circuits, CountTheSensorOfAPackThatDoesNotFailInFlight) {
    const auto both = series_of({{"BAT", "0", 16.0, times(1.0)}, {"BAT", "1", 16.0, times(1.01)}});
    for (const bool also_voltage : {false, true}) {
        const auto second = select_tracks(failing_from(60, "1", also_voltage, both));
        EXPECT_NEAR(second.power_w.value.at(0), 16.0, 1e-9) << "not twice, up to the failure";
        EXPECT_THAT(second.power_w.notes, Contains(HasSubstr("BAT 0 are the same wherever this one measures")));
        const auto first = select_tracks(failing_from(60, "0", also_voltage, both));
        EXPECT_NEAR(first.power_w.value.at(0), 16.16, 1e-9);
        EXPECT_GT(first.power_w.value.back(), 100.0) << "not 0, from the failure on";
        EXPECT_THAT(first.power_w.notes, Contains(HasSubstr("the power is that of BAT 1")));
    }
}

TEST(Circuits, TellOfAPackWhoseSensorFailsInFlight) {
    const auto both = series_of({{"BAT", "0", 16.0, times(0.8)}, {"BAT", "1", 16.0, times(0.2)}});
    const auto is_told = Contains(HasSubstr("BAT 1 reports almost no power"));
    EXPECT_THAT(select_tracks(both).power_w.notes, testing::IsEmpty());
    auto failing = failing_from(45, "1", false, both);
    EXPECT_THAT(select_tracks(failing).power_w.notes, is_told);
    failing.tracks.push_back({.name = "vtol_state", .source = "QTUN.ThO", .time_s = {0.0, 45.0}, .value = {3.0, 4.0}});
    EXPECT_THAT(select_tracks(failing).power_w.notes, Not(is_told)) << "a pack of the lift motors rests on the wing";
}

TEST(Circuits, LetAllPacksStayAtRest) {
    auto both = series_of({{"BAT", "0", 16.0, times(0.8)}, {"BAT", "1", 16.0, times(0.2)}});
    for (auto& track : both.tracks)
        if (track.name == "current_a" || track.name == "power_w")
            for (std::size_t i = 0; i < 50; ++i) track.value[i] = track.name == "power_w" ? 48.0 : 3.0;
    EXPECT_THAT(select_tracks(both).power_w.notes, testing::IsEmpty());
}

TEST(Circuits, TellOfAPackWhoseSensorIsReversed) {
    const auto data = select_tracks(series_of({{"BAT", "0", 16.0, times(0.8)}, {"BAT", "1", 16.0, times(-0.2)}}));
    EXPECT_THAT(data.power_w.notes, ElementsAre(HasSubstr("is it charged in flight, or is its sensor reversed?")));
}

TEST(Circuits, TellOfOneCurrentAtTwoVoltages) {
    const auto notes = [](double part) {
        return select_tracks(series_of({{"BAT", "0", 50.0, times(1.0)}, {"BAT", "1", 25.0, times(part)}}))
            .power_w.notes;
    };
    EXPECT_THAT(notes(1.0), ElementsAre(HasSubstr("have the same current at nearly every sample")));
    EXPECT_THAT(notes(0.5), testing::IsEmpty());
}

TEST(Circuits, KeepTheOnlyMonitorWhoseSensorIsReversed) {
    const auto data = select_tracks(series_of({{"BAT", "0", 16.0, times(-1.0)}}));
    EXPECT_NEAR(data.power_w.value.at(0), -16.0, 1e-9);
    EXPECT_THAT(data.power_w.notes, Not(Contains(HasSubstr("not counted"))));
}

TEST(Circuits, DoNotUseCountersOfWhichOneStaysAtZero) {
    const auto data = select_tracks(series_of({{"BAT", "0", 16.0, times(0.6)}, {"BAT", "1", 16.0, times(0.4), 0.0}}));
    EXPECT_TRUE(data.charge_ah.empty());
    EXPECT_THAT(data.power_w.notes, Contains("the counter of BAT 1 stays at 0: the counters are not used"));
}

TEST(Circuits, NameASpareInput) {
    const auto data = select_tracks(series_of({{"BAT", "0", 16.0, times(1.0)}, {"BAT", "1", 16.0, times(0.019)}}));
    EXPECT_NEAR(data.power_w.value.at(0), 16.0, 1e-9);
    EXPECT_THAT(data.power_w.notes, Contains(HasSubstr("a spare input")));
}

TEST(Circuits, LeaveOutFuel) {
    auto series = series_of({{"BAT", "0", 1.0, times(40.0)}, {"BAT", "1", 16.0, times(1.0)}});
    series.monitor_kinds["0"] = fuel_monitor;
    EXPECT_NEAR(first_w(series), 16.0, 1e-9);
    EXPECT_THAT(select_tracks(series).power_w.notes, Contains(HasSubstr("BAT 0 is not counted: it measures fuel")));
    series.monitor_kinds["1"] = fuel_monitor;
    EXPECT_FALSE(select_batteries(series)) << "nothing electric";
}

TEST(Circuits, NameAPackWithoutACurrent) {
    auto series = series_of({{"BAT", "0", 16.0, times(1.0)}, {"BAT", "1", 15.9, times(1.0)}});
    const auto without_current = [](const Track& track) {
        return track.device == "1" && (track.name == "power_w" || track.name == "current_a");
    };
    for (auto& track : series.tracks)
        if (without_current(track)) track = {track.name, track.source, track.device};
    EXPECT_NEAR(first_w(series), 16.0, 1e-9);
    EXPECT_THAT(select_tracks(series).power_w.notes,
                ElementsAre("BAT 1 states 15.9 V but no current: if it is a pack of its own, what it supplies is not "
                            "counted"));
    for (auto& track : series.tracks)
        for (auto& value : track.value) value = track.device == "1" ? 5.0 : value;
    EXPECT_THAT(select_tracks(series).power_w.notes, testing::IsEmpty()) << "a supply of electronics";
}

TEST(Circuits, NameACurrentThatIsComputed) {
    auto series = series_of({{"BAT", "0", 16.0, times(1.0)}, {"BAT", "1", 16.0, times(0.5)}});
    series.monitor_kinds["1"] = throttle_monitor;
    EXPECT_THAT(select_tracks(series).power_w.notes, ElementsAre(HasSubstr("the current of BAT 1 is computed")));
}

TEST(Circuits, OfALogThatNumbersNoBatteryAreNone) {
    EXPECT_FALSE(select_batteries(series_of({{"BAT", "", 16.0, times(1.0)}})));
    EXPECT_EQ(select_tracks(series_of({{"BAT", "", 16.0, times(1.0)}})).circuits.size(), 0U);
}

}  // namespace
}  // namespace flightwatt::flight
