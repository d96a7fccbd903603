#include "report/document/missions_document.h"

#include "helpers/paper_missions.h"
#include "helpers/test_paths.h"
#include "mission/mission_file.h"
#include "report/document/mission_card.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using test::paper_mission;

using testing::HasSubstr;

std::vector<SimulatedMission> simulated(const std::vector<std::string>& names) {
    std::vector<mission::MissionVariant> missions;
    for (const auto& name : names) missions.push_back(paper_mission(name));
    return simulate_for_report(missions);
}

Findings findings_of(std::vector<SimulatedMission> missions) {
    Findings findings;
    findings.missions = std::move(missions);
    findings.assessments.resize(findings.missions.size());
    return findings;
}

Findings findings_of_files(const std::vector<std::string>& names) { return findings_of(simulated(names)); }

TEST(MissionsDocument, HasCardCurveBandAndScheduleOfEachMission) {
    LatexTables tables;
    const auto findings = findings_of_files({"invariant-32fps-448bit", "phased", "computing-only"});
    const auto json = missions_json(findings, tables);
    ASSERT_EQ(json.size(), 3U);
    EXPECT_EQ(json[0]["outcome"], "fails");
    EXPECT_TRUE(json[0]["landing_soc_percent"].is_null()) << "it runs empty";
    const auto& phased = json[1];
    EXPECT_EQ(phased["title"], "phased");
    EXPECT_EQ(phased["outcome"], "may-miss");
    EXPECT_EQ(phased["summary"]["mission"], "phased") << "as flightwatt simulate prints it";
    EXPECT_EQ(phased["curve"]["time_s"].size(), phased["curve"]["soc_percent"].size());
    EXPECT_EQ(phased["band"]["low_percent"].size(), phased["band"]["high_percent"].size());
    EXPECT_EQ(phased["phases"].size(), 3U);
    EXPECT_EQ(phased["schedule"][0]["phase"], "takeoff");
    EXPECT_EQ(phased["card"]["aim"], "the battery lasts");
    EXPECT_TRUE(phased["path"].is_null());
    EXPECT_EQ(json[2]["rank"], 1) << "most charge left";
    EXPECT_THAT(tables.text, HasSubstr("\\label{tab:missions}"));
}

TEST(MissionsDocument, DrawsThePathWithTheChargeAlongIt) {
    const auto file = test::source_dir() / "missions/synthetic/survey-path.toml";
    LatexTables tables;
    const auto path = missions_json(
        findings_of(simulate_for_report({mission::read_mission(file, {true, std::nullopt})})), tables)[0]["path"];
    ASSERT_TRUE(path.is_object());
    EXPECT_GT(path["elements"].size(), 2U);
    for (const auto* column : {"east_m", "north_m", "soc_percent"})
        EXPECT_EQ(path[column].size(), path["time_s"].size()) << column;
    EXPECT_EQ(path["east_m"][0], 0.0);
    EXPECT_LT(path["soc_percent"].back().get<double>(), path["soc_percent"].front().get<double>());
}

TEST(MissionsHeadline, CountsOutcomesTheWorstFirst) {
    EXPECT_EQ(missions_headline(findings_of_files({"invariant-32fps-448bit", "phased", "computing-only"})),
              "One of three missions runs empty");
    auto both = findings_of_files({"computing-only", "computing-only"});
    EXPECT_EQ(missions_headline(both), "Both missions land as planned");
    both.missions.front().simulation.summary.uncertain = {"the plan is not flown as it is"};
    EXPECT_EQ(missions_headline(both), "One of two missions is uncertain");
    EXPECT_EQ(missions_headline({}), "");
}

