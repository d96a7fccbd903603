#include "mission/file/schedule_toml.h"

#include "helpers/rejected.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::rejected;

const flight::PerPhase<double> durations{{28.0, 600.0, 60.0}};

compute::Configuration running(double qos) { return {{0, {qos}}}; }

Location line(std::size_t number) { return {"m.toml", number, 1}; }

ScheduleEntry part(flight::Phase phase, double start_s, double end_s, double qos, std::size_t at = 1) {
    return {phase, false, false, start_s, end_s, running(qos), line(at)};
}

ScheduleEntry rest(std::optional<flight::Phase> phase, double qos, std::size_t at = 1) {
    return {phase, true, false, 0.0, 0.0, running(qos), line(at)};
}

std::string spell(const std::vector<ScheduleSegment>& segments) {
    std::string text;
    for (const auto& s : segments) {
        text += std::string(to_string(s.phase)) + " " + std::to_string(static_cast<int>(s.start_s)) + ".." +
                std::to_string(static_cast<int>(s.end_s)) + "=" + std::to_string(static_cast<int>(s.run[0].qos[0])) +
                "; ";
    }
    return text;
}

TEST(ScheduleEntries, OtherwiseFillsWhatIsLeft) {
    const auto laid =
        resolve_schedule({part(flight::Phase::cruise, 240.0, 360.0, 3), rest(std::nullopt, 1)}, durations);
    EXPECT_EQ(spell(laid), "takeoff 0..28=1; cruise 0..240=1; cruise 240..360=3; cruise 360..600=1; landing 0..60=1; ");
}

TEST(ScheduleEntries, AnOtherwiseOfThePhaseComesBeforeThatOfTheMission) {
    const auto laid = resolve_schedule(
        {rest(std::nullopt, 1), part(flight::Phase::cruise, 0.0, 100.0, 3), rest(flight::Phase::cruise, 2)}, durations);
    EXPECT_EQ(spell(laid), "takeoff 0..28=1; cruise 0..100=3; cruise 100..600=2; landing 0..60=1; ");
}

TEST(ScheduleEntries, NeedsNoOtherwiseWhereEntriesMeet) {
    const auto laid = resolve_schedule(
        {part(flight::Phase::landing, 0.0, 60.0, 4), part(flight::Phase::cruise, 300.0, 600.0, 3),
         part(flight::Phase::cruise, 0.0, 300.0 + 1e-12, 2), part(flight::Phase::takeoff, -1e-13, 28.0 - 1e-13, 1)},
        durations);
    EXPECT_EQ(spell(laid), "takeoff 0..28=1; cruise 0..300=2; cruise 300..600=3; landing 0..60=4; ");
    EXPECT_EQ(laid[0].start_s, 0.0);
    EXPECT_EQ(laid[0].end_s, 28.0);
    EXPECT_EQ(laid[1].end_s, laid[2].start_s);
}

TEST(ScheduleEntries, LeavesOutPhasesThatAreNotFlown) {
    EXPECT_EQ(spell(resolve_schedule({rest(std::nullopt, 1)}, {{0.0, 600.0, 0.0}})), "cruise 0..600=1; ");
}

TEST(ScheduleEntries, CoversEachInstantExactlyOnce) {
    std::mt19937 random(7);
    for (int round = 0; round < 200; ++round) {
        // Disjoint segments between random cuts, every second one left to an `otherwise`, in random order.
        std::vector<ScheduleEntry> entries{rest(std::nullopt, 0)};
        if (round % 2 == 0) entries.push_back(rest(flight::Phase::cruise, 1));
        for (const auto phase : flight::all_phases) {
            std::vector<double> cuts(6);
            for (auto& cut : cuts) cut = std::uniform_real_distribution(0.0, durations[phase])(random);
            std::sort(cuts.begin(), cuts.end());
            for (std::size_t i = 0; i + 1 < cuts.size(); i += 2) {
                entries.push_back(part(phase, cuts[i], cuts[i + 1], 2));
            }
        }
        std::shuffle(entries.begin(), entries.end(), random);
        const auto laid = resolve_schedule(entries, durations);
        auto previous = laid.front();
        EXPECT_EQ(previous.phase, flight::Phase::takeoff);
        EXPECT_EQ(previous.start_s, 0.0);
        for (std::size_t i = 1; i < laid.size(); ++i) {
            const auto& segment = laid[i];
            EXPECT_LT(segment.start_s, segment.end_s);
            if (segment.phase == previous.phase) {
                EXPECT_EQ(segment.start_s, previous.end_s);
            } else {
                EXPECT_EQ(previous.end_s, durations[previous.phase]);
                EXPECT_EQ(segment.start_s, 0.0);
            }
            previous = segment;
        }
        EXPECT_EQ(previous.phase, flight::Phase::landing);
        EXPECT_EQ(previous.end_s, durations[flight::Phase::landing]);
    }
}

