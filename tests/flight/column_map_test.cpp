#include "flight/column_map.h"

#include "flight/families/mapped_csv.h"
#include "flight/load_flight.h"
#include "helpers/rejected.h"
#include "helpers/selected_tracks.h"
#include "helpers/table_flights.h"
#include "helpers/test_paths.h"

#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr auto m100_header =
    "time,wind_speed,wind_angle,battery_voltage,battery_current,position_x,position_y,position_z,velocity_x,"
    "velocity_y,velocity_z\n";

const std::string small_map =
    "aircraft_name = \"A\"\ntime = { column = \"t\", unit = \"ms\", clock = \"unix\" }\n"
    "[[track]]\nname = \"power_w\"\nproduct = [\"u\", \"i\"]\nfactor = 0.001\n"
    "[[track]]\nname = \"altitude_m\"\ncolumn = \"down\"\nunit = \"cm\"\nfactor = -1\n";

TEST(ColumnMap, OfTheBenchmarkIsRecognisedByItsHeader) {
    const auto file = test::write_text(test::scratch_dir() / "1.csv",
                                       std::string(m100_header) +
                                           "0.00,0.1,12,24.0,0.5,-79.78,40.45,269.3,-3.0,4.0,0.01\n"
                                           "0.20,0.1,3,25.0,2.0,-79.78,40.45,270.3,-0.015,-0.002,0.01\n");
    const auto series = read_candidates(FlightFile(file), std::nullopt).at(0);
    EXPECT_EQ(series.flight, "1");
    EXPECT_EQ(series.aircraft_name, "Matrice 100");
    EXPECT_EQ(series.firmware, "rotorcraft");
    const auto power = power_track(series);
    EXPECT_EQ(power.source, "battery_voltage * battery_current");
    EXPECT_THAT(power.value, ElementsAre(12.0, 50.0));
    EXPECT_DOUBLE_EQ(select_track(series, "ground_speed_m_per_s").value[0], 5.0);
    EXPECT_EQ(select_track(series, "ground_speed_m_per_s").source, "|velocity_x, velocity_y|");
    EXPECT_TRUE(is_flight_csv(file, std::nullopt));
}

TEST(ColumnMap, HasUnitsFactorsAndClocks) {
    const auto map = parse_column_map(small_map, "map.toml");
    const auto series =
        parse_mapped_csv("t,u,i,down\n2000,10,5,-300\n1000,10,4,0\n3000,,x,1\n,1,1,1\n", "f.csv", map).at(0);
    EXPECT_EQ(series.start_clock_s, 2.0);
    ASSERT_EQ(series.tracks.size(), 2U);
    EXPECT_EQ(series.tracks[0].name, "altitude_m");
    EXPECT_THAT(series.tracks[0].time_s, ElementsAre(-1.0, 0.0, 1.0));
    EXPECT_THAT(series.tracks[0].value, ElementsAre(0.0, 3.0, testing::DoubleNear(-0.01, 1e-12)));
    EXPECT_THAT(series.tracks[1].value,
                ElementsAre(testing::DoubleNear(0.04, 1e-12), testing::DoubleNear(0.05, 1e-12)));
    ASSERT_EQ(series.skipped.size(), 1U);
    EXPECT_EQ(describe(series.skipped[0]), "cells that are no numbers: 1 line, first at line 4");
}

TEST(ColumnMap, StatesThePayload) {
    const auto payload_of = [](const std::string& track) {
        const auto map = parse_column_map(small_map + "[[track]]\nname = \"payload_kg\"\n" + track, "map.toml");
        return first_value(
            select_tracks(parse_mapped_csv("t,u,i,down,load\n2000,10,5,-300,\n3000,10,4,0,250\n", "f.csv", map).at(0))
                .payload_kg);
    };
    EXPECT_EQ(payload_of("value = 0.5\n"), 0.5);
    EXPECT_EQ(payload_of("value = 500\nunit = \"g\"\n"), 0.5);
    EXPECT_EQ(payload_of("column = \"load\"\nunit = \"g\"\n"), 0.25);
    EXPECT_EQ(first_value({}), std::nullopt);
}