TEST(MissionsDocument, HasEachModelAndSoftwareOnce) {
    const auto missions = simulated({"phased", "adaptive", "computing-only"});
    EXPECT_EQ(other_models(missions, {}).size(), 1U);
    EXPECT_TRUE(other_models(missions, other_models(missions, {})).empty());
    const auto software = software_json(missions);
    ASSERT_EQ(software.size(), 1U);
    EXPECT_EQ(software[0]["missions"].size(), 3U);
    const auto grids = quality_json(missions, false);
    ASSERT_EQ(grids.size(), 2U);
    EXPECT_EQ(grids[0]["missions"], (Json{0, 1}));
    EXPECT_EQ(grids[0]["cells"].size(), grids[0]["x"].size() * grids[0]["y"].size());
    EXPECT_FALSE(grids[0].contains("map"));
    const auto map = quality_json(missions, true)[0]["map"];
    EXPECT_EQ(map["soc_percent"].size(), map["x"].size() * map["y"].size());
}

TEST(MissionsDocument, NamesWhatIsDrawnOnce) {
    const auto sources = schedule_notes(simulated({"phased", "adaptive"}))["sources"];
    ASSERT_EQ(sources.size(), 1U);
    EXPECT_EQ(sources[0]["missions"], (Json{"phased", "adaptive"}));
    EXPECT_THAT(sources[0]["text"].get<std::string>(), testing::StartsWith("drawn: "));
}

TEST(MissionsDocument, ShowsWhereTheBatteryCannotDeliver) {
    auto weak = paper_mission("phased");
    weak.setup.battery.resistance_ohm = 1.0;
    LatexTables tables;
    const auto json = missions_json(findings_of(simulate_for_report({weak})), tables);
    EXPECT_EQ(json[0]["card"]["words"], "lacks power");
    EXPECT_TRUE(json[0]["summary"]["final_soc_percent"].is_null());
}

using testing::Not;

mission::ReplayedSchedule replayed(mission::ScheduleMethod way, double soc_percent, double utility) {
    mission::ReplayedSchedule schedule;
    schedule.way = way;
    schedule.summary.final_soc_percent = soc_percent;
    schedule.summary.utility = utility;
    schedule.summary.feasible = true;
    schedule.summary.reserve_soc_percent = 20.0;
    schedule.summary.keeps_reserve = soc_percent >= 20.0;
    return schedule;
}

mission::Replay planned_replay(const std::string& flight) {
    mission::Replay replay;
    replay.flight = flight;
    replay.mission = "survey";
    replay.schedules = {replayed(mission::ScheduleMethod::planned, 15.0, 30.0),
                        replayed(mission::ScheduleMethod::replanned, 21.0, 25.0),
                        replayed(mission::ScheduleMethod::hindsight, 20.0, 26.0)};
    replay.notes = {"power measured <below> 0"};
    return replay;
}

TEST(ReplayDocument, ShowsTablesAndSentences) {
    const std::vector replays{planned_replay("one"), planned_replay("two")};
    LatexTables tables;
    const auto text = replay_json(replays, tables).dump();
    for (const auto* part : {"better on 2", "it keeps the reserve on 2", "<below>", "were not aboard"})
        EXPECT_THAT(text, HasSubstr(part));
    EXPECT_THAT(tables.text, HasSubstr("\\label{tab:replay-basis}"));
}

TEST(ReplayDocument, ComparesNothingForAGivenScheduleAlone) {
    auto replay = planned_replay("one");
    replay.schedules = {replayed(mission::ScheduleMethod::given, 15.0, 30.0)};
    const std::vector replays{replay};
    LatexTables tables;
    const auto text = replay_json(replays, tables).dump();
    EXPECT_THAT(text, HasSubstr("given"));
    EXPECT_THAT(text, Not(HasSubstr("replanning in flight against")));
}

TEST(PacksDocument, HasARowForEachFlight) {
    auto mission = paper_mission("invariant-10fps-240bit");
    mission.setup.packs = mission::Packs{.count = 3, .change_s = 120.0};
    mission.setup.reserve_soc_percent = 40.0;
    LatexTables tables;
    const auto packs = packs_json(std::vector{fly_packs(mission)}, tables).dump();
    for (const auto* text : {"2 of 3 packs", "with 2 min on the ground", "invariant-10fps-240bit, pack 1",
                             "invariant-10fps-240bit, pack 2"})
        EXPECT_THAT(packs, HasSubstr(text));
    EXPECT_THAT(tables.text, HasSubstr("at most"));
}

}  // namespace
}  // namespace flightwatt::report
