#include "telemetry/recordings.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using testing::ElementsAre;

/// A log of rows in the order of the file, one a line, in turn of two messages of a sender.
TelemetryLog log_of(const std::vector<double>& time_s) {
    TelemetryLog log{"x.data", "x", {}, {{"7", {{"ENERGY", {}, {}}, {"GPS", {}, {}}}}}, {}, {}, time_s.size()};
    for (std::size_t i = 0; i < time_s.size(); ++i) {
        auto& table = log.senders[0].tables[i % 2];
        table.time_s.push_back(time_s[i]);
        table.places.push_back(i + 1);
    }
    return log;
}

void add(std::vector<double>& time_s, double from_s, double to_s, double step_s = 0.5) {
    for (double t = from_s; t < to_s; t += step_s) time_s.push_back(t);
}

bool always(const SenderLog& /*rows*/) { return true; }

/// All times of a recording in the order of the file.
std::vector<double> times_of(const TelemetryLog& log) {
    std::vector<std::pair<std::size_t, double>> rows;
    for (const auto& table : log.senders.at(0).tables)
        for (std::size_t i = 0; i < table.places.size(); ++i) rows.emplace_back(table.places[i], table.time_s[i]);
    std::ranges::sort(rows);
    std::vector<double> times;
    for (const auto& row : rows) times.push_back(row.second);
    return times;
}

/// First and last time of each recording of a log with these times.
std::vector<std::pair<double, double>> spans_of(const std::vector<double>& time_s) {
    std::vector<std::pair<double, double>> spans;
    for (const auto& part : split_recordings(log_of(time_s), always)) {
        const auto times = times_of(part);
        spans.emplace_back(times.front(), times.back());
    }
    return spans;
}

TEST(SplitRecordings, CutsEveryMessageWhereTheClockRestarts) {
    std::vector<double> first;
    add(first, 100.0, 300.0);
    std::vector<double> second;
    add(second, 15.0, 400.0);
    auto both = first;
    both.insert(both.end(), second.begin(), second.end());
    const auto parts = split_recordings(log_of(both), always);
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(times_of(parts[0]), first);
    EXPECT_EQ(times_of(parts[1]), second);
    EXPECT_EQ(parts[1].flight, "x");
    both.push_back(3.0);
    add(both, 3.5, 20.0);
    EXPECT_EQ(split_recordings(log_of(both), always).size(), 3U);
}

TEST(SplitRecordings, NeedsRowsThatShowARestart) {
    std::vector<double> time_s;
    add(time_s, 100.0, 300.0);
    add(time_s, 15.0, 400.0);
    EXPECT_EQ(split_recordings(log_of(time_s), [](const SenderLog&) { return false; }).size(), 1U);
    auto log = log_of(time_s);
    for (auto& table : log.senders[0].tables) table.places.clear();
    EXPECT_EQ(split_recordings(log, always).size(), 1U) << "their order is not known";
}

TEST(SplitRecordings, TakesTheTailOfAnOlderLog) {
    std::vector<double> time_s;
    add(time_s, 500.0, 745.0);
    add(time_s, 100.0, 160.0);
    EXPECT_THAT(spans_of(time_s), ElementsAre(std::pair(500.0, 744.5), std::pair(100.0, 159.5)));
}

TEST(SplitRecordings, TakesARestartedLogThatPausesBeyondTheEndOfTheFormer) {
    std::vector<double> time_s;
    add(time_s, 0.0, 265.0);
    add(time_s, 15.0, 60.0);
    add(time_s, 290.0, 320.0);
    EXPECT_THAT(spans_of(time_s), ElementsAre(std::pair(0.0, 264.5), std::pair(15.0, 319.5)));
}

TEST(SplitRecordings, KeepsRowsOutOfOrder) {
    std::vector<double> moved;  // a block behind the one that follows it
    add(moved, 0.0, 100.0);
    add(moved, 130.0, 160.0);
    add(moved, 100.0, 130.0);
    add(moved, 160.0, 300.0);
    EXPECT_EQ(spans_of(moved).size(), 1U);
    std::vector<double> single;
    add(single, 0.0, 200.0);
    single.insert(single.begin() + 300, 12.0);
    EXPECT_EQ(spans_of(single).size(), 1U);
    std::vector<double> ahead;
    add(ahead, 0.0, 200.0);
    ahead.insert(ahead.begin() + 300, 9, 1e9);
    EXPECT_EQ(spans_of(ahead).size(), 1U) << "damaged times";
    std::vector<double> interleaved;
    for (int i = 0; i < 300; ++i) interleaved.push_back(i % 2 == 0 ? 300.0 + i : 20.0 + i);
    EXPECT_EQ(spans_of(interleaved).size(), 1U) << "cannot be cut";
}

TEST(SplitRecordings, GivesEachItsSkippedLinesAndAssumptions) {
    std::vector<double> time_s;
    add(time_s, 100.0, 300.0);
    add(time_s, 15.0, 100.0);
    auto log = log_of(time_s);
    log.skipped = {{"rubbish", {{15.0, 1, 401}, {16.0, 1, 403}, {120.0, 2, 41}}}, {"cut", {{200.0, 1, 201}}}};
    log.assumed_definitions = {{"GPS: 2018 (11 fields)", 15.5}, {"BAT: 8 fields", 15.0}};
    const auto parts = split_recordings(log, always);
    ASSERT_EQ(parts.size(), 2U);
    ASSERT_EQ(parts[0].skipped.size(), 2U);
    EXPECT_THAT(parts[0].skipped[0].lines, ElementsAre(SkippedLines::AtTime{120.0, 2, 41}));
    ASSERT_EQ(parts[1].skipped.size(), 1U);
    EXPECT_EQ(parts[1].skipped[0].count(), 2U);
    EXPECT_THAT(parts[0].assumed_definitions, ElementsAre(AssumedDefinition{"GPS: 2018 (11 fields)", 100.5}));
    EXPECT_THAT(parts[1].assumed_definitions, ElementsAre(AssumedDefinition{"GPS: 2018 (11 fields)", 15.5}));
}

TEST(SplitRecordings, LeavesOutSendersAndMessagesWithoutRows) {
    std::vector<double> time_s;
    add(time_s, 100.0, 300.0);
    add(time_s, 15.0, 100.0);
    auto log = log_of(time_s);
    log.senders.push_back({"8", {{"GPS", {20.0, 30.0}, {}, {1000, 1001}}}});
    const auto parts = split_recordings(log, always);
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(parts[0].senders.size(), 1U);
    EXPECT_EQ(parts[1].senders.size(), 2U);
}

TEST(SplitRecordings, LeavesAClockThatRestartsAgainAndAgain) {
    std::vector<double> time_s;
    for (std::size_t i = 0; i < max_recordings; ++i) add(time_s, 0.0, 100.0);
    EXPECT_EQ(spans_of(time_s).size(), max_recordings);
    add(time_s, 0.0, 100.0);
    EXPECT_EQ(spans_of(time_s).size(), 1U) << "damage, not recordings";
}

}  // namespace
}  // namespace flightwatt::telemetry
