#include "flight/flight_identity.h"

#include "base/atomic_file.h"
#include "flight/load_flight.h"
#include "flight/selected_track.h"
#include "flight/series_file.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

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

using testing::HasSubstr;

FlightSeries sample(int number) {
    return read_flight(test::source_dir() / "logs" / ("opterra_synthetic_0" + std::to_string(number) + ".data"));
}

FlightSketch content_of_sample(int number) { return make_sketch(sample(number)); }

/// The series as it was recorded by a clock that began later and runs slower.
FlightSeries with_clock(FlightSeries series, double later_s, double slower = 0.0) {
    for (auto& track : series.tracks)
        for (auto& time_s : track.time_s) time_s = time_s * (1.0 - slower) - later_s;
    return series;
}

/// The series without a random part of its samples.
FlightSeries with_losses(FlightSeries series, double part, unsigned seed) {
    std::mt19937_64 random(seed);
    std::bernoulli_distribution is_lost(part);
    for (auto& track : series.tracks) {
        Track kept{track.name, track.source, track.device, track.since_s, {}, {}};
        for (std::size_t i = 0; i < track.time_s.size(); ++i) {
            if (is_lost(random)) continue;
            kept.time_s.push_back(track.time_s[i]);
            kept.value.push_back(track.value[i]);
        }
        track = kept;
    }
    return series;
}

FlightSeries in_whole_numbers(FlightSeries series) {
    for (auto& track : series.tracks)
        for (auto& value : track.value) value = std::round(value);
    return series;
}

FlightSeries with_jitter(FlightSeries series, double max_s) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> jitter(-max_s, max_s);
    for (auto& track : series.tracks)
        for (auto& time_s : track.time_s) time_s += jitter(random);
    return series;
}

FlightSeries without_begin(FlightSeries series, double until_s) {
    for (auto& track : series.tracks) {
        const auto first = std::ranges::lower_bound(track.time_s, until_s) - track.time_s.begin();
        track.time_s.erase(track.time_s.begin(), track.time_s.begin() + first);
        track.value.erase(track.value.begin(), track.value.begin() + first);
    }
    return series;
}

bool is_same(const FlightSeries& one, const FlightSeries& other) {
    const auto there = compare_sketches(make_sketch(one), make_sketch(other)).is_same;
    EXPECT_EQ(compare_sketches(make_sketch(other), make_sketch(one)).is_same, there);
    return there;
}

/// The sample logs and real flights, each once.
std::vector<FlightSeries> different_flights() {
    std::vector<FlightSeries> flights;
    for (int number = 1; number <= 6; ++number) flights.push_back(sample(number));
    if (test::shared_dir().empty()) return flights;
    for (const auto* name : {"20_07_03__12_17_45", "20_07_05__10_26_44", "20_07_10__06_53_03"})
        flights.push_back(read_flight(test::shared_dir() / "flights" / (std::string(name) + ".data")));
    return flights;
}

TEST(FlightIdentity, IsThatOfTheSamples) {
    const auto series = sample(1);
    EXPECT_TRUE(is_same(series, with_clock(series, 84.264)));
    EXPECT_TRUE(is_same(series, parse_series_csv(to_csv(series), "other.csv")));
    for (const double until_s : {100.0, 150.0, 400.0, 750.0}) {
        EXPECT_TRUE(is_same(series, truncate_series(series, until_s))) << until_s;
    }
    auto more = series;
    for (auto& track : more.tracks) {
        track.time_s.push_back(track.time_s.back() + 1.0);
        track.value.push_back(17.0);
    }
    EXPECT_TRUE(is_same(series, more));
}

TEST(FlightIdentity, OutlivesLossesAndAnotherClock) {
    auto flights = different_flights();
    flights.erase(flights.begin() + 1, flights.begin() + 6);
    for (const auto& series : flights) {
        SCOPED_TRACE(series.flight);
        for (const double part : {0.03, 0.1, 0.3, 0.6}) {
            EXPECT_TRUE(is_same(series, with_losses(series, part, 1))) << part;
            EXPECT_TRUE(is_same(with_losses(series, part, 1), with_losses(series, part, 2))) << part;
        }
        EXPECT_TRUE(is_same(with_clock(series, 5000.0, 5e-4), series));
        EXPECT_TRUE(is_same(with_jitter(series, 0.05), series));
        EXPECT_TRUE(is_same(with_losses(series, 0.3, 1), with_clock(with_losses(series, 0.3, 2), 1e6, 5e-4)));
    }
}

