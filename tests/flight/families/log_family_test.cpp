#include "flight/families/log_family.h"

#include "base/input_file.h"
#include "base/units.h"
#include "flight/families/ardupilot_family.h"
#include "flight/flight_identity.h"
#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "flight/series_file.h"
#include "helpers/autopilot_logs.h"
#include "helpers/rejected.h"
#include "helpers/selected_tracks.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::Contains;
using testing::HasSubstr;

FlightSeries series_of(const std::string& bytes, const std::string& name = "x.bin") {
    return read_candidates(FlightFile(test::write_text(test::scratch_dir() / name, bytes)), std::nullopt).at(0);
}

/// The power of the circuit with the most energy, which READMEs state, or of the only one.
Track circuit_power(const FlightSeries& series) {
    const auto data = select_tracks(series);
    return data.circuits.empty() ? Track(data.power_w) : data.circuits.front().power_w;
}

double energy_wh(const FlightSeries& series) {
    const auto power = circuit_power(series);
    if (power.empty()) return 0.0;
    return integrated(power.time_s, power.value, power.time_s.front(), power.time_s.back()) / units::seconds_per_hour;
}

TEST(LogFamily, KnowsMonitorsOnTheSamePinsAndSmartPacks) {
    const auto kinds = [](const std::map<std::string, double>& parameters) {
        FlightSeries series;
        add_monitor_kinds(parameters, series);
        return series.monitor_kinds;
    };
    using Kinds = std::map<std::string, std::string>;
    std::map<std::string, double> analog{{"BATT_MONITOR", 4.0},  {"BATT_VOLT_PIN", 2.0},  {"BATT_CURR_PIN", 3.0},
                                         {"BATT2_MONITOR", 4.0}, {"BATT2_VOLT_PIN", 2.0}, {"BATT2_CURR_PIN", 3.0}};
    EXPECT_EQ(kinds(analog), (Kinds{{"1", same_pins_monitor}}));
    analog["BATT2_CURR_PIN"] = 4.0;
    EXPECT_EQ(kinds(analog), Kinds{});
    std::map<std::string, double> smart{
        {"BATT_MONITOR", 8.0}, {"BATT_SERIAL_NUM", 11.0}, {"BATT2_MONITOR", 8.0}, {"BATT2_SERIAL_NUM", 12.0}};
    EXPECT_EQ(kinds(smart), (Kinds{{"0", smart_pack_monitor}, {"1", smart_pack_monitor}}));
    smart["BATT2_SERIAL_NUM"] = -1.0;
    EXPECT_EQ(kinds(smart), Kinds{}) << "any serial number";
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

TEST(LogFamily, ReadsCapacitiesOfPacksFromParametersInMilliampereHours) {
    using Capacities = std::map<std::string, double>;
    const Capacities ardupilot{{"BATT_CAPACITY", 5200.0}, {"BATT2_CAPACITY", 2200.0}, {"BATT3_CAPACITY", 0.0}};
    EXPECT_EQ(monitor_capacities_ah(ardupilot, {"BATT_CAPACITY"}, "BATTN_CAPACITY"),
              (Capacities{{"0", 5.2}, {"1", 2.2}}));
    const Capacities px4{{"BAT_CAPACITY", 4000.0}, {"BAT2_CAPACITY", -1.0}};
    EXPECT_EQ(monitor_capacities_ah(px4, {"BAT1_CAPACITY", "BAT_CAPACITY"}, "BATN_CAPACITY"), (Capacities{{"0", 4.0}}));
}

TEST(LogFamily, ReadsCellsOfPacksFromParameters) {
    using Cells = std::map<std::string, double>;
    const Cells parameters{{"BAT1_N_CELLS", 12.0}, {"BAT2_N_CELLS", 6.0}, {"BAT3_N_CELLS", 0.0}};
    EXPECT_EQ(monitor_parameters(parameters, {"BAT1_N_CELLS", "BAT_N_CELLS"}, "BATN_N_CELLS"),
              (Cells{{"0", 12.0}, {"1", 6.0}}));
}

TEST(LogFamily, ReadsThatAQuadplaneIsOnItsWingWhileItLogsNoLiftMotors) {
    auto log = test::dataflash_log(300, "ArduPlane V4.3.1 (2cb4b85a)") +
               test::dataflash_format(4, "QTUN", "Qf", "TimeUS,ThO", 12);
    EXPECT_TRUE(select_track(series_of(log), "vtol_state").empty()) << "defined, but never sent";
    const auto add_lift = [&](double from_s, double to_s) {
        for (double time_s = from_s; time_s <= to_s; time_s += 0.25)
            log += test::dataflash_message(
                4, test::little_endian(static_cast<std::uint64_t>(time_s * 1e6)) + test::little_endian(0.4F));
    };
    add_lift(12.0, 15.0);
    add_lift(30.0, 38.75);
    const auto series = series_of(log);
    EXPECT_EQ(series.firmware, "fixedwing");
    const auto state = select_track(series, "vtol_state");
    EXPECT_EQ(state.source, "QTUN.ThO");
    const auto at = [&](double time_s) { return state_at(state, time_s); };
    EXPECT_EQ((std::vector{at(14.0), at(15.9), at(16.0), at(29.9), at(30.0), at(38.0)}),
              (std::vector{3.0, 3.0, 4.0, 4.0, 3.0, 3.0}));
    EXPECT_EQ(state.time_s.back(), 39.75) << "the log ends at 39.9 s without them";
}

/// A log with messages of a topic a second, each after one of the battery.
std::string ulog_of(const std::string& topic, const std::string& fields, const std::vector<std::string>& states) {
    auto log = test::ulog_header() + test::ulog_definitions() +
               test::ulog_message('F', topic + ":uint64_t timestamp;" + fields) + test::ulog_subscription(0, 9, topic);
    for (std::size_t i = 0; i < states.size(); ++i) {
        const double time_s = 10.0 + static_cast<double>(i);
        log += test::ulog_battery(7, time_s, 22.0F, 10.0F) +
               test::ulog_message('D', test::little_endian(std::uint16_t{9}) +
                                           test::little_endian(static_cast<std::uint64_t>(time_s * 1e6)) + states[i]);
    }
    return log;
}

std::string ulog_of_vtol(const std::string& fields, const std::vector<std::string>& states) {
    return ulog_of("vtol_vehicle_status", fields, states);
}

TEST(LogFamily, ReadsTheStateOfPx4VtolsOfAllVersions) {
    const std::string no(1, '\0');
    const std::string yes(1, '\1');
    const auto flags = ulog_of_vtol("bool vtol_in_rw_mode;bool vtol_in_trans_mode;bool in_transition_to_fw;",
                                    {yes + no + no, yes + yes + yes, no + no + no, yes + yes + no});
    EXPECT_EQ(select_track(series_of(flags, "x.ulg"), "vtol_state").value, (std::vector{3.0, 1.0, 4.0, 2.0}));
    const auto numbers = ulog_of_vtol("uint8_t vehicle_vtol_state;", {no, "\3", "\1", "\4"});
    EXPECT_EQ(select_track(series_of(numbers, "x.ulg"), "vtol_state").value, (std::vector{3.0, 1.0, 4.0}));
}

/// Logs without vtol_vehicle_status counted hover as flight on the wing.
TEST(LogFamily, ReadsTheStateOfPx4VtolsOfTheirVehicleStatus) {
    const std::string no(1, '\0');
    const std::string yes(1, '\1');
    const std::string wing(1, '\2');
    const std::string fields = "uint8_t vehicle_type;bool is_vtol;bool in_transition_mode;bool in_transition_to_fw;";
    const auto state_of = [&](const std::vector<std::string>& states) {
        return select_track(series_of(ulog_of("vehicle_status", fields, states), "x.ulg"), "vtol_state");
    };
    EXPECT_EQ(state_of({yes + yes + no + no, yes + yes + yes + yes, wing + yes + no + no, yes + yes + yes + no}).value,
              (std::vector{3.0, 1.0, 4.0, 2.0}));
    EXPECT_TRUE(state_of({yes + no + no + no, yes + no + no + no}).empty()) << "a multirotor";
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

TEST(LogFamily, AVehicleStandsInThePreambleOfAText) {
    const auto series = series_of(
        "1\n\nArduCopter V3.0.1 (5c6503e2)\nFree RAM: 1331\nAPM 2\n"
        "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\nFMT, 1, 9, CURR, Ih, TimeMS,Volt\n"
        "CURR, 1000, 1480\nCURR, 1100, 1481\n",
        "x.log");
    EXPECT_EQ(series.aircraft_name, "ArduCopter");
    EXPECT_EQ(series.firmware, "rotorcraft");
    const auto rover = series_of(test::dataflash_log(9, "APMrover2 V3.0.1 (2cb4b85a)"));
    EXPECT_EQ(rover.firmware, "rover");
    const auto plane =
        series_of(test::dataflash_log(9, "") + test::dataflash_format(9, "PARM", "QNf", "TimeUS,Name,Value", 28) +
                  test::dataflash_message(9, test::little_endian(std::uint64_t{11'000'000}) +
                                                 test::padded("SYSID_SW_TYPE", 16) + test::little_endian(0.0F)));
    EXPECT_EQ(plane.firmware, "fixedwing");
}

/// A log with one GPS message of a week, at 10.5 s.
FlightSeries of_week(std::uint16_t week) {
    return series_of(test::dataflash_log(9) + test::dataflash_format(4, "GPS", "QBIH", "TimeUS,Status,GMS,GWk", 15) +
                     test::dataflash_message(4, test::little_endian(std::uint64_t{10'500'000}) + '\x03' +
                                                    test::little_endian(std::uint32_t{3'600'000}) +
                                                    test::little_endian(week)));
}

TEST(LogFamily, ADateBefore2010IsThatOfAnOverflowedWeek) {
    const auto right = of_week(2206);  // 17 April 2022
    ASSERT_TRUE(right.start_clock_s);
    EXPECT_EQ(*right.start_clock_s, 1'650'157'182.0 - 10.5) << "01:00 of GPS, less 18 leap seconds";
    for (const std::uint16_t lost : {1024, 2048}) {
        const auto series = of_week(static_cast<std::uint16_t>(2206 - lost));
        EXPECT_EQ(series.start_clock_s, right.start_clock_s);
        EXPECT_THAT(series.notes, Contains(HasSubstr(fmt::format("GPS.GWk is {} weeks too early", lost))));
    }
    EXPECT_THAT(right.notes, testing::Each(testing::Not(HasSubstr("weeks"))));
    EXPECT_FALSE(of_week(0).start_clock_s);
}

TEST(LogFamily, OfPx4Until2018HasItsBarometerInSensorCombined) {
    auto log = test::ulog_log(50) +
               test::ulog_message('F', "sensor_combined:uint64_t timestamp;float baro_alt_meter;") +
               test::ulog_subscription(0, 9, "sensor_combined");
    for (int i = 0; i < 3; ++i)
        log += test::ulog_message('D', test::little_endian(std::uint16_t{9}) +
                                           test::little_endian(std::uint64_t{20'000'000} + std::uint64_t{100'000} * i) +
                                           test::little_endian(500.0F + static_cast<float>(i)));
    EXPECT_EQ(select_track(series_of(log, "x.ulg"), "altitude_m").source, "sensor_combined.baro_alt_meter");
}

TEST(LogFamily, OfSdlog2IsReadAsPx4) {
    auto log = test::dataflash_format(129, "TIME", "Q", "StartTime", 8) +
               test::dataflash_format(20, "BATT", "fff", "V,C,Discharged", 12) +
               test::dataflash_format(4, "SENS", "ff", "BaroPres,BaroAlt", 8) +
               test::dataflash_format(9, "ATTC", "ffff", "Roll,Pitch,Yaw,Thrust", 16) +
               test::dataflash_format(10, "STAT", "BBBfBB", "MainState,NavState,ArmS,BatRem,BatWarn,Landed", 9) +
               test::dataflash_format(11, "PARM", "Nf", "Name,Value", 20) +
               test::dataflash_message(11, test::padded("MAV_TYPE", 16) + test::little_endian(2.0F));
    for (unsigned i = 0; i < 20; ++i) {
        const auto step = static_cast<float>(i);
        log +=
            test::dataflash_message(129, test::little_endian(std::uint64_t{3'000'000} + std::uint64_t{100'000} * i)) +
            test::dataflash_message(
                20, test::little_endian(16.0F) + test::little_endian(step) + test::little_endian(100.0F * step)) +
            test::dataflash_message(4, test::little_endian(1000.0F) + test::little_endian(500.0F + step)) +
            test::dataflash_message(9, std::string(12, '\0') + test::little_endian(0.25F + 0.01F * step)) +
            test::dataflash_message(10, std::string("\x03\x03\x02", 3) + std::string(5, '\0') + '\x01');
    }
    const auto series = series_of(log, "x.px4log");
    EXPECT_EQ(series.aircraft_name, "PX4");
    EXPECT_EQ(series.firmware, "rotorcraft");
    EXPECT_EQ(series.flight, "x");
    EXPECT_EQ(power_track(series).source, "BATT.V * BATT.C");
    EXPECT_EQ(power_track(series).value.at(2), 32.0);
    EXPECT_EQ(select_track(series, "altitude_m").value.at(1), 501.0);
    EXPECT_NEAR(select_track(series, "throttle_percent").value.at(0), 25.0, 1e-6);
    EXPECT_EQ(select_track(series, "armed").value.at(0), 1.0);
    EXPECT_EQ(select_track(series, "landed").value.at(0), 1.0);
    EXPECT_NEAR(select_track(series, "charge_ah").value.at(10), 1.0, 1e-9);
}

/// A PX4 log of two smart batteries with these serial numbers and cycles.
FlightSeries with_smart_batteries(std::uint16_t first, std::uint16_t second, std::uint16_t cycles) {
    auto log = test::ulog_header() +
               test::ulog_message('F',
                                  "battery_status:uint64_t timestamp;float voltage_v;float current_a;"
                                  "uint16_t cycle_count;uint16_t serial_number;uint8_t cell_count;uint8_t id;") +
               test::ulog_subscription(0, 7, "battery_status") + test::ulog_subscription(1, 8, "battery_status");
    for (unsigned i = 0; i < 20; ++i)
        for (const std::uint16_t topic : {7, 8})
            log += test::ulog_message(
                'D', test::little_endian(topic) +
                         test::little_endian(std::uint64_t{10'000'000} + std::uint64_t{200'000} * i + topic) +
                         test::little_endian(22.0F) + test::little_endian(10.0F + 0.1F * static_cast<float>(i % 2)) +
                         test::little_endian(cycles) + test::little_endian(topic == 7 ? first : second) +
                         (topic == 7 ? "\x06\x01" : std::string("\0\x01", 2)));
    return series_of(log, "x.ulg");
}

TEST(LogFamily, SmartBatteriesOfPx4StateTheirSerialNumbers) {
    EXPECT_EQ(with_smart_batteries(31415, 0, 12).pack_serial, "31415");
    const auto two = with_smart_batteries(31415, 27182, 12);
    EXPECT_EQ(two.pack_serial, "31415+27182");
    EXPECT_EQ(two.pack_cycles, 12.0);
    EXPECT_EQ(two.monitor_cells, (std::map<std::string, double>{{"0", 6.0}})) << "0: not known";
    EXPECT_EQ(parse_series_csv(to_csv(two), "x.csv").monitor_cells, two.monitor_cells);
    EXPECT_EQ(parse_series_csv(to_csv(two), "x.csv").pack_serial, "31415+27182");
    EXPECT_EQ(parse_series_csv(to_csv(two), "x.csv").pack_cycles, 12.0);
    const auto unknown = with_smart_batteries(0, 65535, 0);
    EXPECT_EQ(unknown.pack_serial, "") << "the field id, 1, is a place in the vehicle";
    EXPECT_FALSE(unknown.pack_cycles);
}

TEST(LogFamily, BatteriesOfPx4ByEscsMeasureThePackOfAnother) {
    auto log =
        test::ulog_header() +
        test::ulog_message('F', "battery_status:uint64_t timestamp;float voltage_v;float current_a;uint8_t source;") +
        test::ulog_subscription(0, 7, "battery_status") + test::ulog_subscription(1, 8, "battery_status");
    for (unsigned i = 0; i < 20; ++i)
        for (const std::uint16_t topic : {7, 8})
            log += test::ulog_message(
                'D', test::little_endian(topic) +
                         test::little_endian(std::uint64_t{10'000'000} + std::uint64_t{200'000} * i + topic) +
                         test::little_endian(22.0F) +
                         test::little_endian((topic == 7 ? 1.0F : 0.9F) * (10.0F + static_cast<float>(i % 3))) +
                         std::string(1, topic == 7 ? '\0' : '\2'));
    const auto power = power_track(series_of(log, "x.ulg"));
    EXPECT_NEAR(power.value.at(0), 220.0, 1e-6) << "not that of two packs";
}

TEST(LogFamily, SerialNumbersOfArduPilotAreThoseOfSmbusMonitors) {
    const auto serial_of = [](float monitor, float serial) {
        auto log = test::dataflash_log(20) + test::dataflash_format(9, "PARM", "QNf", "TimeUS,Name,Value", 28);
        for (const auto& [name, value] : {std::pair{"BATT_MONITOR", monitor}, std::pair{"BATT_SERIAL_NUM", serial}})
            log += test::dataflash_message(9, test::little_endian(std::uint64_t{11'000'000}) + test::padded(name, 16) +
                                                  test::little_endian(value));
        return series_of(log).pack_serial;
    };
    EXPECT_EQ(serial_of(7.0F, 4711.0F), "4711");
    EXPECT_EQ(serial_of(7.0F, -1.0F), "");
    EXPECT_EQ(serial_of(4.0F, 4711.0F), "") << "an analog monitor does not read it";
    EXPECT_EQ(serial_of(8.0F, 3.0F), "") << "DroneCAN's battery_id is a place";
}

TEST(LogFamily, ParametersStateTheKindsOfMonitorsAndTheNumberOfMotors) {
    const auto of = [](const std::map<std::string, float>& parameters) {
        auto log = test::dataflash_log(20) + test::dataflash_format(9, "PARM", "QNf", "TimeUS,Name,Value", 28);
        for (const auto& [name, value] : parameters)
            log += test::dataflash_message(
                9, test::little_endian(std::uint64_t{1}) + test::padded(name, 16) + test::little_endian(value));
        return series_of(log);
    };
    using Kinds = std::map<std::string, std::string>;
    const auto measured = of({{"BATT_MONITOR", 4.0F}, {"BATT2_MONITOR", 11.0F}, {"BATT3_MONITOR", 9.0F}});
    EXPECT_EQ(measured.monitor_kinds, (Kinds{{"1", fuel_monitor}, {"2", escs_monitor}}));
    EXPECT_EQ(measured.current_origin, CurrentOrigin::sensor);
    const auto computed = of({{"BATT_MONITOR", 25.0F}, {"BATT2_MONITOR", 3.0F}, {"BATT3_MONITOR", 24.0F}});
    EXPECT_EQ(computed.current_origin, CurrentOrigin::throttle);
    EXPECT_EQ(of({{"BATT_MONITOR", 25.0F}, {"BATT2_MONITOR", 4.0F}}).current_origin, CurrentOrigin::sensor);
    EXPECT_FALSE(computed.motors);
    EXPECT_EQ(of({{"FRAME_CLASS", 2.0F}}).motors, 6.0);
    EXPECT_EQ(of({{"FRAME_CLASS", 6.0F}}).motors, std::nullopt) << "a helicopter's servos are not counted";
    const auto quadplane = of({{"Q_ENABLE", 1.0F}, {"Q_FRAME_CLASS", 3.0F}});
    EXPECT_EQ(parse_series_csv(to_csv(quadplane), "x.csv").motors, 8.0);
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
        test::rejected([&] { require_power(select_tracks(series_of(log, "x.ulg"))); }),
        HasSubstr("battery_status.voltage_v * battery_status.current_a has no value: there is no current sensor"));
}

TEST(LogFamily, FixIsThatOfAnyReceiver) {
    auto log = test::dataflash_log(100) + test::dataflash_format(4, "GPS", "QBBf", "TimeUS,I,Status,Alt", 14);
    const auto gps = [&](unsigned time_s, std::uint8_t receiver, std::uint8_t status, float alt_m) {
        log += test::dataflash_message(4, test::little_endian(std::uint64_t{time_s} * 1'000'000) +
                                              test::little_endian(receiver) + test::little_endian(status) +
                                              test::little_endian(alt_m));
    };
    gps(20, 0, 1, 9e3F);
    gps(21, 1, 3, 30.0F);
    gps(22, 0, 4, 31.0F);
    gps(23, 1, 2, 9e3F);
    gps(24, 0, 1, 9e3F);
    const auto series = series_of(log);
    const auto fix = select_track(series, "fix");
    EXPECT_EQ(fix.source, "GPS.Status");
    EXPECT_THAT(fix.value, testing::ElementsAre(0, 1, 1, 1, 0));
    std::vector<double> altitudes_m;
    for (const auto& track : series.tracks)
        if (track.source.starts_with("GPS") && track.name == "altitude_m")
            altitudes_m.insert(altitudes_m.end(), track.value.begin(), track.value.end());
    EXPECT_THAT(altitudes_m, testing::ElementsAre(31, 30)) << "of receiver 0, then of 1";
    EXPECT_EQ(parse_series_csv(to_csv(series), "x.csv").tracks, series.tracks);
}

TEST(LogFamily, AirspeedIsThatOfAHealthySensorInUse) {
    auto log = test::dataflash_log(100, "ArduPlane V4.3.1 (2cb4b85a)") +
               test::dataflash_format(4, "ARSP", "QBfBB", "TimeUS,I,Airspeed,U,H", 15);
    const auto sensor = [&](unsigned time_s, float m_per_s, std::uint8_t is_used, std::uint8_t is_healthy) {
        log += test::dataflash_message(4, test::little_endian(std::uint64_t{time_s} * 1'000'000) +
                                              test::little_endian(std::uint8_t{0}) + test::little_endian(m_per_s) +
                                              test::little_endian(is_used) + test::little_endian(is_healthy));
    };
    sensor(20, 4.0F, 0, 1);
    sensor(21, 15.0F, 1, 1);
    sensor(22, 5.0F, 1, 0);
    sensor(23, 16.0F, 1, 1);
    EXPECT_THAT(select_track(series_of(log), "airspeed_m_per_s").value, testing::ElementsAre(15, 16));
}

TEST(Batteries, OfArduPilotThatAreNotHealthyRepeatTheirLastValues) {
    auto log = test::dataflash_format(3, "MSG", "QZ", "TimeUS,Message", 72) +
               test::dataflash_text(3, "ArduCopter V4.6.0 (2cb4b85a)") +
               test::dataflash_format(4, "BAT", "QBffB", "TimeUS,Inst,Volt,Curr,H", 18);
    for (unsigned i = 0; i < 40; ++i)
        log += test::dataflash_message(4, test::little_endian(std::uint64_t{20'000'000} + std::uint64_t{100'000} * i) +
                                              test::little_endian(std::uint8_t{0}) + test::little_endian(16.0F) +
                                              test::little_endian(10.0F + 0.1F * static_cast<float>(std::min(i, 20U))) +
                                              test::little_endian(static_cast<std::uint8_t>(i < 20 ? 1 : 0)));
    EXPECT_EQ(power_track(series_of(log)).time_s.size(), 20U);
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

/// A log of two batteries of 10 A and 5 A with these temperatures, the first of which is 0 in one message.
FlightSeries with_temperatures(double first_c, double second_c) {
    auto log = test::dataflash_format(1, "BAT", "QBffc", "TimeUS,Instance,Volt,Curr,Temp", 19);
    for (unsigned i = 0; i < 50; ++i)
        for (const std::uint8_t battery : {0, 1}) {
            const double temperature_c = battery == 0 ? (i == 7 ? 0.0 : first_c) : second_c;
            log +=
                test::dataflash_message(1, test::little_endian(std::uint64_t{10'000'000} + std::uint64_t{100'000} * i) +
                                               test::little_endian(battery) + test::little_endian(22.0F) +
                                               test::little_endian(battery == 0 ? 10.0F : 5.0F) +
                                               test::little_endian(static_cast<std::int16_t>(100.0 * temperature_c)));
        }
    return series_of(log);
}

TEST(Batteries, TemperatureIsThatOfThePackWhoseVoltageIsChosen) {
    const auto data = select_tracks(with_temperatures(-3.5, 21.0));
    EXPECT_EQ(data.battery_temperature_c.source, "BAT.Temp");
    EXPECT_EQ(data.battery_temperature_c.value, std::vector(49, -3.5)) << "0 is no temperature";
    const auto series = with_temperatures(0.0, 21.0);
    EXPECT_TRUE(select_tracks(series).battery_temperature_c.empty());
    EXPECT_EQ(std::ranges::count(series.tracks, "battery_temperature_c", &Track::name), 1) << "no empty column";
    EXPECT_EQ(truncate_series(series, 9.0).tracks, std::vector<Track>{});
}

TEST(Batteries, OfPx4WithoutASensorStateNoTemperature) {
    const auto temperature_c = [](float stated_c) {
        auto log = test::ulog_header() +
                   test::ulog_message('F',
                                      "battery_status:uint64_t timestamp;float voltage_v;float current_a;"
                                      "float temperature;") +
                   test::ulog_subscription(0, 7, "battery_status");
        for (unsigned i = 0; i < 20; ++i)
            log += test::ulog_message(
                'D', test::little_endian(std::uint16_t{7}) +
                         test::little_endian(std::uint64_t{10'000'000} + std::uint64_t{200'000} * i) +
                         test::little_endian(22.0F) + test::little_endian(10.0F + 0.1F * static_cast<float>(i)) +
                         test::little_endian(stated_c));
        return first_value(select_tracks(series_of(log, "x.ulg")).battery_temperature_c);
    };
    EXPECT_EQ(temperature_c(21.5F), 21.5);
    for (const float none : {0.0F, -1.0F, std::nanf("")}) EXPECT_FALSE(temperature_c(none)) << none;
}

TEST(Batteries, SpareInputsAndCircuitsAreNamed) {
    const auto spare = series_of(test::ulog_log(50, 0.19F), "spare.ulg");
    EXPECT_NEAR(power_track(spare).value[0], 220.0, 1e-6);
    EXPECT_THAT(warnings_of(spare),
                Contains(HasSubstr("battery_status 1 (22.00 V, 0.19 A) is not counted: a spare input")));
    const auto other = series_of(test::ulog_log(50, 2.0F, 50.0F), "other.ulg");
    EXPECT_NEAR(power_track(other).value[0], 320.0, 1e-6);
    EXPECT_THAT(warnings_of(other), Contains(HasSubstr("batteries of circuits of their own")));
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
            auto data = select_tracks(series);
            static_cast<Track&>(data.power_w) = circuit_power(series);
            const auto& power = data.power_w;
            EXPECT_LE(power.time_s.size(), samples);
            if (power.empty() || series.clock_restart) continue;
            const auto statistics = PowerStatistics(data).between(power.time_s.front(), power.time_s.back());
            EXPECT_LE(statistics.energy_wh, (1.0 + flipped_values) * wh + 1e-3) << copy;
        }
    }
}

TEST(LogFamily, DamageHidesTheEnergyOfItsTime) {
    auto log = test::dataflash_log(100);
    log.erase(log.size() / 2, 500);
    const auto series = series_of(log);
    const auto power = power_track(series);
    const auto statistics = PowerStatistics(select_tracks(series)).between(power.time_s.front(), power.time_s.back());
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