TEST(ScheduleEntries, RefusesOverlaps) {
    EXPECT_EQ(rejected([] {
                  resolve_schedule({part(flight::Phase::cruise, 200.0, 400.0, 1, 9),
                                    part(flight::Phase::cruise, 100.0, 250.0, 1, 4), rest({}, 1)},
                                   durations);
              }),
              "m.toml:9:1: cruise from 200 s to 250 s is scheduled twice, here and in line 4; end one "
              "where the other "
              "begins");
    auto whole = part(flight::Phase::cruise, 0.0, 600.0, 1, 12);
    whole.whole_phase = true;
    EXPECT_EQ(rejected([&] {
                  resolve_schedule({part(flight::Phase::cruise, 240.0, 360.0, 1, 8), whole, rest({}, 1)}, durations);
              }),
              "m.toml:12:1: cruise from 240 s to 360 s is scheduled twice, here and in line 8; give the "
              "entry of the whole "
              "phase `otherwise = true`, and it takes what the others leave");
}

TEST(ScheduleEntries, RefusesASegmentWithinAnother) {
    EXPECT_EQ(rejected([] {
                  resolve_schedule(
                      {part(flight::Phase::cruise, 0.0, 500.0, 1, 2), part(flight::Phase::cruise, 100.0, 200.0, 1, 3)},
                      durations);
              }),
              "m.toml:3:1: cruise from 100 s to 200 s is scheduled twice, here and in line 2; end one "
              "where the other "
              "begins");
}

TEST(ScheduleEntries, RefusesGaps) {
    EXPECT_EQ(rejected([] {
                  resolve_schedule(
                      {part(flight::Phase::takeoff, 0.0, 28.0, 1, 3), part(flight::Phase::cruise, 0.0, 240.0, 1, 6),
                       part(flight::Phase::cruise, 360.0, 600.0, 1, 9), rest(flight::Phase::landing, 1, 12)},
                      durations);
              }),
              "m.toml:9:1: nothing is scheduled for cruise from 240 s to 360 s; add an entry with `otherwise "
              "= true`; "
              "`run = {}` runs nothing");
    EXPECT_EQ(rejected([] { resolve_schedule({part(flight::Phase::takeoff, 0.0, 20.0, 1, 3)}, durations); }),
              "m.toml:3:1: nothing is scheduled for take-off from 20 s to 28 s; add an entry with `otherwise "
              "= true`; "
              "`run = {}` runs nothing");
    EXPECT_EQ(rejected([] { resolve_schedule({part(flight::Phase::takeoff, 0.0, 28.0, 1, 3)}, durations); }),
              "m.toml:3:1: nothing is scheduled for cruise from 0 s to 600 s; add an entry with `otherwise = "
              "true`; "
              "`run = {}` runs nothing");
}

TEST(ScheduleEntries, RefusesAnOtherwiseTooMany) {
    const std::string nothing = "this `otherwise` covers nothing: the other entries leave no time; take it out";
    EXPECT_EQ(rejected([] {
                  resolve_schedule({part(flight::Phase::cruise, 0.0, 600.0, 1), rest(flight::Phase::cruise, 1, 5)},
                                   {{0.0, 600.0, 0.0}});
              }),
              "m.toml:5:1: " + nothing);
    EXPECT_EQ(rejected([] {
                  resolve_schedule({rest(flight::Phase::cruise, 1, 3), rest({}, 1, 6)}, {{0.0, 600.0, 0.0}});
              }),
              "m.toml:6:1: " + nothing);
    EXPECT_EQ(rejected([] {
                  resolve_schedule({rest({}, 1, 3), rest({}, 1, 6)}, durations);
              }),
              "m.toml:6:1: a second `otherwise` for the whole mission, the first is in line 3; keep one of them");
    EXPECT_EQ(rejected([] {
                  resolve_schedule(
                      {rest(flight::Phase::cruise, 1, 3), rest({}, 1, 5), rest(flight::Phase::cruise, 1, 6)},
                      durations);
              }),
              "m.toml:6:1: a second `otherwise` for cruise, the first is in line 3; keep one of them");
    EXPECT_THROW(resolve_schedule({}, durations), std::invalid_argument);
}

}  // namespace
}  // namespace flightwatt::mission
