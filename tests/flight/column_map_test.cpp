#include "flight/column_map.h"

#include "flight/load_flight.h"
#include "helpers/rejected.h"
#include "helpers/selected_tracks.h"
#include "helpers/test_paths.h"

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
    const auto series = parse_mapped_csv("t,u,i,down\n2000,10,5,-300\n1000,10,4,0\n3000,,x,1\n,1,1,1\n", "f.csv", map);
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
            select_tracks(parse_mapped_csv("t,u,i,down,load\n2000,10,5,-300,\n3000,10,4,0,250\n", "f.csv", map))
                .payload_kg);
    };
    EXPECT_EQ(payload_of("value = 0.5\n"), 0.5);
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
    EXPECT_THAT(refusal("time = { column = \"t\", unit = \"h\" }\n"), HasSubstr("'h' is no unit of time"));
    EXPECT_EQ(test::rejected([] { parse_mapped_csv("t,u\n1,2\n", "f.csv", parse_column_map(small_map, "m")); }),
              "f.csv:1: has no column 'i'; its columns are t, u");
}

TEST(ColumnMap, OfAnUnknownHeaderIsAskedFor) {
    const auto folder = test::scratch_dir();
    const auto file = test::write_text(folder / "f.csv", "t,u,i,down\n1,2,3,4\n2,3,4,5\n");
    EXPECT_EQ(test::rejected([&] { FlightFile{file}; }, folder),
              "f.csv:1: has no column 'time_s'; its columns are t, u, i, down; a column map names their tracks: "
              "--columns MAP.toml");
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
    for (const auto* name : {"m100.toml", "example.toml"})
        EXPECT_FALSE(read_column_map(test::source_dir() / "config" / "columns" / name).tracks.empty());
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
