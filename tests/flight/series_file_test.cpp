#include "flight/series_file.h"

#include "base/error.h"
#include "flight/flight_data.h"
#include "flight/power_check.h"
#include "flight/power_report.h"
#include "flight/telemetry_series.h"
#include "helpers/cut_logs.h"
#include "helpers/rejected.h"
#include "helpers/selected_tracks.h"
#include "telemetry/log_reader.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(SeriesFile, LosesNothingOfAnyLog) {
    std::size_t read = 0;
    for (const auto& log : test::all_logs()) {
        SCOPED_TRACE(log.string());
        const auto data = telemetry::read_data_file(log);
        for (const auto& series : test::all_series(data, test::configuration_of(log))) {
            if (power_track(series).empty() && select_track(series, "altitude_m").time_s.size() < 2) continue;
            const auto text = to_csv(series);
            const auto again = parse_series_csv(text, series.file);
            EXPECT_TRUE(again == series) << "aircraft " << series.aircraft_id;
            EXPECT_EQ(to_csv(again), text);
            ++read;
        }
    }
    EXPECT_GE(read, 6u);
}

FlightSeries series_of(const std::string& text) {
    return flight_series(parse_telemetry(text, "x.data", std::nullopt, flight_messages()), "20");
}

TEST(SeriesFile, KeepsEveryTrackOnItsOwnClock) {
    auto series = series_of(
        "1 20 ENERGY 40 12. 1. 12. 0.1 1.\n1.5 20 ESTIMATOR 100. 0.\n1.5 20 GPS 3 1 1 0 20000 0 0 1 1 31 0\n"
        "rubbish\n2 20 ENERGY 50 11. 2. 22. 0.2 2.\n2.5 20 TAKEOFF 1\nrubbish\n");
    series.block_names = {{0, "Wait \"GPS\""}, {3, "Take\tOff"}};
    series.planned_ground_altitude_m = 0.1;
    series.start_clock_s = 1593771465.17;
    series.notes = {"a note"};
    const auto text = to_csv(series);
    EXPECT_THAT(text, StartsWith("# format = 1\n# flight = \"x\"\n"));
    EXPECT_THAT(text, HasSubstr("\ntime_s,altitude_m,altitude_m.2,throttle_percent,"));
    EXPECT_THAT(text, HasSubstr("\n1.5,100,20,,"));
    EXPECT_TRUE(parse_series_csv(text, "x.data") == series);
    EXPECT_EQ(parse_series_csv(text, "renamed.csv").flight, "x");
}

/// Tracks on clocks of their own that meet now and then, with values that come again, of few digits and of many.
FlightSeries long_series() {
    FlightSeries series;
    series.flight = "x";
    std::mt19937 random(3);
    for (std::size_t t = 0; t < 40; ++t) {
        Track track{.name = track_names().at(t % track_names().size()), .source = "series CSV"};
        if (t % 3 == 1) track.time_s = series.tracks.back().time_s;
        const bool has_clock = !track.time_s.empty();
        const auto samples = has_clock ? track.time_s.size() : 200 + 1500 * (t % 7);
        double time_s = 100.0 * static_cast<double>(t % 5);
        for (std::size_t i = 0; i < samples; ++i) {
            time_s += 0.1 * static_cast<double>(1 + random() % 9);
            if (!has_clock) track.time_s.push_back(std::round(time_s * 10.0) / 10.0);
            const auto value = static_cast<double>(random() % 3 == 0 ? 7 : random() % 1'000'000);
            track.value.push_back(t % 2 == 0 ? value / 1000.0 : -value / 77.0);
        }
        series.tracks.push_back(std::move(track));
    }
    return series;
}

/// One row after the other, one cell after the other.
std::string rows_of(const std::vector<Track>& tracks) {
    std::set<double> times_s;
    for (const auto& track : tracks) times_s.insert(track.time_s.begin(), track.time_s.end());
    std::string text;
    for (const double time_s : times_s) {
        text += fmt::format("{}", time_s);
        for (const auto& track : tracks) {
            const auto at = std::ranges::lower_bound(track.time_s, time_s) - track.time_s.begin();
            const auto i = static_cast<std::size_t>(at);
            const bool has_value = i < track.time_s.size() && track.time_s[i] == time_s;
            text += has_value ? fmt::format(",{}", track.value[i]) : ",";
        }
        text += '\n';
    }
    return text;
}