TEST(ColumnMap, MistakesAreNamed) {
    const auto refusal = [](const std::string& text) {
        return test::rejected([&] { parse_column_map(text, "map.toml"); });
    };
    const std::string time = "time = { column = \"t\" }\n";
    EXPECT_EQ(refusal(time), "map.toml: has neither power_w nor altitude_m; add a [[track]] with this name");
    EXPECT_THAT(refusal(time + "[[track]]\nname = \"power_kw\"\ncolumn = \"p\"\n"),
                HasSubstr("map.toml:3:1: unknown track 'power_kw'; did you mean 'power_w'?"));
    EXPECT_THAT(refusal(time + "[[track]]\nname = \"power_w\"\ncolumn = \"p\"\nunit = \"V\"\n"),
                HasSubstr("'V' is no unit of power_w"));
    EXPECT_THAT(refusal(time + "[[track]]\nname = \"power_w\"\n"), HasSubstr("power_w has no source"));
    EXPECT_THAT(refusal(time + "[[track]]\nname = \"power_w\"\ncolumn = \"p\"\nvalue = 1\n"),
                HasSubstr("power_w has a second source"));
    const std::string twice = "[[track]]\nname = \"power_w\"\ncolumn = \"p\"\n";
    EXPECT_THAT(refusal(time + twice + twice), HasSubstr("map.toml:6:1: power_w is named twice"));
    EXPECT_THAT(
        refusal(time + "[[track]]\nname = \"altitude_m\"\ncolumn = \"p\"\nunit = \"furlong\"\n"),
        HasSubstr("'furlong' is no unit of altitude_m; expected a unit such as V, mA, mW, mAh, m, ft, cm/s, km/h, "
                  "mph, kt, deg, rad or %, or its factor"));
    EXPECT_THAT(refusal("time = { column = \"t\", unit = \"h\" }\n"), HasSubstr("'h' is no unit of time"));
    EXPECT_EQ(test::rejected([] { parse_mapped_csv("t,u\n1,2\n", "f.csv", parse_column_map(small_map, "m")); }),
              "f.csv:1: has no column 'i'; its columns are t, u");
}

TEST(ColumnMap, OfAnUnknownHeaderIsAskedFor) {
    const auto folder = test::scratch_dir();
    const auto file = test::write_text(folder / "f.csv", "t,u,i,down\n1,2,3,4\n2,3,4,5\n");
    EXPECT_EQ(test::rejected([&] { FlightFile{file}; }, folder),
              "f.csv:1: has no column 'time_s'; its columns are t, u, i, down; name them time_s, voltage_v, current_a "
              "(or power_w), altitude_m, with values in these units, or state which they are in a column map: "
              "--columns MAP.toml (docs/formats.md, Column map)");
    EXPECT_FALSE(is_flight_csv(file, std::nullopt));
    LoadOptions options;
    options.columns = test::write_text(folder / "map.toml", small_map);
    EXPECT_TRUE(is_flight_csv(file, options.columns));
    EXPECT_EQ(read_candidates(FlightFile(file, options), std::nullopt).at(0).aircraft_name, "A");
    const auto is_flight = [&](const char* header) {
        return is_flight_csv(test::write_text(folder / "s.csv", header), std::nullopt);
    };
    EXPECT_FALSE(is_flight("time_s,power_w,soc\n"));
    EXPECT_TRUE(is_flight("time_s,power_w,altitude_m.2\n"));
}

TEST(ColumnMap, ShippedOnesAreRead) {
    for (const auto& file : std::filesystem::directory_iterator(test::source_dir() / "config" / "columns"))
        EXPECT_FALSE(read_column_map(file.path()).tracks.empty()) << file.path();
}

/// The series of a table that is recognised by its header, and has the flight of table_flight().
FlightSeries recognised(const std::string& name, const std::string& text) {
    const auto file = test::write_text(test::scratch_dir() / name, text);
    EXPECT_TRUE(is_flight_csv(file, std::nullopt));
    const auto loaded = load_flight(file);
    const auto& sorties = loaded.phases.sorties;
    EXPECT_EQ(sorties.size(), 1U);
    if (sorties.size() != 1) return loaded.series;
    const double first_s = power_track(loaded.series).time_s.front();
    EXPECT_NEAR(sorties[0].start_s() - first_s, 30.0, 4.0);
    EXPECT_NEAR(sorties[0].end_s() - first_s, 230.0, 4.0);
    const auto power = power_track(loaded.series);
    const double energy_j = integrated(power.time_s, power.value, first_s + 30.0, first_s + 230.0);
    EXPECT_NEAR(units::wh_from_joule(energy_j), test::table_flight_wh(), 0.01 * test::table_flight_wh());
    EXPECT_TRUE(loaded.power.power_faults.empty());
    return loaded.series;
}

using test::Moment;

TEST(ShippedMaps, ReadBetaflightByBlackboxDecode) {
    const auto row = [](const Moment& at) {
        return fmt::format("{:.0f}, {:.0f}, {:3}, {:.3f}, {:.3f}, {:.0f}, {:.0f}, ARM|HORIZON, IDLE", at.t_s * 500,
                           5e6 + at.t_s * 1e6, 12, at.volt, at.ampere, at.height_m * 100, at.t_s);
    };
    const auto series = recognised(
        "LOG00001.01.csv", test::flight_table("loopIteration, time (us), axisP[0], vbatLatest (V), amperageLatest (A), "
                                              "BaroAlt (cm), energyCumulative (mAh), flightModeFlags (flags), "
                                              "failsafePhase (flags)",
                                              row));
    EXPECT_EQ(series.firmware, "rotorcraft");
    EXPECT_EQ(power_track(series).source, "vbatLatest (V) * amperageLatest (A)");
    EXPECT_DOUBLE_EQ(power_track(series).time_s.front(), 5.0);
}

