#include "flight/flight_series.h"

#include "helpers/cut_logs.h"
#include "helpers/selected_tracks.h"

#include <limits>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::ElementsAre;

/// Which field differs, for a message.
std::string difference(const FlightSeries& a, const FlightSeries& b) {
    if (a == b) return "";
    if (a.skipped != b.skipped) return "skipped";
    if (a.assumed_definitions != b.assumed_definitions) return "assumed definitions";
    if (a.tracks.size() != b.tracks.size()) {
        return fmt::format("{} tracks, {}", a.tracks.size(), b.tracks.size());
    }
    for (std::size_t i = 0; i < a.tracks.size(); ++i) {
        if (a.tracks[i] != b.tracks[i]) return a.tracks[i].name + " from " + a.tracks[i].source;
    }
    return "another field";
}

std::vector<std::string> ids_of(const std::vector<FlightSeries>& all) {
    std::vector<std::string> ids;
    for (const auto& series : all) ids.push_back(series.aircraft_id);
    return ids;
}

/// At several times: the series that is cut is the series of the log that ends there, whatever stood behind.
void expect_no_hindsight(const std::string& text, const std::optional<telemetry::LogConfiguration>& configuration) {
    const auto whole = test::all_series(text, configuration);
    const auto ids = ids_of(whole);
    double end_s = 0.0;
    for (const auto& line : test::lines_of(text)) {
        const double time_s = test::time_of_line(std::string_view(line).substr(0, line.size() - 1));
        if (!std::isnan(time_s)) end_s = std::max(end_s, time_s);
    }
    std::mt19937 random(7);
    for (const double part : {0.0, 0.02, 0.31, 0.5, 0.77, 1.0}) {
        const double until_s = std::round(part * end_s * 1000.0) / 1000.0;
        SCOPED_TRACE(fmt::format("cut at {} s", until_s));
        auto cut = test::cut_log(text, until_s);
        const auto ended = test::all_series(cut.before, configuration, ids);
        std::shuffle(cut.after.begin(), cut.after.end(), random);
        std::string changed = cut.before;
        for (std::size_t i = 0; i < cut.after.size(); ++i) {
            changed += cut.after[i];
            if (changed.back() != '\n') changed += '\n';
            if (i % 97 == 0) changed += "rubbish\n\xFF\xFE 1 2 ENERGY\n";
        }
        const auto other = test::all_series(changed, configuration, ids);
        for (std::size_t i = 0; i < ids.size(); ++i) {
            EXPECT_EQ(difference(truncate_series(whole[i], until_s), ended[i]), "") << "aircraft " << ids[i];
            EXPECT_EQ(difference(truncate_series(other[i], until_s), ended[i]), "") << "aircraft " << ids[i];
        }
    }
}

void expect_no_hindsight_in_every(std::size_t step) {
    const auto logs = test::all_logs();
    for (std::size_t i = 0; i < logs.size(); i += step) {
        SCOPED_TRACE(logs[i].string());
        expect_no_hindsight(telemetry::read_data_file(logs[i]), test::configuration_of(logs[i]));
    }
}

TEST(CutSeries, IsTheSeriesOfALogThatEndsThere) { expect_no_hindsight_in_every(4); }

TEST(CutSeriesStudy, IsTheSeriesOfALogThatEndsThere) { expect_no_hindsight_in_every(1); }

TEST(CutSeries, CoversTheRealLogs) {
    FLIGHTWATT_NEEDS_SHARED();
    EXPECT_THAT(test::all_logs(), testing::Contains(test::shared_dir() / "flights" / "20_07_03__12_17_45.data"));
}

