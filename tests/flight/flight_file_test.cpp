#include "flight/flight_file.h"

#include "base/atomic_file.h"
#include "flight/load_flight.h"
#include "flight/series_file.h"
#include "flight/telemetry_series.h"
#include "helpers/autopilot_logs.h"
#include "helpers/binary_frames.h"
#include "helpers/cut_logs.h"
#include "helpers/flown_points.h"
#include "helpers/rejected.h"
#include "helpers/sample_logs.h"
#include "helpers/selected_tracks.h"
#include "telemetry/log_reader.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pointwise;

class Recordings : public testing::Test {
  protected:
    std::filesystem::path put(const std::string& name, const std::string& bytes) const {
        write_file_atomically(folder_ / name, bytes);
        return folder_ / name;
    }
    /// A log with the definitions of the first sample.
    std::filesystem::path put_with_log(const std::string& name, const std::string& bytes) const {
        auto path = put(name, bytes);
        std::filesystem::copy_file(test::sample(1, ".log"), std::filesystem::path(path).replace_extension(".log"));
        return path;
    }

  private:
    std::filesystem::path folder_ = test::scratch_dir();
};

using LoadFlights = Recordings;

/// Two samples in one file, the second of which was recorded after a restart.
std::string two_samples() { return read_file(test::sample(1)) + read_file(test::sample(2)); }

/// Without what a file of its own does not have.
FlightSeries comparable(FlightSeries series) {
    series.file = series.flight = "";
    std::erase_if(series.notes, [](const auto& note) { return note.starts_with("recording "); });
    for (auto& skipped : series.skipped)
        for (auto& at : skipped.lines) at.first_line = 0;
    return series;
}

TEST_F(Recordings, OfADataFileAreThoseOfItsParts) {
    const auto path = put_with_log("two.data", two_samples());
    const auto recordings = read_recordings(FlightFile(path), std::nullopt);
    ASSERT_EQ(recordings.size(), 2U);
    EXPECT_EQ(recordings[0].at(0).flight, "two");
    EXPECT_EQ(recordings[1].at(0).flight, "two@2");
    EXPECT_TRUE(comparable(recordings[0].at(0)) == comparable(read_flight(test::sample(1))));
    EXPECT_TRUE(comparable(recordings[1].at(0)).tracks == read_flight(test::sample(2)).tracks);
    EXPECT_THAT(recordings[1].at(0).notes, ElementsAre(HasSubstr("recording 2 of 2 recordings in its file, from ")));
    EXPECT_TRUE(recordings[0].at(0).notes.empty()) << "nothing of later";
}

TEST_F(Recordings, KnowNothingOfWhatComesLater) {
    const auto configuration = test::configuration_of(test::sample(1));
    const auto lines = test::lines_of(two_samples());
    const auto recordings_until = [&](std::size_t line) {
        std::string text;
        for (std::size_t i = 0; i < line; ++i) text += lines[i];
        std::vector<FlightSeries> all;
        for (const auto& log : recordings_of(parse_telemetry(text, "x.data", configuration, flight_messages())))
            all.push_back(flight_series(log, telemetry_senders(log).at(0)));
        return all;
    };
    const auto whole = recordings_until(lines.size());
    ASSERT_EQ(whole.size(), 2U);
    const auto first_lines = test::lines_of(read_file(test::sample(1))).size();
    const auto last_time_s = [&](std::size_t line) {
        return test::time_of_line(std::string_view(lines[line - 1]).substr(0, lines[line - 1].size() - 1));
    };
    for (const std::size_t line : {first_lines / 3, first_lines, first_lines + 2000, first_lines + 8000}) {
        SCOPED_TRACE(line);
        const auto until_s = last_time_s(line);
        // Behind the last line of that time.
        auto end = line;
        while (end < lines.size() && last_time_s(end + 1) == until_s) ++end;
        const auto ended = recordings_until(end);
        const bool in_second = line > first_lines;
        ASSERT_EQ(ended.size(), in_second ? 2U : 1U);
        EXPECT_TRUE(ended.back().tracks == truncate_series(whole[in_second ? 1 : 0], until_s).tracks);
        EXPECT_TRUE(!in_second || ended.front() == whole.front());
    }
}

LoadOptions any_log() {
    LoadOptions options;
    options.flight_required = options.power_required = false;
    return options;
}