TEST(ShippedMaps, ReadInavByBlackboxDecodeInOtherUnits) {
    const auto row = [](const Moment& at) {
        return fmt::format("{:.0f}, {:.6f}, {:.0f}, {:.0f}, {:.0f}, {:.2f}, {:.2f}, 0", at.t_s * 500, at.t_s,
                           at.height_m * 100, at.volt * 1000, at.ampere * 1000, at.height_m / 0.3048, 3.6);
    };
    const auto series = recognised("inav.csv", test::flight_table("loopIteration, time (s), navPos[2], vbat (mV), "
                                                                  "amperage (mA), BaroAlt (ft), GPS_speed (km/h), "
                                                                  "stateFlags (flags)",
                                                                  row));
    EXPECT_EQ(series.firmware, "") << "INAV flies wings too";
    EXPECT_DOUBLE_EQ(select_track(series, "ground_speed_m_per_s").value.front(), 1.0);
}

TEST(ShippedMaps, ReadEdgeTxWithSensorsOfFrSky) {
    const auto row = [](const Moment& at) {
        return fmt::format("2026-01-{:02},{},90,5.0,{:.2f},{:.2f},{:.1f},12.0,33.5 -7.25,\"OK\",-1024,0x00", at.day,
                           at.clock, at.volt, at.ampere, at.height_m / 0.3048);
    };
    const auto series = recognised(
        "Model-2026-01-02.csv",
        test::flight_table("Date,Time,RSSI(dB),RxBt(V),VFAS(V),Curr(A),Alt(ft),GSpd(kts),GPS,FM,Thr,LSW", row));
    EXPECT_EQ(series.start_clock_s, 1767398280.0);
    EXPECT_NEAR(select_track(series, "ground_speed_m_per_s").value.front(), 12.0 * 1852.0 / 3600.0, 1e-9);
    EXPECT_DOUBLE_EQ(select_track(series, "longitude_deg").value.front(), -7.25);
}

TEST(ShippedMaps, NoteTheCurrentOfASecondPack) {
    const auto row = [](const Moment& at) {
        return fmt::format("2026-01-{:02},{},{:.2f},{:.2f},{:.1f},{:.0f},{:.0f}", at.day, at.clock, at.volt, at.ampere,
                           at.height_m, 500.0 * at.ampere, at.charge_mah);
    };
    const auto series =
        recognised("two.csv", test::flight_table("Date,Time,VFAS(V),Curr(A),Alt(m),Cur2(mA),Capa(mAh)", row));
    EXPECT_THAT(series.notes, ElementsAre(HasSubstr("not read: Cur2(mA) (a second pack's would be missing)")));
}

TEST(ShippedMaps, ReadEdgeTxWithCrossfire) {
    const auto row = [](const Moment& at) {
        return fmt::format("2026-01-{:02};{};-60;{:.1f};{:.1f};{:.0f};{:.0f};35,9;33.5 7.25", at.day, at.clock, at.volt,
                           at.ampere, at.charge_mah, at.height_m);
    };
    auto text = test::flight_table("Date;Time;1RSS(dB);RxBt(V);Curr(A);Capa(mAh);Alt(m);GSpd(kmh);GPS", row);
    // As a spreadsheet of Germany saves it: decimal commas, but not in the texts of time and position.
    for (std::size_t at = 0; (at = text.find('.', at)) != std::string::npos; ++at)
        if (text[at + 2] == ';') text[at] = ',';
    const auto series = recognised("crsf.csv", text);
    EXPECT_NEAR(select_track(series, "ground_speed_m_per_s").value.front(), 35.9 / 3.6, 1e-9);
    EXPECT_DOUBLE_EQ(select_track(series, "latitude_deg").value.front(), 33.5);
}

