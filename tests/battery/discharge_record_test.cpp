#include "battery/discharge_record.h"

#include "base/error.h"
#include "helpers/rejected.h"
#include "helpers/synthetic_discharge.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

using test::known_pack;
using test::rejected;

test::SampleColumns flight() { return test::discharge_columns(known_pack(), {}, 7); }

DischargeRecord record_of(const test::SampleColumns& columns) {
    return test::discharge_record(test::series_of(columns, "synthetic_7"));
}

TEST(DischargeRecord, TakesWhatTheLogSays) {
    const auto series = flight();
    const auto record = record_of(series);
    EXPECT_EQ(record.flight, "synthetic_7");
    EXPECT_EQ(record.voltage_v, series.voltage_v);
    EXPECT_EQ(record.charge_ah.front(), 0.0);
    EXPECT_DOUBLE_EQ(record.charge_ah.back(), series.charge_ah.back() - series.charge_ah.front());
    EXPECT_NEAR(record.resting_voltage_v, open_circuit_voltage_v(known_pack(), 100.0), 0.01);
    EXPECT_NEAR(record.resting_current_a, 0.03, 0.02);
    EXPECT_NEAR(record.resolution_v, 0.006, 1e-9);
    EXPECT_EQ(std::count(record.used.begin(), record.used.end(), false), 0);
}

TEST(DischargeRecord, HasTheTemperatureOfTheBatteryAtTheFirstLoadAndItsMean) {
    EXPECT_FALSE(record_of(flight()).battery_temperature_c);
    auto series = test::series_of(flight());
    const auto& time_s = series.tracks.front().time_s;
    series.tracks.push_back({.name = "battery_temperature_c",
                             .time_s = {time_s.front(), 40.0, time_s.back()},
                             .value = {18.0, 20.0, 30.0}});
    const auto record = test::discharge_record(series);
    EXPECT_NEAR(record.battery_start_c.value(), 20.0, 0.1) << "its first load is at 40 s";
    EXPECT_NEAR(record.battery_temperature_c.value(), 24.9, 0.2);
}

TEST(DischargeRecord, IntegratesTheCurrentWhereNothingCounts) {
    auto series = flight();
    const double counted_ah = series.charge_ah.back();
    series.charge_ah.clear();
    const auto record = record_of(series);
    EXPECT_NEAR(record.charge_ah.back(), counted_ah, 0.02 * counted_ah);
    for (std::size_t i = 1; i < record.time_s.size(); ++i) {
        EXPECT_EQ(record.mean_current_a[i], (series.current_a[i - 1] + series.current_a[i]) / 2.0);
    }
}

TEST(DischargeRecord, HasTheChargeAlsoWhereTheCounterRestarts) {
    auto series = flight();
    const double counted_ah = series.charge_ah.back() - series.charge_ah.front();
    const double before_ah = series.charge_ah[series.charge_ah.size() / 3];
    for (std::size_t i = series.charge_ah.size() / 3; i < series.charge_ah.size(); ++i)
        series.charge_ah[i] -= before_ah;
    EXPECT_NEAR(record_of(series).charge_ah.back(), counted_ah, 0.02 * counted_ah);
}

TEST(DischargeRecord, BridgesGapsByTheCounter) {
    test::SampleColumns series;
    for (int i = 0; i < 100; ++i) {
        series.time_s.push_back(i < 60 ? i : i + 100);
        series.voltage_v.push_back(12.0 - 0.001 * i);
        series.current_a.push_back(i < 20 ? 0.0 : 2.0);
        series.charge_ah.push_back(std::floor(series.time_s.back()) * 0.001);  // whole mAh
    }
    const auto record = record_of(series);
    EXPECT_DOUBLE_EQ(record.mean_current_a[60], 0.101 * 3600.0 / 101.0);  // across the gap
    EXPECT_EQ(record.mean_current_a[30], 2.0);                            // too coarse for a single second
}

TEST(DischargeRecord, PassesOverBurstsWithoutThrottle) {
    auto series = flight();
    series.throttle_percent.assign(series.time_s.size(), 50.0);
    series.throttle_percent.back() = 0.0;
    series.current_a.back() = 3.5;
    series.power_w.back() = 3.5 * series.voltage_v.back();
    auto record = record_of(series);
    EXPECT_FALSE(record.used.back());
    EXPECT_EQ(std::count(record.used.begin(), record.used.end(), false), 1);
    // A throttle that never moves shows nothing.
    std::fill(series.throttle_percent.begin(), series.throttle_percent.end(), 0.0);
    record = record_of(series);
    EXPECT_EQ(std::count(record.used.begin(), record.used.end(), false), 0);
}

TEST(DischargeRecord, SettlesAsTheClosedFormDoes) {
    DischargeRecord record;
    for (int i = 0; i < 50; ++i) {
        record.time_s.push_back(i * i * 0.1);  // whatever the intervals
        record.mean_current_a.push_back(3.0);
    }
    const auto settled = rc_branch_current_a(record, 20.0);
    for (std::size_t i = 0; i < settled.size(); ++i) {
        EXPECT_NEAR(settled[i], 3.0 * (1.0 - std::exp(-record.time_s[i] / 20.0)), 1e-12);
    }
}

TEST(DischargeRecord, RefusesByNameAndReason) {
    const auto of = [](const auto& change) {
        auto columns = flight();
        change(columns);
        auto series = test::series_of(columns, "synthetic_7");
        series.file = "f.data";
        return rejected([&] { test::discharge_record(series); });
    };
    const std::string hint = "; a battery is identified from measured voltage and current";
    EXPECT_EQ(of([](test::SampleColumns&) {}), "");
    auto computed = test::series_of(flight(), "synthetic_7");
    computed.current_origin = flight::CurrentOrigin::throttle;
    EXPECT_EQ(rejected([&] { test::discharge_record(computed); }),
              "synthetic_7: synthetic_7: its current was computed from throttle, "
              "not measured; use flights with a current sensor");
    EXPECT_EQ(of([](test::SampleColumns& s) { s.voltage_v.clear(); }), "f.data: synthetic_7: has no voltage" + hint);
    EXPECT_EQ(of([](test::SampleColumns& s) { s.current_a.clear(); }), "f.data: synthetic_7: has no current" + hint);
    EXPECT_EQ(of([](test::SampleColumns& s) { std::fill(s.voltage_v.begin(), s.voltage_v.end(), 11.0); }),
              "f.data: synthetic_7: its voltage is 11 throughout" + hint);
    EXPECT_EQ(of([](test::SampleColumns& s) { std::fill_n(s.voltage_v.begin(), s.voltage_v.size() * 2 / 3, 0.0); }),
              "f.data: synthetic_7: its voltage is not positive throughout" + hint);
    EXPECT_EQ(of([](test::SampleColumns& s) {
                  for (auto* column :
                       {&s.time_s, &s.power_w, &s.voltage_v, &s.current_a, &s.charge_ah, &s.throttle_percent}) {
                      column->resize(std::min<std::size_t>(column->size(), 20));
                  }
              }),
              "f.data: synthetic_7: has 20 samples, expected at least 50" + hint);
    EXPECT_EQ(of([](test::SampleColumns& s) {
                  s.current_a.front() = 8.0;
                  s.power_w.front() = 8.0 * s.voltage_v.front();
              }),
              "f.data: synthetic_7: its log does not begin at rest: its initial charge is unknown; a "
              "log that begins before take-off is needed");
}

}  // namespace
}  // namespace flightwatt::battery
