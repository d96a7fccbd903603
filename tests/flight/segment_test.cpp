#include "flight/segment.h"

#include "base/error.h"
#include "flight/load_flight.h"
#include "helpers/flown_points.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

TEST(SegmentationClock, GivesTheSameEdgesToALogThatBeginsAWholeNumberOfStepsLater) {
    constexpr double interval_s = 0.125;
    auto whole = test::columns_of(test::sortie(100), interval_s);
    for (std::size_t i = 0; i < whole.time_s.size(); ++i) {
        whole.altitude_m[i] +=
            2.0 * std::sin(1.7 * static_cast<double>(i));  // uneven, so that it matters when one looks
    }
    const auto edges_without = [&](std::ptrdiff_t samples) {
        auto later = whole;
        for (auto* column : {&later.time_s, &later.altitude_m, &later.throttle_percent, &later.power_w}) {
            column->erase(column->begin(), column->begin() + samples);
        }
        std::vector<double> edges;
        const auto phases = segment(select_tracks(test::series_of(later)));
        for (const auto& span : phases.sorties.at(0).phases) {
            edges.push_back(span.start.time_s);
            edges.push_back(span.end.time_s);
        }
        return edges;
    };
    const auto all = edges_without(0);
    const auto step = static_cast<std::ptrdiff_t>(segmentation_step_s / interval_s);
    EXPECT_EQ(edges_without(step), all);
    EXPECT_EQ(edges_without(7 * step), all);
    EXPECT_NE(edges_without(step / 2), all);
}

using test::columns_of;
using test::Point;
using test::series_of;
using test::sortie;
using testing::HasSubstr;

TEST(Segment, LeavesOutAModeThatIsNoNumberOfAnInt) {
    auto data = select_tracks(series_of(columns_of(sortie(100), 0.5)));
    for (const double mode : {4.0, 2.18e9}) {
        static_cast<Track&>(data.mode) = {.name = "mode", .time_s = {data.power_w.time_s.front()}, .value = {mode}};
        const auto edge = segment(data).sorties.at(0).phases.front().start;
        EXPECT_EQ(edge.mode, mode < 1e9 ? std::optional(4) : std::nullopt);
    }
}

struct Edges {
    double lift_off, takeoff_end, landing_start, touchdown;
};

void expect_sortie(const Sortie& sortie, Edges edges, double tolerance_s = 3.0) {
    ASSERT_EQ(sortie.phases.size(), 3u);
    EXPECT_NEAR(sortie.phases[0].start.time_s, edges.lift_off, tolerance_s);
    EXPECT_NEAR(sortie.phases[0].end.time_s, edges.takeoff_end, tolerance_s);
    EXPECT_EQ(sortie.phases[0].end.time_s, sortie.phases[1].start.time_s);
    EXPECT_NEAR(sortie.phases[1].end.time_s, edges.landing_start, tolerance_s);
    EXPECT_EQ(sortie.phases[1].end.time_s, sortie.phases[2].start.time_s);
    EXPECT_NEAR(sortie.phases[2].end.time_s, edges.touchdown, tolerance_s);
    for (const auto& span : sortie.phases) EXPECT_TRUE(span.complete);
}

constexpr Edges plain{101, 127, 434, 469};

TEST(Segmentation, FindsThePhasesOfAPlainFlight) {
    const auto phases = segment(select_tracks(series_of(sortie(100))));
    ASSERT_EQ(phases.sorties.size(), 1u);
    expect_sortie(phases.sorties[0], plain);
    EXPECT_NEAR(phases.sorties[0].height_m, 100.0, 1.0);
    EXPECT_TRUE(phases.ground_events.empty());
}

/// A height above the flight plan's ground for less than a step of the grid: no phase, so no sortie.
TEST(Segmentation, FindsNoSortieWithoutDuration) {
    test::SampleColumns columns;
    columns.time_s = {100.0, 100.4};
    columns.altitude_m = {289.5, 289.8};
    columns.throttle_percent = {94.0, 94.0};
    auto series = test::series_of(columns);
    series.planned_ground_altitude_m = 185.0;
    const auto phases = segment(select_tracks(series));
    EXPECT_TRUE(phases.sorties.empty());
    ASSERT_EQ(phases.ground_events.size(), 1u);
    EXPECT_THAT(phases.ground_events[0].what, HasSubstr("too short for a flight"));
}

