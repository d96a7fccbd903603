#include "flight/power_check.h"

#include "flight/load_flight.h"
#include "flight/power_report.h"
#include "flight/telemetry_series.h"
#include "helpers/sample_columns.h"
#include "helpers/test_paths.h"
#include "synthetic/synthetic_log.h"
#include "telemetry/log_reader.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

FlightSeries sound_flight() {
    synthetic::SyntheticFlight flight;
    flight.power_w = [](Phase, double tau) { return 25.0 + 5.0 * tau; };
    const auto log = make_synthetic_log(make_scenario(flight), {}, "x", "", 1);
    return flight_series(
        parse_telemetry(log.data, "x.data", telemetry::parse_log_configuration(log.log, "x.log"), flight_messages()),
        "7");
}

TEST(PowerReport, FindsASoundRecordSound) {
    const auto series = sound_flight();
    const auto report = check_power_record(select_tracks(series), segment(select_tracks(series)));
    EXPECT_EQ(report.origin, CurrentOrigin::sensor);
    ASSERT_TRUE(report.idle.has_value());
    EXPECT_NEAR(report.idle->mean_a, synthetic::SyntheticSensors{}.idle_current_a, 0.001);
    EXPECT_NEAR(report.idle->sd_a, synthetic::SyntheticSensors{}.current_noise_a, 0.0005);
    ASSERT_TRUE(report.energy_closure_percent && report.charge_closure_percent);
    EXPECT_NEAR(*report.energy_closure_percent, 0.0, 0.2);
    EXPECT_NEAR(*report.charge_closure_percent, 0.0, 0.2);
    EXPECT_FALSE(report.gaps.empty()) << "the made-up link has bursts";
    EXPECT_THAT(report.power_faults, IsEmpty());
}

std::vector<std::string> faults_after(const std::function<void(test::SampleColumns&)>& spoil) {
    const auto series = sound_flight();
    auto columns = test::columns_of(series);
    spoil(columns);
    return check_power_record(select_tracks(test::series_of(columns)), segment(select_tracks(series))).power_faults;
}

TEST(PowerReport, NamesWhatCannotBe) {
    EXPECT_THAT(faults_after([](test::SampleColumns& s) {
                    for (std::size_t i = 0; i < s.time_s.size(); ++i) {
                        s.current_a[i] += 30.0;
                        s.power_w[i] = s.voltage_v[i] * s.current_a[i];
                    }
                }),
                Contains(HasSubstr("more than 5 A in 100 % of the samples on the ground")));
    EXPECT_THAT(faults_after([](test::SampleColumns& s) {
                    for (auto& power : s.power_w) power *= 1.5;
                }),
                Contains("the power of series CSV is 50 % away from voltage times current: its energy is uncertain"));
    EXPECT_THAT(faults_after([](test::SampleColumns& s) {
                    for (std::size_t i = s.time_s.size() / 2; i < s.time_s.size(); ++i) s.energy_wh[i] = 0.0;
                }),
                Contains(HasSubstr("the energy counter ran back by")));
    EXPECT_THAT(faults_after([](test::SampleColumns& s) {  // the autopilot restarts
                    const double before_wh = s.energy_wh[s.time_s.size() / 2];
                    for (std::size_t i = s.time_s.size() / 2; i < s.time_s.size(); ++i) s.energy_wh[i] -= before_wh;
                }),
                testing::IsEmpty());
    EXPECT_THAT(faults_after([](test::SampleColumns& s) {
                    for (auto* channel : {&s.power_w, &s.current_a}) std::fill(channel->begin(), channel->end(), 2.0);
                    s.voltage_v.clear();
                }),
                Contains("power does not change in flight"));
}

TEST(PowerReport, JudgesAgainstTheCounterInFlightAlone) {
    EXPECT_THAT(faults_after([](test::SampleColumns& s) {
                    for (std::size_t i = 0; i < s.time_s.size(); ++i)
                        if (i % 50 < 4) s.power_w[i] = s.current_a[i] = 1000.0;
                    s.voltage_v.clear();
                }),
                Contains(HasSubstr("away from the on-board energy counter")));
    EXPECT_THAT(faults_after([](test::SampleColumns& s) {
                    for (auto& power : s.power_w) power = -power;
                }),
                Contains("power is negative on average in flight"));
    // A pack that is changed on the ground before lift-off takes the counters with it.
    EXPECT_THAT(faults_after([](test::SampleColumns& s) {
                    for (std::size_t i = 0; i < 10; ++i) s.energy_wh[i] = s.charge_ah[i] = 30.0;
                }),
                IsEmpty());
}

TEST(PowerReport, TakesTheIdleCurrentOutOnlyWhenAsked) {
    auto series = sound_flight();
    const auto before = series;
    const auto report = check_power_record(select_tracks(series), segment(select_tracks(series)));
    correct_idle_offset(series, select_tracks(series), std::nullopt);
    EXPECT_EQ(series, before);
    correct_idle_offset(series, select_tracks(series), report.idle);
    const auto measured = test::columns_of(before);
    const auto corrected = test::columns_of(series);
    ASSERT_EQ(corrected.time_s, measured.time_s);
    for (std::size_t i = 0; i < measured.time_s.size(); ++i) {
        EXPECT_NEAR(corrected.current_a[i], measured.current_a[i] - report.idle->mean_a, 1e-12);
        EXPECT_NEAR(corrected.power_w[i], measured.power_w[i] - report.idle->mean_a * measured.voltage_v[i], 1e-9);
    }
    EXPECT_THAT(warnings_of(series), Contains(HasSubstr("was subtracted")));
    EXPECT_EQ(power_track(series).source, power_track(before).source);
}

TEST(PowerReport, DoesNotAdviseWhatWasDone) {
    auto series = sound_flight();
    for (auto& track : series.tracks)
        if (track.name == "current_a")
            for (auto& current : track.value) current += 0.5;
    const auto advises = [&](bool corrects) {
        const auto texts = texts_of(segment_and_check(series, {.correct_idle_offset = corrects}).diagnostics);
        return std::ranges::any_of(
            texts, [](const auto& text) { return text.find("--correct-idle-offset") != std::string::npos; });
    };
    EXPECT_TRUE(advises(false));
    EXPECT_FALSE(advises(true));
}

TEST(PowerReport, ClosesOnTheRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const auto* name : {"20_07_03__12_17_45", "20_07_05__10_26_44", "20_07_10__06_53_03"}) {
        SCOPED_TRACE(name);
        const auto series = read_flight(test::shared_dir() / "flights" / (std::string(name) + ".data"));
        const auto report = check_power_record(select_tracks(series), segment(select_tracks(series)));
        EXPECT_EQ(report.origin, CurrentOrigin::sensor);
        EXPECT_THAT(report.power_faults, IsEmpty());
        ASSERT_TRUE(report.energy_closure_percent.has_value());
        EXPECT_LT(std::abs(*report.energy_closure_percent), 0.5);
        ASSERT_TRUE(report.idle.has_value());
        EXPECT_LT(std::abs(report.idle->mean_a), 0.1);
    }
}

}  // namespace
}  // namespace flightwatt::flight
