#include "flight/flight_identity.h"

#include "base/atomic_file.h"
#include "flight/load_flight.h"
#include "flight/series_file.h"
#include "helpers/test_paths.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::HasSubstr;

FlightSeries sample(int number) {
    return read_flight(test::source_dir() / "logs" / ("opterra_synthetic_0" + std::to_string(number) + ".data"));
}

/// The series as it was recorded by a clock that began later.
FlightSeries shifted(FlightSeries series, double by_s) {
    for (auto& track : series.tracks)
        for (auto& time_s : track.time_s) time_s -= by_s;
    return series;
}

TEST(FlightIdentity, IsThatOfTheSamples) {
    const auto series = sample(1);
    const auto content = content_of(series);
    EXPECT_GT(content.stretches, 1000U);
    EXPECT_TRUE(is_same_flight(content, content_of(shifted(series, 84.264))));
    EXPECT_TRUE(is_same_flight(content, content_of(parse_series_csv(to_csv(series), "other.csv"))));
    for (const double until_s : {100.0, 150.0, 400.0, 750.0}) {
        const auto cut = content_of(cut_series(series, until_s));
        EXPECT_TRUE(is_same_flight(content, cut)) << until_s;
        EXPECT_TRUE(is_same_flight(cut, content)) << until_s;
    }
    auto more = series;
    for (auto& track : more.tracks) {
        track.time_s.push_back(track.time_s.back() + 1.0);
        track.value.push_back(17.0);
    }
    EXPECT_TRUE(is_same_flight(content, content_of(more)));
}

TEST(FlightIdentity, IsAnotherOfEveryOtherFlight) {
    std::vector<FlightContent> contents;
    for (int number = 1; number <= 6; ++number) contents.push_back(content_of(sample(number)));
    if (!test::shared_dir().empty()) {
        for (const auto* name : {"20_07_03__12_17_45", "20_07_05__10_26_44", "20_07_10__06_53_03"}) {
            contents.push_back(content_of(read_flight(test::shared_dir() / "flights" / (std::string(name) + ".data"))));
        }
    }
    for (std::size_t i = 0; i < contents.size(); ++i)
        for (std::size_t j = 0; j < contents.size(); ++j)
            EXPECT_EQ(is_same_flight(contents[i], contents[j]), i == j) << i << " " << j;
}

TEST(FlightIdentity, IsFoundAmongMany) {
    KnownFlights known;
    for (int number = 1; number <= 5; ++number) known.add(content_of(sample(number)));
    EXPECT_EQ(known.find(content_of(cut_series(sample(3), 400.0))), 2U);
    EXPECT_EQ(known.find(content_of(sample(6))), std::nullopt);
    EXPECT_EQ(known.find({}), std::nullopt);
}

TEST(FlightIdentity, OfWhatDoesNotVaryIsUnknown) {
    FlightSeries series;
    Track altitude{.name = "altitude_m"};
    for (int i = 0; i < 100; ++i) {
        altitude.time_s.push_back(i);
        altitude.value.push_back(i % 5);
    }
    series.tracks = {altitude};
    EXPECT_EQ(content_of(series).stretches, 0U);
    EXPECT_FALSE(is_same_flight(content_of(series), content_of(series)));
}

TEST(FlightIdentity, OfALogThatWasRecordedTwice) {
    const auto folder = test::shared_dir() / "archives" / "no-power";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "../shared/archives is not here";
    std::vector<FlightContent> contents;
    for (const auto* name : {"12_05_21__07_04_51.data", "12_05_21__07_06_15.data", "12_05_17__07_18_57.data"}) {
        contents.push_back(content_of(read_candidates(FlightFile(folder / name), "1").front()));
    }
    EXPECT_TRUE(is_same_flight(contents[0], contents[1]));
    EXPECT_FALSE(is_same_flight(contents[0], contents[2]));
}

TEST(Aircraft, AreOneUnlessIdNameOrTheirBeingRealTellsThemApart) {
    const auto mix = [](const std::vector<FlownBy>& flights) { return describe_mix(flights); };
    EXPECT_EQ(mix({}), "");
    EXPECT_EQ(mix({{"a", "20", "Twinstar"}, {"b", "20", "Twinstar"}, {"c", "20", ""}, {"d", "", ""}}), "");
    EXPECT_EQ(mix({{"a", "7", "Opterra_synthetic"}, {"b", "7", unnamed_synthetic}}), "");
    EXPECT_EQ(mix({{"a", "20", "Twinstar"}, {"b", "7", ""}, {"c", "20", "Twinstar"}}), "20 Twinstar: a, c; 7: b");
    EXPECT_THAT(mix({{"a", "7", "Opterra"}, {"b", "7", "Twinstar"}}), HasSubstr("7 Twinstar: b"));
    EXPECT_THAT(mix({{"a", "7", "Opterra"}, {"b", "7", unnamed_synthetic}}), HasSubstr("7 synthetic (SYNTHETIC): b"));
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