TEST(Segmentation, DoesNotDependOnTheUnitOfHeightOrTheHourOfTheLog) {
    auto series = columns_of(sortie(100));
    const auto before = segment(select_tracks(test::series_of(series)));
    for (auto& t : series.time_s) t += 36000.0;
    for (auto& z : series.altitude_m) z = 5.0 * z + 1000.0;
    SegmentationOptions options;
    options.rest_height_m *= 5.0;
    options.flight_height_m *= 5.0;
    const auto after = segment(select_tracks(test::series_of(series)), options);
    ASSERT_EQ(after.sorties.size(), 1u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(after.sorties[0].phases[i].start.time_s - 36000.0, before.sorties[0].phases[i].start.time_s, 0.6);
    }
}

TEST(Segmentation, IsNotFooledByAnEstimatorThatStartsAtZero) {
    std::vector<Point> points{{0, 0, 0}, {30, 0, 0}, {45, 185, 0}};
    for (const auto& p : sortie(100, 185)) points.push_back(p);
    const auto phases = segment(select_tracks(series_of(points)));
    ASSERT_EQ(phases.sorties.size(), 1u);
    expect_sortie(phases.sorties[0], plain);
    // And if it finds its fix only just before lift-off, while the motor already runs:
    points = {{0, 0, 0}, {90, 0, 0}, {97, 185, 0}};
    for (const auto& p : sortie(100, 185)) {
        if (p.time_s > 97) points.push_back(p);
    }
    const auto late = segment(select_tracks(series_of(points)));
    ASSERT_EQ(late.sorties.size(), 1u);
    expect_sortie(late.sorties[0], plain, 5.0);
    EXPECT_EQ(late.warnings.size(), 1u);
}

TEST(Segmentation, KeepsDivesInCruise) {
    auto points = sortie(100);
    points.insert(points.begin() + 6, {{200, 100, 60},
                                       {206, 30, 0},
                                       {212, 30, 100},
                                       {230, 100, 100},
                                       {231, 100, 60},
                                       {400, 100, 60},
                                       {405, 35, 0},
                                       {420, 110, 100}});
    const auto phases = segment(select_tracks(series_of(points)));
    ASSERT_EQ(phases.sorties.size(), 1u);
    expect_sortie(phases.sorties[0], plain, 4.0);
}

TEST(Segmentation, NamesRunUpsAndIgnoresPowerAfterLanding) {
    auto points = sortie(100);
    points.insert(points.begin() + 1, {{75, 0, 0}, {76, 0.5, 80}, {79, 0.5, 80}, {80, 0, 0}});
    points.push_back({530, 0, 0});
    points.push_back({531, 0, 70});
    points.push_back({535, 0, 70});
    points.push_back({536, 0, 0});
    points.push_back({560, 0, 0});
    auto series = columns_of(points);
    std::fill(series.power_w.end() - 5, series.power_w.end(), 80.0);
    const auto phases = segment(select_tracks(test::series_of(series)));
    ASSERT_EQ(phases.sorties.size(), 1u);
    expect_sortie(phases.sorties[0], plain);
    ASSERT_EQ(phases.ground_events.size(), 2u);
    EXPECT_THAT(phases.ground_events[0].what, HasSubstr("run-up"));
}

TEST(Segmentation, IsNotFooledByAThrottleBurstBeforeTouchdown) {
    auto points = sortie(100);
    points.insert(points.begin() + 8, {{462, 15, 0}, {463, 14, 50}, {467, 6, 50}, {468, 5, 0}});
    const auto phases = segment(select_tracks(series_of(points)));
    ASSERT_EQ(phases.sorties.size(), 1u);
    expect_sortie(phases.sorties[0], plain);
}

TEST(Segmentation, FindsEverySortieOfALog) {
    auto points = sortie(100);
    for (const auto& p : sortie(600, 2.0)) points.push_back(p);
    const auto phases = segment(select_tracks(series_of(points)));
    ASSERT_EQ(phases.sorties.size(), 2u);
    expect_sortie(phases.sorties[0], plain);
    expect_sortie(phases.sorties[1], {601, 627, 934, 969});
}

TEST(Segmentation, MarksAFlightThatTheLogEntersOrLeavesInTheAir) {
    auto entering = sortie(100);
    entering.erase(entering.begin(), entering.begin() + 5);
    const auto in = segment(select_tracks(series_of(entering)));
    ASSERT_EQ(in.sorties.size(), 1u);
    ASSERT_EQ(in.sorties[0].phases.size(), 2u);
    EXPECT_EQ(in.sorties[0].phases[0].phase, Phase::cruise);
    EXPECT_FALSE(in.sorties[0].phases[0].complete);
    EXPECT_EQ(in.sorties[0].phases[1].phase, Phase::landing);
    EXPECT_TRUE(in.sorties[0].phases[1].complete);
    EXPECT_NEAR(in.sorties[0].phases[1].end.time_s, plain.touchdown, 3.0);

    auto leaving = sortie(100);
    leaving.erase(leaving.end() - 4, leaving.end());
    leaving.push_back({400, 100, 60});
    const auto out = segment(select_tracks(series_of(leaving)));
    ASSERT_EQ(out.sorties.size(), 1u);
    ASSERT_EQ(out.sorties[0].phases.size(), 2u);
    EXPECT_EQ(out.sorties[0].phases[0].phase, Phase::takeoff);
    EXPECT_TRUE(out.sorties[0].phases[0].complete);
    EXPECT_EQ(out.sorties[0].phases[1].phase, Phase::cruise);
    EXPECT_FALSE(out.sorties[0].phases[1].complete);
}

