#include "flight/families/mapped_csv.h"

#include "flight/load_flight.h"
#include "helpers/rejected.h"
#include "helpers/selected_tracks.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string altitude = "[[track]]\nname = \"altitude_m\"\ncolumn = \"h\"\n";
const std::string electric =
    "[[track]]\nname = \"voltage_v\"\ncolumn = \"u\"\n[[track]]\nname = \"current_a\"\ncolumn = \"i\"\n";

FlightSeries read(const std::string& csv, const std::string& tracks, const std::string& time = "column = \"t\"") {
    return parse_mapped_csv(csv, "f.csv", parse_column_map("time = { " + time + " }\n" + tracks, "map.toml")).at(0);
}

std::string refusal(const std::string& csv, const std::string& tracks) {
    return test::rejected([&] { read(csv, tracks); });
}

TEST(MappedCsv, ReadsBlanksSemicolonsAndDecimalCommas) {
    for (const auto* csv : {"t, h\n0, 1.5\n1, 2.5\n", "t;h\n0,0;1,5\n1,0;2,5\n", "sep=;\nt;h\n0;1,5\n1;2,5\n",
                            "t\th\r0\t1.5\r1\t2.5\r", "Model,X\nt,h\n0,1.5\n1,2.5\n"}) {
        const auto series = read(csv, altitude);
        EXPECT_THAT(series.tracks.at(0).time_s, ElementsAre(0.0, 1.0)) << csv;
        EXPECT_THAT(series.tracks.at(0).value, ElementsAre(1.5, 2.5)) << csv;
    }
    const auto series = read("t (us), h\n0, 1.5\n1000000, 2.5\n", altitude, "column = \" t (us)\", unit = \"us\"");
    EXPECT_THAT(series.tracks.at(0).time_s, ElementsAre(0.0, 1.0)) << "a blank in the map does not count either";
}

TEST(MappedCsv, SkipsLinesBeforeTheHeader) {
    const auto map = parse_column_map("skip_lines = 2\ntime = { column = \"t\" }\n" + altitude, "map.toml");
    const auto series = parse_mapped_csv("t,h\nx,y\nt,h\n0,1\n1,2\n", "f.csv", map).at(0);
    EXPECT_TRUE(series.skipped.empty());
    EXPECT_THAT(series.tracks.at(0).value, ElementsAre(1.0, 2.0));
}

