#include "base/error.h"
#include "helpers/paper_missions.h"
#include "report/figures/mission_figures.h"
#include "report/sections/sections.h"

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
    const auto sections = mission_sections(simulated({"phased", "adaptive", "computing-only"}), {});
    std::vector<std::string> figures;
    for (const auto& section : sections) {
        for (const auto& figure : section.figures) figures.push_back(figure.id);
    }
    EXPECT_THAT(figures,
                testing::ElementsAre("mission-model-1-curves", "profile-1", "schedules-soc", "quality-1", "quality-2"));
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
    for (const auto& section : mission_sections(missions, {}))
        if (section.place == SectionPlace::page) open.push_back(section.id);
    EXPECT_THAT(open, testing::ElementsAre("curves", "quality-of-service"));
}

TEST(MissionSections, NameWhatIsDrawnOnce) {
    std::string html;
    for (const auto& section : mission_sections(simulated({"phased", "adaptive"}), {})) html += section.html;
    EXPECT_THAT(html, HasSubstr("phased, adaptive: drawn: "));
}

TEST(MissionSections, ShowWhereTheBatteryCannotDeliver) {
    auto weak = paper_mission("phased");
    weak.setup.battery.resistance_ohm = 1.0;
    const auto sections = mission_sections(simulate_for_report({weak}), {});
    bool said = false;
    for (const auto& section : sections) said = said || section.html.find("cannot deliver") != std::string::npos;
    EXPECT_TRUE(said);
}

TEST(PublishedFigures, StandBesideOurs) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto published = read_published_figures(test::shared_dir() / "paper");
    EXPECT_EQ(published.soc.size(), 6U);
    EXPECT_EQ(published.soc_cells.size(), 108U);
    std::string captions;
    for (const auto& section : mission_sections(simulated({"computing-only", "phased"}), published)) {
        for (const auto& figure : section.figures) captions += figure.caption;
    }
    EXPECT_THAT(captions, HasSubstr("RMS difference take-off 0.009 W, cruise 0.005 W, landing 0.019 W"));
    EXPECT_THAT(captions, HasSubstr("Points: the paper's Fig. 3, digitised."));
    EXPECT_THAT(captions, HasSubstr("RMS difference over 108 cells 0.04 points"));
}

TEST(PublishedFigures, NameWhatIsMissing) { EXPECT_THROW(read_published_figures(test::scratch_dir()), InputError); }

mission::MissionVariant paper(const std::string& name) {
    return mission::read_mission(test::paper_mission_path(name), {true, std::nullopt});
}

TEST(PlanSection, IsEmptyWhereNothingWasPlanned) {
    EXPECT_TRUE(plan_section(simulate_for_report({paper("phased")})).figures.empty());
}

TEST(PlanSection, ShowsThePlan) {
    const auto missions = simulate_for_report({paper("plan"), paper("phased")});
    ASSERT_TRUE(missions[0].planned);
    EXPECT_TRUE(missions[0].planned->feasible);
    EXPECT_FALSE(missions[1].planned);
    const auto section = plan_section(missions);
    ASSERT_EQ(section.figures.size(), 1U);
    EXPECT_EQ(section.figures[0].id, "plan-1-strip");
    EXPECT_THAT(section.html, HasSubstr("proven bound"));
    EXPECT_THAT(section.html, HasSubstr("data-label=\"schedule\">optimal</td>"));
}

TEST(PlanSection, SaysWhereNoPlanKeepsTheReserve) {
    auto mission = test::paper_problem("plan");
    mission.setup.reserve_soc_percent = 60.0;
    const auto missions = simulate_for_report({mission});
    EXPECT_FALSE(missions[0].planned->feasible);
    const auto html = plan_section(missions).html;
    EXPECT_THAT(html, HasSubstr("No schedule that keeps the reserve was found"));
    EXPECT_THAT(html, HasSubstr(">no</td>"));
}

TEST(RunningTimes, JoinEqualNeighboursOverPhases) {
    const auto mission = test::paper_mission("adaptive");
    const auto times = run_intervals(mission);
    ASSERT_EQ(times.size(), 6U) << "two components: little, much, little";
    EXPECT_EQ(times[0].start_s, 0.0);
    EXPECT_NEAR(times[2].end_s - times[2].start_s, 120.0, 1e-9);
    EXPECT_EQ(describe_qos(mission.setup.compute.components[times[2].component], times[2].qos), "fps 32");
    EXPECT_NEAR(times[4].end_s, 688.0, 1.0);
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

}  // namespace
}  // namespace flightwatt::report