TEST(Segmentation, TakesALowCircleBeforeTheFinalApproachForLanding) {
    auto points = sortie(100);
    points.resize(7);
    points.insert(points.end(), {{431, 98, 20}, {480, 35, 30}, {540, 35, 40}, {560, 0, 0}, {620, 0, 0}});
    const auto phases = segment(select_tracks(series_of(points)));
    ASSERT_EQ(phases.sorties.size(), 1u);
    expect_sortie(phases.sorties[0], {101, 127, 437, 558});
}

TEST(Segmentation, TakesNoDiveAtTheEndOfTheLogForALanding) {
    auto points = sortie(100);
    points.resize(6);
    points.insert(points.end(), {{300, 100, 60}, {308, 40, 0}});
    const auto phases = segment(select_tracks(series_of(points)));
    ASSERT_EQ(phases.sorties.size(), 1u);
    ASSERT_EQ(phases.sorties[0].phases.size(), 2u);
    EXPECT_EQ(phases.sorties[0].phases[1].phase, Phase::cruise);
    EXPECT_FALSE(phases.sorties[0].phases[1].complete);
}

TEST(Segmentation, NeedsLittleGroundAtTheEndsOfTheLog) {
    auto points = sortie(100);
    points.front() = {94, 0, 0};
    points.back() = {475, 0.2, 0};
    const auto phases = segment(select_tracks(series_of(points)));
    ASSERT_EQ(phases.sorties.size(), 1u);
    expect_sortie(phases.sorties[0], plain);
}

TEST(Segmentation, KnowsAnArmedIdleByTheSpeed) {
    auto series = columns_of(sortie(100));
    for (auto& throttle : series.throttle_percent) throttle = std::max(throttle, 12.0);
    series.ground_speed_m_per_s.assign(series.time_s.size(), 0.3);
    for (std::size_t i = 0; i < series.time_s.size(); ++i) {
        if (series.time_s[i] > 100 && series.time_s[i] < 470) series.ground_speed_m_per_s[i] = 13.0;
    }
    const auto phases = segment(select_tracks(test::series_of(series)));
    ASSERT_EQ(phases.sorties.size(), 1u);
    expect_sortie(phases.sorties[0], plain);
}

TEST(Segmentation, WorksThroughGapsAndSpikes) {
    auto series = columns_of(sortie(100));
    const auto drop = [&](double from, double to) {
        for (std::size_t i = series.time_s.size(); i-- > 0;) {
            if (series.time_s[i] < from || series.time_s[i] > to) continue;
            for (auto* channel : {&series.time_s, &series.altitude_m, &series.throttle_percent, &series.power_w}) {
                channel->erase(channel->begin() + static_cast<std::ptrdiff_t>(i));
            }
        }
    };
    drop(200, 222);
    drop(300, 310);
    series.altitude_m[150] = 900.0;
    const auto phases = segment(select_tracks(test::series_of(series)));
    ASSERT_EQ(phases.sorties.size(), 1u);
    expect_sortie(phases.sorties[0], plain);
}

TEST(Segmentation, SaysWhatItSawWhereNothingFlew) {
    const auto refusal = [](const std::vector<Point>& points) {
        const auto series = series_of(points);
        try {
            require_sortie(select_tracks(series), segment(select_tracks(series)), "x.data");
        } catch (const InputError& error) {
            return std::string(error.what()) + "; " + error.hint();
        }
        return std::string("accepted");
    };
    EXPECT_THAT(refusal({{0, 5, 0}, {100, 5, 0}}), HasSubstr("has no flight in 99 s; no motion"));
    EXPECT_THAT(refusal({{0, 5, 0}, {50, 5, 0}, {51, 5, 70}, {60, 5, 70}, {61, 5, 0}, {100, 5, 0}}),
                HasSubstr("run-up, taxi or hop: throttle to 70 %"));
    EXPECT_THAT(refusal({{0, 5, 0}, {50, 5, 0}, {60, 60, 0}, {70, 5, 0}, {100, 5, 0}}),
                HasSubstr("its estimator has no fix"));
}