TEST(SeriesFile, HasARowForEachTime) {
    const auto series = long_series();
    EXPECT_TRUE(to_csv(series).ends_with("\n" + rows_of(series.tracks)));
}

TEST(SeriesFile, KeepsDevicesApart) {
    const auto series = series_of(
        "1 20 ESC 1. 12. 12. 0. 0. 0. 0\n1.2 20 ESC 2. 12. 24. 0. 0. 0. 1\n"
        "2 20 ESC 1. 12. 12. 0. 0. 0. 0\n2.2 20 ESC 4. 12. 48. 0. 0. 0. 1\n");
    const auto again = parse_series_csv(to_csv(series), "x.data");
    EXPECT_TRUE(again == series);
    EXPECT_EQ(power_track(again).source, "ESC, summed over 2 devices");
}

TEST(SeriesFile, HasThePowerThatIsChosenInItsFirstColumn) {
    FlightSeries series;
    series.flight = "x";
    for (const auto* device : {"0", "1"}) {
        const double amperes = device[0] == '0' ? 2.0 : 7.0;
        const auto add = [&](const std::string& name, const std::string& source, double value) {
            series.tracks.push_back({.name = name, .source = source, .device = device});
            series.tracks.back().time_s = {1.0, 2.0};
            series.tracks.back().value = {value, 2.0 * value};
        };
        add("voltage_v", "BAT.Volt", 10.0);
        add("current_a", "BAT.Curr", amperes);
        add("power_w", "BAT.Volt * BAT.Curr", 10.0 * amperes);
    }
    const auto text = to_csv(series);
    EXPECT_THAT(text, HasSubstr("# chosen = true\n"));
    EXPECT_THAT(text, HasSubstr("\ntime_s,power_w,voltage_v,current_a,power_w.2,"));
    EXPECT_THAT(text, HasSubstr("\n1,90,10,2,20,"));
    EXPECT_TRUE(parse_series_csv(text, series.file) == series) << "the candidates alone are the series";
    auto changed = text;
    changed.replace(changed.find("\n1,90,"), 6, "\n1,91,");
    EXPECT_THAT(test::rejected([&] { parse_series_csv(changed, "x.csv"); }), HasSubstr("was it changed?"));
}

TEST(SeriesFile, IsReadWithoutFrontMatterAndWithEmptyCells) {
    const auto series = parse_series_csv("# mine\ntime_s,power_w,altitude_m\n1,2,\n2,3,10\n3,,11\n", "out/mine.csv");
    EXPECT_EQ(series.flight, "mine");
    EXPECT_THAT(power_track(series).time_s, ElementsAre(1, 2));
    EXPECT_THAT(select_track(series, "altitude_m").time_s, ElementsAre(2, 3));
    EXPECT_EQ(power_track(series).source, "series CSV");
    EXPECT_TRUE(warnings_of(series).empty());
}

/// Its power was unknown, though the message about other tables names these columns.
TEST(SeriesFile, OfAnotherProgramWithoutPowerHasThatOfVoltageAndCurrent) {
    const auto table = "time_s,voltage_v,current_a,altitude_m\n1,12,2,0\n2,,3,5\n3,11,4,10\n";
    const auto series = parse_series_csv(table, "mine.csv");
    EXPECT_THAT(power_track(series).time_s, ElementsAre(1, 3));
    EXPECT_THAT(power_track(series).value, ElementsAre(24, 44));
    EXPECT_TRUE(power_track(parse_series_csv("# format = 1\n# flight = \"a\"\n# aircraft_id = \"\"\n"
                                             "# aircraft_name = \"\"\n" +
                                                 std::string(table),
                                             "a.csv"))
                    .empty())
        << "a log whose power was not to be computed";
}