TEST(ShippedMaps, ReadAirData) {
    const auto metric = [](const Moment& at) {
        return fmt::format("{:.0f},2026-01-02 10:00:{:02},55.4,10.4,{:.1f},4.5,{:.3f},{:.2f},99,0,", at.t_s * 1000,
                           static_cast<int>(at.t_s) % 60, at.height_m, at.volt, -at.ampere);
    };
    const auto series = recognised("a.csv", test::flight_table("time(millisecond),datetime(utc),latitude,longitude,"
                                                               "height_above_takeoff(meters),speed(m/s),voltage(v),"
                                                               "current(A),battery_percent, zSpeed(m/s),message",
                                                               metric));
    EXPECT_EQ(series.start_clock_s, 1767348000.0);
    EXPECT_EQ(series.aircraft_name, "DJI");
    const auto imperial = [](const Moment& at) {
        return fmt::format("{:.0f},2026-01-02 10:00:00,55.4,10.4,{:.1f},10,{:.3f},{:.2f}", at.t_s * 1000,
                           at.height_m / 0.3048, at.volt, at.ampere);
    };
    const auto other = recognised("b.csv", test::flight_table("time(millisecond),datetime(utc),latitude,longitude,"
                                                              "height_above_takeoff(feet),speed(mph),voltage(v),"
                                                              "current(A)",
                                                              imperial));
    EXPECT_DOUBLE_EQ(select_track(other, "ground_speed_m_per_s").value.front(), 4.4704);
}

TEST(ShippedMaps, ReadFlightRecorderLogsOfDroneDeploy) {
    const auto row = [](const Moment& at) {
        return fmt::format("01/02/2026 10:00:00\t{:.3f}\t\tN/A\t{:.0f}\t{:.0f}\t{:.4f}\t{:.1f}\tVery Strong", at.t_s,
                           at.ampere * -1000, at.volt * 1000, at.height_m / 0.3048, -10.0);
    };
    const auto series = recognised(
        "2026-01-02.log",
        "#DroneDeploy\t2.0\nSession ID\t1234\nAircraft Model\tInspire\nGimbal Firmware\n" +
            test::flight_table("Date/Time (UTC)\tElapsed Time (sec)\tInfo\tBattery Power (%)\t"
                               "Aircraft Battery Current (mA)\tAircraft Battery Voltage (mV)\t"
                               "Aircraft Barometric Altitude (ft)\tAircraft Vel - Z (mph)\tAircraft GPS Signal",
                               row) +
            "#Flight Recorder Session End\nDate/Time (UTC)\t01/02/2026 10:04:20\nElapsed Time (sec)\t260\n");
    EXPECT_EQ(series.flight, "2026-01-02");
    EXPECT_DOUBLE_EQ(select_track(series, "climb_m_per_s").value.front(), 4.4704) << "down is positive in the log";
    EXPECT_EQ(describe(series.skipped.at(0)), "another number of cells than the header: 2 lines, first at line 1308");
}

TEST(ShippedMaps, ReadFlightRecordsOfDji) {
    const auto row = [](const Moment& at) {
        return fmt::format("1/2/2026,10:00:01.5 AM,0m {0:.1f}s,{0:.1f},{1:.1f},8.1,{2:.3f},{3:.2f},False", at.t_s,
                           at.height_m / 0.3048, at.volt, -at.ampere);
    };
    const auto series = recognised(
        "DJIFlightRecord.csv",
        "sep=,\n" + test::flight_table("CUSTOM.date [local],CUSTOM.updateTime [local],OSD.flyTime,OSD.flyTime [s],"
                                       "OSD.height [ft],OSD.hSpeed [MPH],BATTERY.voltage [V],BATTERY.current [A],"
                                       "OSD.isMotorUp",
                                       row));
    EXPECT_EQ(power_track(series).source, "BATTERY.voltage [V] * BATTERY.current [A]");
    EXPECT_NEAR(select_track(series, "ground_speed_m_per_s").value.front(), 8.1 * 0.44704, 1e-9);
}

TEST(ShippedMaps, LeaveOutTracksThatAFileLacks) {
    const auto row = [](const Moment& at) {
        return fmt::format("{:.0f},{:.0f},{:.3f},{:.3f}", at.t_s, at.t_s * 1e6, at.volt, at.ampere);
    };
    const auto file =
        test::write_text(test::scratch_dir() / "a.csv",
                         test::flight_table("loopIteration,time (us),vbatLatest (V),amperageLatest (A)", row));
    const auto series = read_candidates(FlightFile(file), std::nullopt).at(0);
    EXPECT_TRUE(select_track(series, "altitude_m").empty());
    EXPECT_EQ(power_track(series).time_s.size(), test::table_flight().size());
}

TEST(ColumnMap, FlightsOfTheBenchmarkHaveTheirEnergy) {
    FLIGHTWATT_NEEDS_SHARED();
    std::size_t flown = 0;
    for (const auto* name : {"1.csv", "10.csv", "100.csv"}) {
        const auto series = read_candidates(FlightFile(test::shared_dir() / "m100" / name), std::nullopt).at(0);
        EXPECT_GT(power_track(series).time_s.size(), 500U);
        EXPECT_TRUE(series.skipped.empty());
        flown += segment(select_tracks(series)).sorties.size();
    }
    EXPECT_GT(flown, 0U);
}

}  // namespace
}  // namespace flightwatt::flight