TEST(Segmentation, RefusesWhatCannotBeSegmented) {
    auto series = columns_of(sortie(100));
    series.altitude_m.clear();
    EXPECT_THROW(segment(select_tracks(test::series_of(series))), InputError);
    auto slow = columns_of(sortie(100));
    for (auto& t : slow.time_s) t *= 1e9;
    EXPECT_THROW(segment(select_tracks(test::series_of(slow))), InputError);
    SegmentationOptions options;
    options.cruise_fraction = 1.5;
    EXPECT_THROW(segment(select_tracks(series_of(sortie(100))), options), UsageError);
}

struct RealFlight {
    const char* name;
    Edges edges;
};

TEST(Segmentation, MatchesWhatWasReadOffPlotsOfTheRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const auto& [name, edges] : {RealFlight{"20_07_03__12_17_45", {147, 178, 1549, 1586}},
                                      RealFlight{"20_07_05__10_26_44", {210, 237, 1900, 1937}},
                                      RealFlight{"20_07_10__06_53_03", {321, 356, 1066, 1100}}}) {
        SCOPED_TRACE(name);
        const auto series = read_flight(test::shared_dir() / "flights" / (std::string(name) + ".data"));
        const auto phases = segment(select_tracks(series));
        ASSERT_EQ(phases.sorties.size(), 1u);
        expect_sortie(phases.sorties[0], edges, 5.0);
        const auto& lift_off = phases.sorties[0].phases[0].start;
        ASSERT_TRUE(lift_off.takeoff_after_s.has_value());
        EXPECT_LT(std::abs(*lift_off.takeoff_after_s), 3.0) << "TAKEOFF is evidence";
    }
}

/// One random change of a track: it loses a part, keeps one alone, is thinned, does not move, is moved in time, or goes.
void disturb(Track& track, std::mt19937& random) {
    const auto size = track.time_s.size();
    const auto keep = [&](const auto& keeps) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < size; ++i) {
            if (!keeps(i)) continue;
            track.time_s[kept] = track.time_s[i];
            track.value[kept++] = track.value[i];
        }
        track.time_s.resize(kept);
        track.value.resize(kept);
    };
    const std::size_t begin = size == 0 ? 0 : random() % size;
    const std::size_t end = begin + (size == 0 ? 0 : random() % (size - begin + 1));
    switch (random() % 8) {
        case 0:
            return keep([&](std::size_t i) { return i < begin || i >= end; });
        case 1:
            return keep([&](std::size_t i) { return i >= begin && i < end; });
        case 2:
            return keep([&](std::size_t i) { return i % 50 == 0; });
        case 3:
            return keep([&](std::size_t i) { return i == begin; });
        case 4:
            return std::fill(track.value.begin() + static_cast<std::ptrdiff_t>(begin), track.value.end(), 0.0);
        case 5: {
            const double by_s = static_cast<double>(random() % 2000) - 1000.0;
            for (auto& time_s : track.time_s) time_s += by_s;
            return;
        }
        case 6:
            return keep([](std::size_t) { return false; });
        default:
            return;
    }
}

/// Whatever comes of the tracks: phases in order and finite, or an error that states what is missing.
TEST(Segmentation, IsATotalFunctionOfAnyCutsOrdersAndGaps) {
    const auto log = test::source_dir() / "logs" / "opterra_synthetic_01.data";
    const auto series = read_candidates(FlightFile(log), std::nullopt).at(0);
    std::mt19937 random(11);
    std::size_t segmented = 0;
    for (int round = 0; round < 400; ++round) {
        auto disturbed = series;
        for (auto& track : disturbed.tracks) disturb(track, random);
        std::erase_if(disturbed.tracks, [](const Track& track) { return track.empty(); });
        std::ranges::shuffle(disturbed.tracks, random);
        try {
            const auto phases = segment(select_tracks(disturbed));
            ++segmented;
            double last_s = -std::numeric_limits<double>::infinity();
            for (const auto& sortie : phases.sorties) {
                ASSERT_FALSE(sortie.phases.empty()) << round;
                for (const auto& span : sortie.phases) {
                    ASSERT_GE(span.start.time_s, last_s) << round;
                    ASSERT_GE(span.end.time_s, span.start.time_s) << round;
                    ASSERT_TRUE(std::isfinite(span.end.altitude_m)) << round;
                    last_s = span.end.time_s;
                }
            }
            assess_flight(select_tracks(disturbed), phases);
        } catch (const InputError& error) {
            ASSERT_THAT(error.what(), testing::HasSubstr("has no altitude")) << round;
        }
    }
    EXPECT_GT(segmented, 200U);
}

}  // namespace
}  // namespace flightwatt::flight