TEST(MappedCsv, RefusesNumbersWithWhichAFlightLastsForDays) {
    const auto of = [](int rows, double interval) {
        std::string csv = "t,h\n";
        for (int i = 0; i < rows; ++i) csv += fmt::format("{},{}\n", 1.7e12 + interval * i, i);
        return csv;
    };
    EXPECT_EQ(refusal(of(100, 100.0), altitude),
              "f.csv: the times of 't' are 100 s apart, for 0.116 days: they are in a smaller unit; state it in the "
              "column map, in [time]: unit = \"ms\", \"us\" or \"ns\"");
    EXPECT_THAT(refusal(of(40'000, 10.0), altitude), HasSubstr("for 4.63 days"));
    EXPECT_EQ(refusal(of(100, 10.0), altitude), "");
    EXPECT_EQ(read(of(100, 100.0), altitude, "column = \"t\", unit = \"ms\"").tracks.at(0).time_s.size(), 100U);
}

TEST(MappedCsv, TakesTheUnitThatTheNameStates) {
    const auto value = [](const std::string& header, const std::string& more) {
        return read(header + "\n0,100\n1,100\n", altitude + more).tracks.at(0).value.at(0);
    };
    EXPECT_DOUBLE_EQ(value("t,h(ft)", ""), 30.48);
    EXPECT_DOUBLE_EQ(value("t,h [cm]", ""), 1.0);
    EXPECT_DOUBLE_EQ(value("t,h (ft)", "unit = \"cm\"\n"), 30.48) << "the file states it";
    EXPECT_DOUBLE_EQ(value("t,h", "unit = \"cm\"\n"), 1.0);
    const auto exact = altitude.substr(0, altitude.rfind('h')) + "h(ft)\"\n";
    EXPECT_DOUBLE_EQ(read("t,h(ft)\n0,100\n1,100\n", exact + "factor = 1\n").tracks.at(0).value.at(0), 100.0)
        << "the map states all";
    EXPECT_THAT(read("t(min),h\n0,1\n1.5,2\n", altitude).tracks.at(0).time_s, ElementsAre(0.0, 90.0));
    EXPECT_EQ(refusal("t,h(V)\n0,1\n1,1\n", altitude), "f.csv:1: has no column 'h'; its columns are t, h(V)");
    EXPECT_EQ(refusal("t,h(m),h(ft)\n0,1,1\n1,1,1\n", altitude),
              "f.csv:1: has several columns 'h'; name one with its unit: 'h(m)'");
    EXPECT_EQ(refusal("t,h,h\n0,1,1\n1,1,1\n", altitude), "f.csv:1: has several columns 'h'; keep one of them");
}

TEST(MappedCsv, RefusesAColumnThatIsNamedInAnotherUnitThanItIsReadIn) {
    const auto track = [](const std::string& name, const std::string& columns) {
        return "[[track]]\nname = \"" + name + "\"\n" + columns + "\n";
    };
    const std::string milliwatts = "t,p_mw\n0,15000\n1,15000\n";
    EXPECT_EQ(refusal(milliwatts, track("power_w", "column = \"p_mw\"")),
              "f.csv:1: the column 'p_mw' is in mW by its name, but its [[track]] power_w states no unit; add unit = "
              "\"mW\", or factor = 1 if its values are in the unit of power_w");
    const auto watts = read(milliwatts, track("power_w", "column = \"p_mw\"\nunit = \"mW\""));
    EXPECT_DOUBLE_EQ(watts.tracks.at(0).value.at(0), 15.0);
    EXPECT_THAT(refusal("t,h(ft)\n0,100\n1,100\n", track("altitude_m", "column = \"h(ft)\"")), HasSubstr("is in ft"));
    EXPECT_THAT(refusal("t,u,i_ma\n0,12,900\n1,12,900\n", track("power_w", "product = [\"u\", \"i_ma\"]")),
                HasSubstr("is in mA by its name, but its [[track]] power_w states no unit; add the factor"));
    for (const auto* own : {"h_m", "alt_10m", "h_", "h(m)", "a_b", "h(1)"})
        EXPECT_DOUBLE_EQ(
            read(fmt::format("t,{}\n0,100\n1,100\n", own), track("altitude_m", fmt::format("column = \"{}\"", own)))
                .tracks.at(0)
                .value.at(0),
            100.0)
            << own;
}

TEST(MappedCsv, SaysWhyThereIsNoPowerWhereVoltageAndCurrentAreInDifferentRows) {
    const auto series = read("t,u,i\n0,15,\n1,,20\n2,15,\n3,,20\n", electric);
    EXPECT_EQ(no_power_reason(select_tracks(series)),
              "no row has both factors of u * i: write them into the same rows");
    EXPECT_EQ(no_power_reason(select_tracks(read("t,u,i\n0,15,20\n1,15,20\n", electric))), "");
}

TEST(MappedCsv, TakesTheFirstOfSeveralColumns) {
    const std::string tracks = "[[track]]\nname = \"altitude_m\"\ncolumns = [\"a\", \"b\"]\n";
    EXPECT_EQ(read("t,b,a\n0,1,2\n1,1,2\n", tracks).tracks.at(0).source, "a");
    EXPECT_EQ(read("t,b,c\n0,1,2\n1,1,2\n", tracks).tracks.at(0).source, "b");
    EXPECT_THAT(refusal("t,c\n0,1\n1,1\n", tracks), HasSubstr("has no column 'a'"));
}

TEST(MappedCsv, MultipliesVoltageAndCurrent) {
    const auto power = power_track(read("t,u(mV),i\n0,12000,2\n1,11000,3\n", electric));
    EXPECT_THAT(power.value, ElementsAre(DoubleEq(24.0), DoubleEq(33.0)));
    EXPECT_EQ(power.source, "u(mV) * i");
    const auto stated = electric + "[[track]]\nname = \"power_w\"\ncolumn = \"p\"\n";
    EXPECT_THAT(power_track(read("t,u,i,p\n0,12,2,24.5\n1,11,3,33.5\n", stated)).value, ElementsAre(24.5, 33.5));
}

TEST(MappedCsv, SplitsACellWithLatitudeAndLongitude) {
    const std::string tracks = altitude + "[[track]]\nname = \"latitude_deg\"\ncolumn = \"GPS\"\n" +
                               "[[track]]\nname = \"longitude_deg\"\ncolumn = \"GPS\"\n";
    const auto series = read("t,h,GPS\n0,1,33.5 -37.25\n1,1,\"33.6, -37.5\"\n2,1,\n3,1,none\n", tracks);
    EXPECT_THAT(series.tracks.at(1).value, ElementsAre(33.5, 33.6));
    EXPECT_THAT(series.tracks.at(2).value, ElementsAre(-37.25, -37.5));
    EXPECT_EQ(describe(series.skipped.at(0)), "cells that are no numbers: 2 lines, first at line 5");
}

TEST(MappedCsv, ReadsClocks) {
    const auto by_date =
        read("d,t,h\n2026-01-02,23:59:59.500,1\n2026-01-03,00:00:00.500,2\n", altitude, "column = \"t\", date = \"d\"");
    EXPECT_THAT(by_date.tracks.at(0).time_s, ElementsAre(0.0, 1.0));
    EXPECT_EQ(by_date.start_clock_s, 1767398399.5);
    const auto without = read("d,t,h\n,23:59:59.500,1\n,00:00:00.500,2\n", altitude);
    EXPECT_THAT(without.tracks.at(0).time_s, ElementsAre(0.0, 1.0));
    EXPECT_EQ(without.start_clock_s, std::nullopt);
    EXPECT_EQ(refusal("t,h\n10:17 AM,1\n10:18 AM,2\n", altitude),
              "f.csv: has fewer than two rows with a time; '10:17 AM' is no time: expected numbers, HH:MM:SS.mmm or "
              "YYYY-MM-DD HH:MM:SS.mmm, all in one way");
}

TEST(MappedCsv, CountsRaggedRowsAndRefusesWhereTheyAreMost) {
    const auto series = read("t,h\n0,1\n1\n1,2\n# end\nend\n", altitude);
    EXPECT_EQ(series.tracks.at(0).time_s.size(), 2U);
    EXPECT_EQ(describe(series.skipped.at(0)), "another number of cells than the header: 2 lines, first at line 3");
    EXPECT_THAT(refusal("t,h\n0,5,1,5\n1,5,2,5\n", altitude), HasSubstr("f.csv:2: 4 cells, expected 2"));
}

TEST(MappedCsv, FindsAClockThatRunsBack) {
    std::string csv = "t,h\n";
    for (int i = 0; i < 200; ++i) csv += fmt::format("{},{}\n", i == 100 ? 98.5 : i, i);
    EXPECT_EQ(read(csv, altitude).clock_restart, std::nullopt) << "a row that is late";
    for (int i = 0; i < 200; ++i) csv += fmt::format("{},{}\n", i, 2 * i);
    const auto recordings =
        parse_mapped_csv(csv, "f.csv", parse_column_map("time = { column = \"t\" }\n" + altitude, "map.toml"));
    ASSERT_EQ(recordings.size(), 2U);
    EXPECT_EQ(recordings[0].tracks.at(0).time_s.back(), 199.0);
    EXPECT_EQ(recordings[1].tracks.at(0).time_s.front(), 0.0);
    EXPECT_EQ(recordings[1].tracks.at(0).value.back(), 398.0);
}

TEST(MappedCsv, KeepsTheRowsOfAClockThatIsSetBack) {
    std::string csv = "t,h\n";
    for (int i = 0; i < 200; ++i) csv += fmt::format("{},{}\n", i < 100 ? i : i - 5, i);
    const auto series = read(csv, altitude);
    EXPECT_EQ(series.tracks.at(0).time_s.size(), 200U);
    EXPECT_EQ(series.tracks.at(0).time_s.back(), 199.0);
    EXPECT_THAT(warnings_of(series), testing::Contains(HasSubstr("the clock is set back by 5.0 s, first at 100.0 s")));
}

TEST(MappedCsv, RefusesPowerThatIsNegativeThroughout) {
    EXPECT_EQ(
        refusal("t,u,i\n0,12,-2\n1,11,-3\n", electric),
        "f.csv: the power is negative throughout: a discharge has a negative current; turn its sign with factor = "
        "-1 in the [[track]] of power_w or current_a");
    EXPECT_THAT(power_track(read("t,u,i\n0,12,-2\n1,11,-3\n", electric + "factor = -1\n")).value,
                ElementsAre(24.0, 33.0));
    EXPECT_EQ(refusal("t,u,i\n0,12,-2\n1,11,3\n", electric), "") << "a charge now and then";
    const auto magnitude = electric.substr(0, electric.rfind("column")) + "norm = [\"i\"]\n";
    EXPECT_THAT(power_track(read("t,u,i\n0,12,-2\n1,11,3\n", magnitude)).value, ElementsAre(24.0, 33.0));
}

}  // namespace
}  // namespace flightwatt::flight
