#include "flight/sources/log_family.h"

#include "base/input_file.h"
#include "flight/flight_identity.h"
#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "flight/series_file.h"
#include "helpers/autopilot_logs.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::Contains;
using testing::HasSubstr;

FlightSeries series_of(const std::string& bytes, const std::string& name = "x.bin") {
    return read_candidates(FlightFile(test::write_text(test::scratch_dir() / name, bytes)), std::nullopt).at(0);
}

double energy_wh(const FlightSeries& series) {
    const auto power = power_track(series);
    if (power.empty()) return 0.0;
    return integrated(power.time_s, power.value, power.time_s.front(), power.time_s.back()) / units::seconds_per_hour;
}

TEST(LogFamily, ReadsACopter) {
    const auto series = series_of(test::dataflash_log(100));
    EXPECT_EQ(series.aircraft_name, "ArduCopter");
    EXPECT_EQ(series.aircraft_id, "002A001A-3038510C-31353236");
    EXPECT_EQ(series.firmware, "rotorcraft");
    EXPECT_EQ(series.current_origin, CurrentOrigin::sensor);
    EXPECT_FALSE(series.log_is_missing);
    const auto power = power_track(series);
    EXPECT_EQ(power.source, "BAT.Volt * BAT.Curr");
    ASSERT_EQ(power.time_s.size(), 100U);
    EXPECT_NEAR(power.value[50], 15.95 * 15.0, 1e-9);
    EXPECT_EQ(select_track(series, "altitude_m").source, "BARO.Alt");
    EXPECT_THAT(series.notes, Contains("the log states no units: BAT.Curr is read in A, BAT.Volt is read in V"));
}

TEST(LogFamily, SeriesFileLosesNothing) {
    for (const auto& bytes : {test::dataflash_log(50), test::ulog_log(50)}) {
        auto series = series_of(bytes);
        auto read = parse_series_csv(to_csv(series), "x.csv");
        read.file = series.file;
        EXPECT_EQ(read, series);
    }
}

TEST(LogFamily, OfASimulatorIsLabelledAndExcluded) {
    auto series = series_of(test::dataflash_log(100) + test::dataflash_text(3, "RC Protocol: SITL"));
    EXPECT_EQ(describe_aircraft("", series.aircraft_name), "ArduCopter SITL (SIMULATED)");
    LoadOptions options;
    EXPECT_EQ(simulation_reason(series.aircraft_name, options),
              "a simulator flew it (ArduCopter SITL); --simulated uses such flights");
    options.flight_required = false;
    EXPECT_THAT(segment_and_check(series, options).exclusion, HasSubstr("a simulator flew it"));
    options.simulated = true;
    EXPECT_EQ(segment_and_check(series, options).exclusion, "");
}

TEST(LogFamily, OfAnotherAircraftIsRefused) {
    const FlightFile file(test::write_text(test::scratch_dir() / "x.ulg", test::ulog_log(5)));
    EXPECT_EQ(read_candidates(file, "0A1B").at(0).aircraft_id, "0A1B");
    EXPECT_EQ(read_candidates(file, "x").size(), 1U) << "the flight's name";
    EXPECT_THROW(read_candidates(file, "7"), OtherAircraftError);
    EXPECT_EQ(read_candidates(file, "7", false).size(), 1U) << "not required";
}

TEST(LogFamily, WithoutACurrentSensorHasNoPower) {
    auto log = test::ulog_header() + test::ulog_definitions();
    for (int i = 0; i < 20; ++i) log += test::ulog_battery(7, 10.0 + i, 22.0F, -1.0F);
    EXPECT_THAT(
        test::rejected([&] { require_power(series_of(log, "x.ulg")); }),
        HasSubstr("battery_status.voltage_v * battery_status.current_a has no value: there is no current sensor"));
}