/// The number of samples of the first power of each recording, before any selection.
std::vector<std::size_t> power_samples(const std::vector<Candidates>& recordings) {
    std::vector<std::size_t> samples;
    for (const auto& candidates : recordings)
        samples.push_back(std::ranges::find(candidates.at(0).tracks, "power_w", &Track::name)->time_s.size());
    return samples;
}

TEST_F(Recordings, OfOtherAutopilotsAreRead) {
    const auto read = [&](const char* name, const std::string& bytes) {
        return read_recordings(FlightFile(put(name, bytes)), std::nullopt);
    };
    const auto ardupilot = read("x.bin", test::dataflash_log(1000) + test::dataflash_log(300));
    EXPECT_THAT(power_samples(ardupilot), ElementsAre(1000, 300));
    const auto px4 = read("x.ulg", test::ulog_log(600) + test::ulog_log(150));
    EXPECT_THAT(power_samples(px4), ElementsAre(600, 150));
    for (const auto& candidates : px4) EXPECT_TRUE(candidates.at(0).skipped.empty()) << "its header is no damage";
}

TEST_F(Recordings, OfACardAreRead) {
    const auto messages = telemetry::read_message_dictionary(test::sample(1, ".log"));
    const auto card = [&](int number) {
        return test::card_log(read_file(test::sample(number)), messages, test::LinkVersion::v1);
    };
    const auto recordings = read_recordings(FlightFile(put_with_log("x.LOG", card(1) + card(2))), std::nullopt);
    ASSERT_EQ(recordings.size(), 2U);
    EXPECT_THAT(power_track(recordings[1].at(0)).value,
                Pointwise(DoubleNear(1e-4), power_track(read_flight(test::sample(2))).value));
}

/// The rows of a flight as a series, without front matter.
std::string rows_of(double begin_s, double shift_s) {
    const auto columns = test::columns_of(test::sortie(begin_s));
    std::string rows;
    for (std::size_t i = 0; i < columns.time_s.size(); ++i)
        rows += fmt::format("{},{},{}\n", columns.time_s[i] - shift_s, columns.power_w[i] + 1.0, columns.altitude_m[i]);
    return rows;
}

/// An answer of a log of 200 MB ended at its own series.
TEST_F(Recordings, OfATableMayBeLongerThanOtherFiles) {
    const auto path = put("long.csv", "time_s,power_w\n");
    std::filesystem::resize_file(path, max_file_bytes + 1);
    EXPECT_THAT(test::rejected([&] { read_series_csv(path); }), HasSubstr("long.csv:2"));
    EXPECT_THAT(test::rejected([&] { load_flight(path); }), HasSubstr("long.csv:2"));
}

TEST_F(Recordings, OfASeriesAreReadWithAndWithoutTheirHeaders) {
    const std::string header = "time_s,power_w,altitude_m\n";
    const auto alone = read_series_csv(put("alone.csv", header + rows_of(60, 10)));
    for (const auto* between : {"", header.c_str()}) {
        const auto path = put("x.csv", header + rows_of(50, 0) + between + rows_of(60, 10));
        const auto recordings = read_recordings(FlightFile(path), std::nullopt);
        ASSERT_EQ(recordings.size(), 2U);
        EXPECT_TRUE(recordings[1].at(0).tracks == alone.tracks);
        EXPECT_EQ(load_flights(path).flights.size(), 2U);
        EXPECT_THAT(test::rejected([&] { read_series_csv(path); }), HasSubstr("has 2 recordings, expected one"));
    }
    const auto first = read_flight(test::sample(1));
    const auto second = read_flight(test::sample(2));
    const auto files = read_recordings(FlightFile(put("files.csv", to_csv(first) + to_csv(second))), std::nullopt);
    ASSERT_EQ(files.size(), 2U);
    EXPECT_TRUE(comparable(files[0].at(0)) == comparable(first));
    EXPECT_TRUE(comparable(files[1].at(0)) == comparable(second));
    const auto damaged = put("damaged.csv", to_csv(first) + to_csv(second) + "1,2\n");
    EXPECT_THAT(test::rejected([&] { read_recordings(FlightFile(damaged), std::nullopt); }),
                HasSubstr(fmt::format("damaged.csv:{}: 2 cells", test::lines_of(read_file(damaged)).size())));
}