TEST(SeriesFile, WithoutPowerHasVoltageTimesCurrent) {
    const auto series =
        parse_series_csv("time_s,voltage_v,current_a,altitude_m\n1,12,2,0\n2,,3,1\n3,10,,2\n4,10,5,3\n", "mine.csv");
    EXPECT_THAT(power_track(series).time_s, ElementsAre(1, 4)) << "not where one of them is missing";
    EXPECT_THAT(power_track(series).value, ElementsAre(24, 50));
    EXPECT_EQ(power_track(series).source, "voltage_v * current_a");
    EXPECT_TRUE(parse_series_csv(to_csv(series), series.file) == series);
    EXPECT_TRUE(power_track(parse_series_csv("time_s,voltage_v,altitude_m\n1,12,0\n2,12,1\n", "x.csv")).empty());
    const auto stated = parse_series_csv("time_s,power_w,voltage_v,current_a\n1,7,12,2\n2,8,12,2\n", "x.csv");
    EXPECT_THAT(power_track(stated).value, ElementsAre(7, 8));
}

TEST(SeriesFile, RefusesAPowerOfNegativeCurrents) {
    const auto refusal = test::rejected(
        [] { parse_series_csv("time_s,voltage_v,current_a,altitude_m\n1,12,-2,0\n2,12,-3,1\n", "x.csv"); });
    EXPECT_THAT(refusal, HasSubstr("the power is negative throughout"));
    EXPECT_THAT(refusal, HasSubstr("turn the sign of current_a"));
}

TEST(SeriesFile, RefusesNumbersWithWhichAFlightLastsForDays) {
    const auto refused = [](int rows, double interval_s) {
        std::string text = "time_s,power_w,air_temperature_c\n";
        for (int i = 0; i < rows; ++i)
            text += fmt::format("{},{},{}\n", interval_s * i, 100 + i % 3, i % 50 == 0 ? "20" : "");
        return test::rejected([&] { parse_series_csv(text, "s.csv"); });
    };
    EXPECT_EQ(
        refused(100, 200.0),
        "s.csv: the times of 'time_s' are 200 s apart, for 0.231 days: they are in a smaller unit; write seconds, "
        "or name the column otherwise and state its unit in a column map");
    EXPECT_THAT(refused(40'000, 10.0), HasSubstr("for 4.63 days"));
    EXPECT_EQ(refused(2000, 1.0), "") << "another track is rarer";
    EXPECT_EQ(refused(29, 200.0), "");
}

TEST(SeriesFile, RefusesANewerFormatAndWhatItDoesNotKnow) {
    const auto refusal = [](const std::string& text) {
        return test::rejected([&] { parse_series_csv(text, "s.csv"); });
    };
    const std::string table = "time_s,power_w\n1,2\n2,3\n";
    EXPECT_THAT(refusal("# format = 2\n" + table), HasSubstr("format = 2 is newer than this program"));
    const std::string front = "# format = 1\n# flight = \"x\"\n# aircraft_id = \"\"\n# aircraft_name = \"\"\n";
    EXPECT_THAT(refusal(front + "# current_origin = \"guessed\"\n" + table), HasSubstr("s.csv:5:"));
    EXPECT_THAT(refusal(front + "# current_origin = \"unknown\"\n# colour = 1\n" + table), HasSubstr("colour"));
    EXPECT_EQ(refusal(front + "# current_origin = \"unknown\"\n" + table), "");
    EXPECT_EQ(refusal(front + table), "") << "current_origin is optional";
}

TEST(SeriesFile, OfACorrectedSeriesIsNotCorrectedAgain) {
    const auto log = test::source_dir() / "logs" / "opterra_synthetic_01.data";
    const auto data = telemetry::read_data_file(log);
    auto series = test::all_series(data, test::configuration_of(log)).at(0);
    correct_idle_offset(series, select_tracks(series), IdleCurrent{0.1, 0.01, 100});
    const auto again = parse_series_csv(to_csv(series), series.file);
    EXPECT_TRUE(again == series);
    EXPECT_EQ(warnings_of(again), warnings_of(series));
}

}  // namespace
}  // namespace flightwatt::flight