TEST(Batteries, InParallelAreSummed) {
    const auto series = series_of(test::ulog_log(50), "x.ulg");
    EXPECT_TRUE(series.notes.empty()) << "the names of ULog's fields state their units";
    const auto power = power_track(series);
    ASSERT_EQ(power.time_s.size(), 50U);
    EXPECT_NEAR(power.value[0], 22.0 * 15.0, 1e-6);
    EXPECT_NEAR(select_track(series, "current_a").value[0], 15.0, 1e-6);
    EXPECT_EQ(select_track(series, "voltage_v").value[0], 22.0);
    EXPECT_THAT(warnings_of(series),
                Contains("the power is the sum over the batteries battery_status 0 (22.00 V, 10.05 "
                         "A) and battery_status 1 (22.00 V, 5.00 A)"));
}

TEST(Batteries, SpareInputsAndOtherCircuitsAreNamed) {
    const auto spare = series_of(test::ulog_log(50, 0.19F), "spare.ulg");
    EXPECT_NEAR(power_track(spare).value[0], 220.0, 1e-6);
    EXPECT_THAT(warnings_of(spare),
                Contains(HasSubstr("battery_status 1 (22.00 V, 0.19 A) is not counted: a spare input")));
    const auto other = series_of(test::ulog_log(50, 2.0F, 50.0F), "other.ulg");
    EXPECT_NEAR(power_track(other).value[0], 220.0, 1e-6);
    EXPECT_THAT(warnings_of(other), Contains(HasSubstr("a circuit of its own")));
}

/// A log of the archive, with what its README states.
struct ArchivedLog {
    const char* file;
    std::size_t samples;
    double energy_wh;
    const char* name;
};

constexpr ArchivedLog archived_logs[] = {{"ardupilot/indoor_diaven1.bin", 1460, 1.8781, "ArduCopter"},
                                         {"ardupilot/indoor_yl1.bin", 2728, 16.1226, "ArduCopter"},
                                         {"ardupilot/indoor_yl2.bin", 521, 3.0079, "ArduCopter"},
                                         {"ardupilot/plane_cut.bin", 8, 0.0033, "ArduPlane"},
                                         {"ardupilot/quad_0036.bin", 1502, 8.5430, "ArduCopter"},
                                         {"ardupilot/sitl_plane.bin", 444, 2.7350, "ArduPlane SITL"},
                                         {"ardupilot/y6_2004.bin", 332, 37.1760, "ArduCopter"},
                                         {"ardupilot/y6_2044.bin", 301, 33.5688, "ArduCopter"},
                                         {"ardupilot/y6_2119.bin", 74, 8.4362, "ArduCopter"},
                                         {"px4/appended.ulg", 0, 0.0, "PX4"},
                                         {"px4/copter_upgrade.ulg", 166, 0.7707, "PX4"},
                                         {"px4/sitl_events.ulg", 0, 0.0, "PX4 SITL"},
                                         {"px4/vtol_ground.ulg", 21, 0.1282, "PX4"},
                                         {"px4/wing_proto9.ulg", 1736, 17.3678, "PX4"}};

std::filesystem::path archive() { return test::shared_dir() / "archives" / "autopilots"; }

TEST(LogFamily, EnergiesOfTheArchiveAreThoseOfItsReadme) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const auto& [file, samples, wh, name] : archived_logs) {
        SCOPED_TRACE(file);
        const auto series = read_candidates(FlightFile(archive() / file), std::nullopt).at(0);
        EXPECT_EQ(power_track(series).time_s.size(), samples);
        EXPECT_NEAR(energy_wh(series), wh, 1e-4 * wh + 0.00005);
        EXPECT_EQ(series.aircraft_name, name);
        EXPECT_FALSE(series.clock_restart);
        for (const auto& skip : series.skipped) EXPECT_LT(skip.count(), 100U) << describe(skip);
    }
}

/// Lift-off and touchdown as its README states them, with their tolerances; 0: the log begins or ends in the air.
struct ArchivedFlight {
    const char* file;
    double lift_off_s, lift_off_to_s;
    double touchdown_s, touchdown_to_s;
};