TEST_F(Recordings, OfASeriesDoNotHideRowsThatAreNotSorted) {
    const auto path = put("x.csv", "time_s,power_w,altitude_m\n" + rows_of(50, 0) + "100,2,3\n" + "520.5,2,3\n");
    EXPECT_THAT(test::rejected([&] { read_recordings(FlightFile(path), std::nullopt); }),
                HasSubstr("time_s = 100 does not rise from"));
}

TEST_F(Recordings, OfACsvByItsMapAreRead) {
    const auto map =
        put("map.toml",
            "time = { column = \"t\", clock = \"unix\" }\n"
            "[[track]]\nname = \"power_w\"\ncolumn = \"w\"\n[[track]]\nname = \"altitude_m\"\ncolumn = \"z\"\n");
    const auto path = put("x.csv", "t,w,z\n" + rows_of(1050, 0) + "t,w,z\n" + rows_of(60, 0));
    LoadOptions options;
    options.columns = map;
    const auto loaded = load_flights(path, options);
    ASSERT_EQ(loaded.flights.size(), 2U);
    EXPECT_EQ(loaded.flights[1].series.start_clock_s, 20.0);
    EXPECT_EQ(power_track(loaded.flights[1].series).time_s.front(), 0.0);
    EXPECT_EQ(loaded.flights[0].phases.sorties.size(), 1U);
    EXPECT_TRUE(loaded.flights[0].series.skipped.empty()) << "a repeated header is no skipped line";
}

/// A recording on the ground.
std::string parked() {
    std::string rows;
    for (int i = 0; i < 100; ++i) rows += fmt::format("{},{},{}\n", i, 1 + i % 2, 0);
    return rows;
}

TEST_F(LoadFlights, NamesRecordingsWithoutAFlight) {
    const auto path = put("x.csv", "time_s,power_w,altitude_m\n" + rows_of(150, 0) + parked() + rows_of(60, 10));
    const auto loaded = load_flights(path);
    ASSERT_EQ(loaded.flights.size(), 2U);
    EXPECT_EQ(loaded.recordings, 3U);
    EXPECT_EQ(loaded.flights[1].recording, 3U);
    EXPECT_EQ(loaded.flights[1].series.flight, "x@3");
    ASSERT_TRUE(loaded.unused.contains(2));
    EXPECT_THAT(loaded.unused.at(2), HasSubstr("has no flight in"));
    EXPECT_EQ(load_flight(path).recording, 1U);
}

TEST_F(LoadFlights, TakesTheFirstRecordingWithAFlightOrTheOneAskedFor) {
    const auto path = put("x.csv", "time_s,power_w,altitude_m\n" + parked() + rows_of(60, 50));
    EXPECT_EQ(load_flight(path).recording, 2U);
    EXPECT_EQ(load_flight(path, any_log()).recording, 2U);
    EXPECT_EQ(read_flight(path).flight, "x@2");
    LoadOptions options = any_log();
    options.recording = 1;
    EXPECT_EQ(load_flight(path, options).recording, 1U);
    options.recording = 3;
    EXPECT_THAT(test::rejected([&] { load_flight(path, options); }), HasSubstr("has no recording 3: there are 2"));
    const auto none = put("none.csv", "time_s,power_w,altitude_m\n" + parked() + parked());
    EXPECT_THAT(test::rejected([&] { load_flight(none); }),
                testing::AllOf(HasSubstr("has 2 recordings without a flight: recording 1: has no flight in"),
                               HasSubstr("; recording 2: has no flight in")));
}

TEST_F(LoadFlights, RefusesRecordingsThatOverlap) {
    std::string rows;
    for (int i = 0; i < 300; ++i)
        rows += fmt::format("{}.5 20 ENERGY 0 12. 1. 12. 0. 0.\n", i % 2 == 0 ? 300 + i : 20 + i);
    EXPECT_THAT(test::rejected([&] { load_flight(put("x.data", rows)); }),
                testing::AllOf(HasSubstr("the clock runs back from 300.500 to 21.500 s"), HasSubstr("overlap")));
}

TEST(RecordingName, IsNoNameOfALogOfItsOwn) {
    EXPECT_EQ(recording_name("x", 1), "x");
    EXPECT_EQ(recording_name("x", 3), "x@3");
    EXPECT_TRUE(is_recording_name("x@3"));
    for (const auto* name : {"x", "x@", "x@a", "@3", "x@3_"}) EXPECT_FALSE(is_recording_name(name)) << name;
}

}  // namespace
}  // namespace flightwatt::flight
