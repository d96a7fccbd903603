#include "flight/flight_identity.h"

#include "base/atomic_file.h"
#include "flight/load_flight.h"
#include "flight/series_file.h"
#include "helpers/binary_frames.h"
#include "helpers/selected_tracks.h"
#include "helpers/test_paths.h"

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using namespace std::chrono_literals;

TEST(LogName, TellsWhenTheLogBegan) {
    constexpr auto start = std::chrono::sys_days{2020y / 7 / 5} + 10h + 26min + 44s;
    EXPECT_EQ(start_in_name("20_07_05__10_26_44"), start);
    EXPECT_EQ(start_in_name("field-20_07_05__10_26_44_SD"), start);
}

TEST(LogName, IsNoDateWithoutOne) {
    for (const auto* name : {"", "survey", "20_07_05", "120_07_05__10_26_44", "20_13_05__10_26_44",
                             "20_02_30__10_26_44", "20_07_05__24_26_44", "20_07_05__10_60_44", "20_07_05__10_26_444"})
        EXPECT_FALSE(start_in_name(name)) << name;
}

TEST(LogName, CountsWhereTheLogHasNoClock) {
    const std::string name = "20_07_05__10_26_44";
    EXPECT_EQ(start_clock_s(1e9, name), 1e9);
    EXPECT_EQ(start_clock_s(std::nullopt, name), 1593944804.0);
    EXPECT_EQ(start_clock_s(0.0, name), 1593944804.0);
    EXPECT_FALSE(start_clock_s(0.0, "survey"));
}

FlightSeries sample(int number) {
    return read_flight(test::source_dir() / "logs" / ("opterra_synthetic_0" + std::to_string(number) + ".data"));
}

std::uint64_t fingerprint_of(const FlightSeries& series) { return content_of(series).fingerprint; }

TEST(FlightIdentity, IsThatOfTheSamples) {
    const auto series = sample(1);
    const auto known = fingerprint_of(series);
    EXPECT_EQ(fingerprint_of(parse_series_csv(to_csv(series), "other.csv")), known);
    auto later = series;
    for (auto& track : later.tracks)
        for (auto& time_s : track.time_s) time_s += 84.264;
    EXPECT_EQ(fingerprint_of(later), known) << "another clock";
    auto other = series;
    for (auto& value : other.tracks.front().value) value *= 1.01;
    EXPECT_NE(fingerprint_of(other), known);
    EXPECT_NE(fingerprint_of(truncate_series(series, 400.0)), known) << "a part is another";
}

TEST(FlightIdentity, IsThatOfTheBinaryForm) {
    const auto folder = test::scratch_dir();
    const auto log = test::source_dir() / "logs" / "opterra_synthetic_01.log";
    const auto data = read_file(test::source_dir() / "logs" / "opterra_synthetic_01.data");
    std::filesystem::copy(log, folder / "card.log");
    write_file_atomically(folder / "card.LOG",
                          test::card_log(data, telemetry::read_message_dictionary(log), test::LinkVersion::v2));
    EXPECT_EQ(fingerprint_of(read_flight(folder / "card.LOG")), fingerprint_of(sample(1)));
}

TEST(FlightIdentity, IsThatOfACopyWhoseSamplesWereRounded) {
    const auto series = sample(1);
    auto text = series;
    for (auto& track : text.tracks)
        for (auto& value : track.value) value = std::stod(fmt::format("{:.5g}", value));
    EXPECT_EQ(fingerprint_of(text), fingerprint_of(series));
}

TEST(FlightIdentity, IsAnotherOfEveryOtherFlight) {
    std::set<std::uint64_t> fingerprints;
    for (int number = 1; number <= 6; ++number) fingerprints.insert(fingerprint_of(sample(number)));
    EXPECT_EQ(fingerprints.size(), 6U);
}

/// Sensors without noise, and the same power at the same time: the plan, not the flight.
TEST(FlightIdentity, IsNotThatOfAnotherWithTheSamePower) {
    const auto series = sample(1);
    auto other = sample(2);
    for (const auto* name : {"power_w", "current_a", "voltage_v"}) replace_track(other, select_track(series, name));
    EXPECT_NE(fingerprint_of(series), fingerprint_of(other));
}

TEST(FlightIdentity, OfWhatDoesNotVaryIsUnknown) {
    FlightSeries series;
    series.tracks = {Track{"altitude_m", "", "", 0.0, {0.0, 1.0, 2.0}, {5.0, 5.0, 5.0}}};
    EXPECT_EQ(fingerprint_of(series), 0U);
}

TEST(Aircraft, OfASimulatorAreLabelled) {
    EXPECT_TRUE(is_simulated("ArduPlane SITL"));
    EXPECT_FALSE(is_simulated("ArduPlane"));
    EXPECT_TRUE(is_simulated("Bebop NPS"));
    EXPECT_FALSE(is_simulated("NPS_Zagi")) << "NPS may be a part of a name";
    EXPECT_EQ(describe_aircraft("1", "PX4 HITL"), "1 PX4 HITL (SIMULATED)");
    EXPECT_EQ(describe_aircraft("", ""), "unknown");
}

TEST(Aircraft, AreKnownAsSyntheticWithoutTheirLogToo) {
    const auto folder = test::scratch_dir();
    const auto data = read_file(test::source_dir() / "logs" / "opterra_synthetic_01.data");
    write_file_atomically(folder / "a.data", data);
    const auto series = read_flight(folder / "a.data");
    EXPECT_TRUE(is_synthetic(series.aircraft_name));
    EXPECT_TRUE(is_synthetic(parse_series_csv(to_csv(series), "a.csv").aircraft_name));
    EXPECT_TRUE(is_synthetic(sample(1).aircraft_name));
    EXPECT_FALSE(is_synthetic("Twinstar"));
}

}  // namespace
}  // namespace flightwatt::flight