TEST(FlightIdentity, IsAnotherOfEveryOtherFlight) {
    for (const bool are_whole : {false, true}) {
        std::vector<FlightSketch> contents;
        for (const auto& flight : different_flights())
            contents.push_back(make_sketch(are_whole ? in_whole_numbers(flight) : flight));
        for (std::size_t i = 0; i < contents.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_FALSE(compare_sketches(contents[i], contents[j]).is_same) << i << " " << j << " " << are_whole;
    }
}

/// Sensors without noise, and the same power at the same time: the plan, not the flight.
TEST(FlightIdentity, IsNotThatOfAnotherWithTheSamePower) {
    const auto series = sample(1);
    auto other = sample(2);
    for (const auto* name : {"power_w", "current_a", "voltage_v"}) replace_track(other, select_track(series, name));
    EXPECT_FALSE(is_same(series, other));
}

TEST(FlightIdentity, OfLessThanHalfIsNotThatOfTheFlight) {
    const auto series = sample(1);
    const auto first = make_sketch(truncate_series(series, 450.0));
    const auto rest = make_sketch(without_begin(series, 350.0));
    const auto likeness = compare_sketches(first, rest);
    EXPECT_FALSE(likeness.is_same);
    EXPECT_NEAR(likeness.shared_s, 100.0, 40.0);
    EXPECT_TRUE(compare_sketches(first, make_sketch(without_begin(series, 150.0))).is_same);
    EXPECT_EQ(compare_sketches(first, make_sketch(without_begin(series, 460.0))).shared_s, 0.0);
}

TEST(FlightIdentity, IsFoundAmongMany) {
    SketchIndex known;
    for (int number = 1; number <= 5; ++number) known.add(content_of_sample(number));
    const auto found = known.find(make_sketch(truncate_series(sample(3), 400.0)));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].number, 2U);
    EXPECT_TRUE(found[0].likeness.is_same);
    EXPECT_TRUE(known.find(content_of_sample(6)).empty());
    EXPECT_TRUE(known.find({}).empty());
}

TEST(FlightIdentity, PrefersTheCopyWithDefinitionsAndSamples) {
    const FlightSketch without{{}, false, 900};
    const FlightSketch with{{}, true, 500};
    const FlightSketch with_more{{}, true, 600};
    EXPECT_TRUE(is_preferred_duplicate(with, without));
    EXPECT_TRUE(is_preferred_duplicate(with_more, with));
    EXPECT_FALSE(is_preferred_duplicate(with, with));
    EXPECT_FALSE(is_preferred_duplicate(without, with));
    EXPECT_EQ(content_of_sample(1).samples, power_track(sample(1)).time_s.size());
}

TEST(FlightIdentity, OfWhatDoesNotVaryIsUnknown) {
    FlightSeries series;
    Track altitude{.name = "altitude_m"};
    for (int i = 0; i < 1000; ++i) {
        altitude.time_s.push_back(i);
        altitude.value.push_back(i % 5);
    }
    series.tracks = {altitude};
    EXPECT_TRUE(make_sketch(series).hashes.empty());
    EXPECT_FALSE(is_same(series, series));
}

TEST(FlightIdentity, OfALogThatWasRecordedTwice) {
    const auto folder = test::shared_dir() / "archives" / "no-power";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "../shared/archives is not here";
    std::vector<FlightSeries> flights;
    for (const auto* name :
         {"12_05_21__07_04_51.data", "12_05_21__07_06_15.data", "12_05_17__07_18_57.data", "12_05_16__07_20_45.data"}) {
        flights.push_back(read_candidates(FlightFile(folder / name), "1").front());
    }
    EXPECT_TRUE(is_same(flights[0], flights[1]));
    EXPECT_TRUE(is_same(with_losses(flights[0], 0.5, 1), with_losses(flights[1], 0.5, 2)));
    EXPECT_FALSE(is_same(flights[0], flights[2]));
    EXPECT_FALSE(is_same(flights[3], flights[2]));
    EXPECT_FALSE(is_same(flights[3], flights[0]));
}

TEST(Aircraft, AreOneUnlessIdNameOrTheirBeingRealTellsThemApart) {
    const auto mix = [](const std::vector<FlightAircraft>& flights) { return describe_mixed_aircraft(flights); };
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