constexpr ArchivedFlight archived_flights[] = {
    {"ardupilot/indoor_diaven1.bin", 79.5, 1.0, 115.0, 1.0}, {"ardupilot/indoor_yl2.bin", 65.0, 1.0, 0.0, 0.0},
    {"ardupilot/quad_0036.bin", 241.5, 1.5, 374.0, 1.0},     {"ardupilot/sitl_plane.bin", 72.4, 0.5, 0.0, 0.0},
    {"ardupilot/y6_2004.bin", 322.8, 1.0, 643.0, 1.0},       {"ardupilot/y6_2044.bin", 58.3, 1.0, 346.3, 1.0},
    {"ardupilot/y6_2119.bin", 38.0, 1.0, 0.0, 0.0},          {"px4/copter_upgrade.ulg", 1095.2, 0.1, 1123.7, 0.1},
    {"px4/wing_proto9.ulg", 341.7, 0.1, 848.0, 2.0}};

TEST(LogFamily, EdgesOfTheArchiveAreThoseOfItsReadme) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const auto& [file, lift_off_s, lift_off_to_s, touchdown_s, touchdown_to_s] : archived_flights) {
        SCOPED_TRACE(file);
        const auto loaded = load_flight(archive() / file);
        ASSERT_EQ(loaded.phases.sorties.size(), 1U);
        const auto& phases = loaded.phases.sorties[0].phases;
        EXPECT_NEAR(phases.front().start.time_s, lift_off_s, lift_off_to_s);
        EXPECT_EQ(phases.back().complete && phases.back().phase == Phase::landing, touchdown_s > 0.0);
        if (touchdown_s > 0.0) {
            EXPECT_NEAR(phases.back().end.time_s, touchdown_s, touchdown_to_s);
        }
        EXPECT_THAT(loaded.power.power_faults, testing::IsEmpty());
    }
}

/// A copy that is cut, lacks a part, has a foreign or a repeated one, or flipped bits.
std::string damaged_copy(std::string log, unsigned kind, std::mt19937& random) {
    const auto at = random() % log.size();
    const auto part = log.substr(at, random() % 20'000);
    if (kind == 0) log.resize(at);
    if (kind == 1) log.erase(at, part.size());
    if (kind == 2) log.insert(random() % log.size(), part);
    if (kind == 3) log.replace(at, part.size(), part.size(), '\xFF');
    for (int i = 0; kind == 4 && i < 50; ++i) log[4096 + random() % (log.size() - 4096)] ^= '\x10';
    return log;
}

TEST(LogFamily, DamagedLogsOfTheArchiveInventNothing) {
    FLIGHTWATT_NEEDS_SHARED();
    constexpr double flipped_values = 0.04;  // of one sample in 74: DataFlash has no checksums
    std::mt19937 random(3);
    for (const auto& [file, samples, wh, name] : archived_logs) {
        SCOPED_TRACE(file);
        const auto whole = read_file(archive() / file);
        if (whole.size() > 1'000'000 || samples == 0) continue;
        for (unsigned copy = 0; copy < 50; ++copy) {
            const auto bytes = damaged_copy(whole, copy % 5, random);
            if (!telemetry::detect_autopilot_format(bytes)) continue;
            const auto series = series_of(bytes, "damaged.bin");
            const auto power = power_track(series);
            EXPECT_LE(power.time_s.size(), samples);
            if (power.empty() || series.clock_restart) continue;
            const auto statistics = PowerStatistics(series).between(power.time_s.front(), power.time_s.back());
            EXPECT_LE(statistics.energy_wh, (1.0 + flipped_values) * wh + 1e-3) << copy;
        }
    }
}

TEST(LogFamily, DamageHidesTheEnergyOfItsTime) {
    auto log = test::dataflash_log(100);
    log.erase(log.size() / 2, 500);
    const auto series = series_of(log);
    const auto power = power_track(series);
    const auto statistics = PowerStatistics(series).between(power.time_s.front(), power.time_s.back());
    EXPECT_GT(statistics.lost_s, 1.0);
    EXPECT_LT(statistics.energy_wh, energy_wh(series));
    EXPECT_NEAR(statistics.mean_power_w * (9.9 - statistics.lost_s), statistics.energy_wh * 3600.0, 1e-6);
}

TEST(LogFamily, SyntheticLogsAreNamed) {
    const auto series = series_of(test::dataflash_log(9) + test::dataflash_text(3, "SYNTHETIC: no aircraft flew it"));
    EXPECT_EQ(series.aircraft_name, "ArduCopter_synthetic");
}

}  // namespace
}  // namespace flightwatt::flight
