#include "report/sections/missions_section.h"

#include "helpers/paper_missions.h"
#include "report/figures/mission_figures.h"
#include "report/sections/page_data.h"

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

TEST(QosMap, IsThePapersGridAndEndsWhereTheMissionsEnd) {
    const auto map = qos_map(paper_mission("invariant-10fps-240bit").setup);
    ASSERT_TRUE(map);
    EXPECT_EQ(map->x.nodes.size(), 10U);
    EXPECT_EQ(map->y.nodes.size(), 13U);
    const auto at = [&](double fps, double key_bits) {
        const auto i = std::find(map->x.nodes.begin(), map->x.nodes.end(), fps) - map->x.nodes.begin();
        const auto j = std::find(map->y.nodes.begin(), map->y.nodes.end(), key_bits) - map->y.nodes.begin();
        return map->at(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
    };
    for (const auto* name : {"invariant-10fps-240bit", "invariant-5.8fps-32bit", "invariant-32fps-448bit"}) {
        const auto mission = paper_mission(name);
        const auto& run = mission.schedule.front().run;
        EXPECT_NEAR(at(run[0].qos[0], run[1].qos[0]), *simulate(mission).summary.final_soc_percent, 1e-4) << name;
    }
}

TEST(QosMap, NeedsTwoParameters) {
    EXPECT_FALSE(qos_map(paper_mission("mechanical-only").setup));
    EXPECT_EQ(map_key(paper_mission("phased").setup), map_key(paper_mission("adaptive").setup));
    EXPECT_NE(map_key(paper_mission("phased").setup), map_key(paper_mission("computing-only").setup));
}

TEST(MissionSections, HaveEachModelAndSoftwareOnce) {
    const auto sections = mission_sections(simulated({"phased", "adaptive", "computing-only"}));
    std::vector<std::string> figures;
    for (const auto& section : sections) {
        for (const auto& figure : section.figures) figures.push_back(figure.id);
    }
    EXPECT_THAT(figures, testing::UnorderedElementsAre("mission-model-1-curves", "profile-1", "schedules-soc",
                                                       "quality-1", "quality-2"));
}

TEST(QosGrid, HasTheProfiledValuesWithTheirCurvesAndProbabilities) {
    const auto mission = paper_mission("invariant-10fps-240bit");
    const auto grid = qos_grid(mission.setup);
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->x.nodes, (std::vector<double>{5.8, 10.0, 25.0, 32.0}));
    ASSERT_EQ(grid->cells.size(), grid->x.nodes.size() * grid->y.nodes.size());
    const auto row = std::ranges::find(grid->y.nodes, 240.0) - grid->y.nodes.begin();
    const auto& cell = grid->cells[static_cast<std::size_t>(row) * grid->x.nodes.size() + 1];
    EXPECT_NEAR(*cell.simulation.summary.final_soc_percent, *simulate(mission).summary.final_soc_percent, 1e-3);
    EXPECT_GE(cell.simulation.curve.rows.size(), 40U);
    ASSERT_TRUE(cell.probability);
    EXPECT_LT(grid->cells.back().probability, *grid->cells.front().probability);
    EXPECT_FALSE(qos_grid(paper_mission("mechanical-only").setup));
}

TEST(MissionSections, AnswerFirstAndFoldStatistics) {
    const auto missions = simulated({"phased", "computing-only"});
    std::vector<std::string> open;
    for (const auto& section : mission_sections(missions))
        if (section.place == SectionPlace::page) open.push_back(section.id);
    EXPECT_THAT(open, testing::ElementsAre("curves", "quality-of-service"));
}

TEST(MissionSections, DrawTheSchedulesFromTheDataOfThePage) {
    const auto missions = simulated({"phased", "computing-only"});
    for (const auto& section : mission_sections(missions)) {
        if (section.id != "schedules") continue;
        const auto& panels = section.figures.at(0).spec["vconcat"];
        EXPECT_EQ(panels[0]["data"]["values"], missions_data(missions));
        EXPECT_EQ(panels[0]["layer"][0]["data"]["values"].size(), 3U) << "both have the same phases";
        EXPECT_THAT(panels[1]["data"]["values"].get<std::string>(), HasSubstr("computing-only,take-off,"));
    }
}

TEST(MissionSections, NameWhatIsDrawnOnce) {
    std::string html;
    for (const auto& section : mission_sections(simulated({"phased", "adaptive"}))) html += section.html;
    EXPECT_THAT(html, HasSubstr("phased, adaptive: drawn: "));
}

TEST(MissionSections, ShowWhereTheBatteryCannotDeliver) {
    auto weak = paper_mission("phased");
    weak.setup.battery.resistance_ohm = 1.0;
    const auto sections = mission_sections(simulate_for_report({weak}));
    bool printed = false;
    for (const auto& section : sections) printed = printed || section.html.find("cannot deliver") != std::string::npos;
    EXPECT_TRUE(printed);
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

TEST(ReplaySection, ShowsTablesAndSentences) {
    const std::vector replays{planned_replay("one"), planned_replay("two")};
    const auto section = replay_section(replays);
    EXPECT_THAT(section.html, HasSubstr("better on 2"));
    EXPECT_THAT(section.html, HasSubstr("it keeps the reserve on 2"));
    EXPECT_THAT(section.html, HasSubstr("&lt;below&gt;"));
    EXPECT_THAT(section.html, HasSubstr("were not aboard"));
}

TEST(ReplaySection, ComparesNothingForAGivenScheduleAlone) {
    auto replay = planned_replay("one");
    replay.schedules = {replayed(mission::ScheduleMethod::given, 15.0, 30.0)};
    const std::vector replays{replay};
    const auto section = replay_section(replays);
    EXPECT_THAT(section.html, HasSubstr("given"));
    EXPECT_THAT(section.html, Not(HasSubstr("replanning in flight against")));
}

TEST(PacksSection, HasARowForEachFlight) {
    auto mission = paper_mission("invariant-10fps-240bit");
    mission.setup.packs = mission::Packs{.count = 3, .change_s = 120.0};
    mission.setup.reserve_soc_percent = 40.0;
    const auto section = packs_section(std::vector{fly_packs(mission)});
    for (const auto* text : {"2 of 3 packs", "with 2 min on the ground", "invariant-10fps-240bit, pack 1",
                             "invariant-10fps-240bit, pack 2", "at most"})
        EXPECT_THAT(section.html, HasSubstr(text));
}

}  // namespace
}  // namespace flightwatt::report