TEST(CutSeries, ForgetsWhatWasChosenByWhatCameLater) {
    // Motors that report in turn, one of them from later on; an altitude that begins to vary; a speed sensor
    // that wakes; a layout that turns out to be another one; lines that cannot be used; late lines.
    std::string text;
    for (int i = 0; i < 200; ++i) {
        text += fmt::format("{0}.0 20 ESC 1.{1} 12. {2}. 0. 0. 0. 0\n", i, i % 10, 10 + i % 7);
        if (i > 100) text += fmt::format("{}.3 20 ESC 2. 12. 24. 0. 0. 0. 1\n", i);
        text += fmt::format("{}.1 20 ESTIMATOR {}. 0.\n", i, i > 120 ? i : 0);
        text += fmt::format("{}.2 20 GPS 3 36028296 481362654 900 {} 340 -89 2112 0 31 0\n", i, 207000 + i);
        text += fmt::format("{}.4 20 AIRSPEED {}. 0. 0. 0.\n", i, i > 150 ? 12 : 0);
        text += fmt::format("{}.5 20 WIND_INFO 0 0 {}. 1. 0. 0.\n", i, i > 60 ? 3 : 0);
        text +=
            fmt::format("{}.6 20 ENERGY 11. {}. {} {}.\n", i, 2 + i % 5, i < 90 ? 500 + i : 11 * (2 + i % 5), 500 + i);
        if (i % 40 == 3) text += fmt::format("rubbish\n{}.7 20 ENERGY 1 2\nno time\n", i);
        if (i % 50 == 9) text += fmt::format("{}.2 20 ENERGY 11. nan 1 2.\n", i - 3);
    }
    text += "rubbish at the end\n199.9 20 ENE";
    expect_no_hindsight(text, std::nullopt);
    const auto series = test::all_series(text, std::nullopt).at(0);
    EXPECT_EQ(select_track(series, "altitude_m").source, "ESTIMATOR.z");
    EXPECT_EQ(select_track(truncate_series(series, 100.0), "altitude_m").source, "GPS.alt");
    EXPECT_FALSE(warnings_of(series) == warnings_of(truncate_series(series, 50.0)));
}

TEST(CutSeries, ForgetsAClockThatBeginsAnewLater) {
    std::string text;
    for (int i = 0; i < 300; ++i) text += fmt::format("{} 20 ENERGY 0 12. 1. 12. 0. 0.\n", i);
    text += "500 20 ENERGY 0 12. 1. 12. 0. 0.\n400 20 ENERGY 0 12. 1. 12. 0. 0.\n";
    const auto series = test::all_series(text, std::nullopt).at(0);
    ASSERT_TRUE(series.clock_restart);
    EXPECT_EQ(series.clock_restart->visible_from_s, 500.0);
    EXPECT_FALSE(truncate_series(series, 499.0).clock_restart);
    expect_no_hindsight(text.substr(0, text.find("500 20")), std::nullopt);
}

TEST(FlightSeries, HoldsAReplacedTrackOnceWhereItStood) {
    FlightSeries series;
    series.tracks = {{.name = "altitude_m"},
                     {.name = "power_w", .source = "a"},
                     {.name = "block"},
                     {.name = "power_w", .source = "b"}};
    replace_track(series, {.name = "power_w", .source = "c"});
    ASSERT_EQ(series.tracks.size(), 3U);
    EXPECT_EQ(series.tracks[1].source, "c");
    EXPECT_EQ(series.tracks[2].name, "block");
}

TEST(Track, IsSortedFiniteAndWithoutDuplicates) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> time_s{3, 1, 2, 2, 2};
    const std::vector<double> values{30, 10, 21, nan, 23};
    const auto mean = make_track(time_s, values, Merge::mean);
    EXPECT_THAT(mean.time_s, ElementsAre(1, 2, 3));
    EXPECT_THAT(mean.value, ElementsAre(10, 22, 30));
    EXPECT_THAT(make_track(time_s, values, Merge::latest).value, ElementsAre(10, 23, 30));
}

TEST(Track, IsLinearBetweenItsPointsAndConstantBeyond) {
    const Track track{.time_s = {1, 2, 4}, .value = {10, 20, 0}};
    EXPECT_EQ(value_at(track, 0), 10);
    EXPECT_EQ(value_at(track, 1.5), 15);
    EXPECT_EQ(value_at(track, 2), 20);
    EXPECT_EQ(value_at(track, 3), 10);
    EXPECT_EQ(value_at(track, 9), 0);
    EXPECT_EQ(state_at(track, 3.9), 20);
    EXPECT_EQ(state_at(track, 0), 10);
    const std::vector<double> times{0, 1.5, 2, 3, 9};
    EXPECT_THAT(resample(track, times), ElementsAre(10, 15, 20, 10, 0));
}

TEST(Track, HasRowsBetweenTimes) {
    const std::vector<double> times{1, 2, 4};
    EXPECT_EQ(first_at_or_after(times, 2), 1U);
    EXPECT_EQ(first_after(times, 2), 2U);
    EXPECT_EQ(first_at_or_after(times, 5), 3U);
    EXPECT_EQ(first_after(times, 0), 0U);
}

}  // namespace
}  // namespace flightwatt::flight
