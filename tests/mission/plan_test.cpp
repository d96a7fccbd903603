#include "mission/plan.h"

#include "base/atomic_file.h"
#include "base/units.h"
#include "helpers/paper_missions.h"
#include "mission/mission_file.h"
#include "mission/planned_mission_toml.h"
#include "mission/planning/planner.h"

#include <chrono>
#include <cmath>
#include <random>
#include <regex>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::paper_mission;
using test::paper_problem;

PlanningProblem paper_with_reserve(double reserve_soc_percent) {
    auto mission = paper_problem("plan");
    mission.setup.reserve_soc_percent = reserve_soc_percent;
    return mission;
}

/// Every schedule of a mission of few slots, simulated.
double best_simulated(const PlanningProblem& mission) {
    const auto planner = make_planning_tables(mission);
    const auto slots = make_slots(mission);
    std::vector<std::size_t> choices(slots.size(), 0);
    double best = -1.0;
    for (;;) {
        std::vector<ScheduleSegment> schedule;
        for (std::size_t i = 0; i < slots.size(); ++i) {
            schedule.push_back({slots[i], slots[i].fixed.value_or(planner.configurations[choices[i]])});
        }
        const auto summary = simulate(mission.setup, schedule, {1e3, 1.0}).summary;
        if (summary.feasible && *summary.final_soc_percent >= mission.setup.reserve_soc_percent) {
            best = std::max(best, *summary.utility);
        }
        std::size_t i = 0;
        while (i < choices.size() && (slots[i].fixed || ++choices[i] == planner.free_choices)) choices[i++] = 0;
        if (i == choices.size()) return best;
    }
}

TEST(Plan, ReachesThePapersAdaptiveScheduleWithItsReserve) {
    const auto adaptive = simulate(paper_mission("adaptive")).summary;
    const auto mission = paper_problem("plan");
    EXPECT_NEAR(mission.setup.reserve_soc_percent, *adaptive.final_soc_percent, 1e-9);
    EXPECT_LE(mission.setup.reserve_soc_percent, *adaptive.final_soc_percent);
    const auto plan = plan_mission(mission);
    ASSERT_TRUE(plan.plan.feasible);
    EXPECT_GE(*plan.summary.utility, *adaptive.utility - 1e-12);
    EXPECT_LE(plan.plan.utility_bound, *plan.summary.utility * 1.001);
    EXPECT_GE(*plan.summary.final_soc_percent, mission.setup.reserve_soc_percent);
}

TEST(Plan, SpendsWhatTheReserveLeaves) {
    double last = 0.0;
    for (const double reserve : {7.0, 5.0, 2.0, 0.0}) {
        const auto plan = plan_mission(paper_with_reserve(reserve));
        ASSERT_TRUE(plan.plan.feasible) << reserve;
        EXPECT_GE(*plan.summary.final_soc_percent, reserve);
        EXPECT_LE(*plan.summary.final_soc_percent, reserve + 0.05) << "what a slot could use is left";
        EXPECT_LE(plan.plan.utility_bound, *plan.summary.utility * 1.001) << reserve;
        EXPECT_NEAR(plan.plan.utility, *plan.summary.utility, 1e-9);
        EXPECT_GT(*plan.summary.utility, last);
        last = *plan.summary.utility;
        for (const auto& segment : plan.mission.schedule) {
            const bool middle = segment.phase == flight::Phase::cruise && segment.start_s == 240.0;
            EXPECT_EQ(segment.run == (compute::Configuration{{0, {32.0}}, {1, {448.0}}}), middle);
        }
    }
}

TEST(Plan, BeatsThePhasedScheduleWithWhatThatSpends) {
    const auto phased = simulate(paper_mission("phased")).summary;
    const auto plan = plan_mission(paper_with_reserve(*phased.final_soc_percent));
    ASSERT_TRUE(plan.plan.feasible);
    EXPECT_GT(*plan.summary.utility, *phased.utility * 1.3);  // it does not pay for long keys
}

TEST(Plan, IsTheBestOfAllSimulatedSchedules) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    int feasible = 0;
    for (int i = 0; i < 12; ++i) {
        auto mission = paper_problem("plan");
        mission.plan.slot_s = 100.0;
        mission.plan.choices[0].levels = {{5.8, 12.0 + 20.0 * uniform(random)}};
        mission.plan.choices[1].levels = {{32.0}};
        mission.setup.battery = {"", 3.6, i % 2 == 0 ? 0.0 : 0.01, 3.4};
        const double least = simulate(with_minimum_energy_schedule(mission)).summary.final_soc_percent.value();
        mission.setup.reserve_soc_percent = uniform(random) * least;
        const auto plan = plan_mission(mission);
        const double best = best_simulated(mission);
        ASSERT_EQ(plan.plan.feasible, best >= 0.0);
        if (!plan.plan.feasible) continue;
        ++feasible;
        EXPECT_NEAR(*plan.summary.utility, best, 1e-5 * best);
        EXPECT_GE(plan.plan.utility_bound, best - 1e-9);
    }
    EXPECT_EQ(feasible, 12);
}

TEST(Plan, KeepsTheDwellTime) {
    auto mission = paper_with_reserve(2.0);
    const double without = *plan_mission(mission).summary.utility;
    mission.plan.dwell_s = 70.0;
    const auto plan = plan_mission(mission);
    ASSERT_TRUE(plan.plan.feasible);
    EXPECT_LE(*plan.summary.utility, without + 1e-9);
    EXPECT_LE(plan.plan.utility_bound, *plan.summary.utility * 1.001);
    const auto& schedule = plan.mission.schedule;
    for (std::size_t i = 0; i < schedule.size();) {
        double lasts_s = 0.0;
        const auto& run = schedule[i].run;
        for (; i < schedule.size() && schedule[i].run == run; ++i) lasts_s += schedule[i].end_s - schedule[i].start_s;
        EXPECT_GE(lasts_s, 70.0 - 1e-9);
    }
}

TEST(Plan, MayBeMadeAnewInFlight) {
    const auto mission = paper_with_reserve(2.0);
    const auto planner = make_planning_tables(mission);
    const auto whole = plan_remaining(mission, planner, {0.0, 100.0, {}, 0.0}, 2.0);
    // Half way, with what the plan itself has left by then, the rest is as good.
    const auto flown = plan_mission(mission).mission;
    const auto curve = simulate(flown, {300.0}).curve;
    const auto at =
        std::find_if(curve.rows.begin(), curve.rows.end(), [](const auto& row) { return row.time_s == 300.0; });
    ASSERT_NE(at, curve.rows.end());
    const auto begin = std::chrono::steady_clock::now();
    const auto rest = plan_remaining(mission, planner, {300.0, at->soc_percent, {}, 0.0}, 2.0);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    RecordProperty("milliseconds", std::to_string(took.count()));
    ASSERT_TRUE(rest.feasible);
    EXPECT_GE(rest.final_soc_percent, 2.0 - 1e-9);
    EXPECT_EQ(rest.schedule.front().start_s, 300.0 - 28.0);
    EXPECT_EQ(rest.schedule.front().run, (compute::Configuration{{0, {32.0}}, {1, {448.0}}}));  // still fixed
    double utility_before = 0.0;
    const auto timeline = timeline_of(mission.setup.duration_s);
    for (const auto& s : whole.schedule) {
        const double starts_s = timeline.start_s[s.phase];
        const double before_s = std::min(starts_s + s.end_s, 300.0) - (starts_s + s.start_s);
        if (before_s > 0.0) utility_before += before_s * s.run.front().qos.front();
    }
    EXPECT_NEAR(utility_before + rest.utility * 388.0, whole.utility * 688.0, 1e-4 * whole.utility * 688.0);
    // With less, it does less; with too little, it does the least.
    EXPECT_LT(plan_remaining(mission, planner, {300.0, at->soc_percent - 1.0, {}, 0.0}, 2.0).utility, rest.utility);
    const auto lost = plan_remaining(mission, planner, {300.0, 20.0, {}, 0.0}, 2.0);
    EXPECT_FALSE(lost.feasible);
    EXPECT_EQ(lost.schedule.back().run.front().qos.front(), 5.8);
}

TEST(Plan, ReplansWithWhatRuns) {
    auto mission = paper_with_reserve(2.0);
    mission.plan.dwell_s = 60.0;
    const auto planner = make_planning_tables(mission);
    const compute::Configuration strong{{0, {32.0}}, {1, {32.0}}};
    const auto rest = plan_remaining(mission, planner, {28.0, 95.0, strong, 20.0}, 2.0);
    ASSERT_FALSE(rest.schedule.empty());
    EXPECT_EQ(rest.schedule.front().run, strong);
    EXPECT_GE(rest.schedule.front().end_s, 40.0);
}

TEST(Plan, AnswersWhereTheBatteryIsCharged) {
    auto mission = paper_with_reserve(0.0);
    mission.setup.initial_soc_percent = 100.0;
    mission.setup.mechanical->phases[flight::Phase::takeoff].fourier.a0_w = -60.0;  // down a slope: full at once
    EXPECT_THROW(plan_mission(mission), InputError) << "the mission does not permit it";
    mission.setup.may_charge = true;
    const auto plan = plan_mission(mission);
    ASSERT_TRUE(plan.plan.feasible);
    EXPECT_GE(*plan.summary.final_soc_percent, 0.0);
    EXPECT_TRUE(plan.summary.feasible);
    EXPECT_GE(plan.plan.utility_bound, *plan.summary.utility);
}

TEST(Plan, SaysThatItIsInfeasible) {
    const auto plan = plan_mission(paper_with_reserve(9.0));
    EXPECT_FALSE(plan.plan.feasible);
    EXPECT_NEAR(*plan.summary.final_soc_percent, 7.4306, 1e-4);
    auto weak = paper_with_reserve(0.0);
    weak.setup.battery = {"", 11.1, 0.5, 3.2};
    EXPECT_TRUE(plan_mission(weak).summary.undeliverable);
}

TEST(Plan, KeepsAMarginForFlightsThatDiffer) {
    auto mission = paper_with_reserve(2.0);
    mission.setup.uncertainty.level_sd_percent = {};
    EXPECT_THROW(plan_mission(mission, 0.95), InputError);
    for (const auto phase : flight::all_phases) {
        mission.setup.mechanical->phases[phase].flights = 5;
        mission.setup.mechanical->phases[phase].level_spread = {5, 0.2, 0.1, 20.0};
    }
    const auto plan = plan_mission(mission, 0.95);
    ASSERT_TRUE(plan.plan.feasible);
    // The phases uncorrelated: 0.2 W sqrt(1 + 1/5) for as long as each lasts, in points of 39.35 kJ; the 95 % quantile
    // of Student's t with 4 degrees of freedom, within four standard errors of 20,000 flights.
    const double sd_j = 0.2 * std::sqrt(1.2) * std::sqrt(28.0 * 28.0 + 600.0 * 600.0 + 60.0 * 60.0);
    EXPECT_NEAR(plan.margin_percent, 2.1318468 * sd_j / (3.416 * 3.2 * 36.0), 0.03);
    EXPECT_GE(*plan.summary.final_soc_percent, 2.0 + plan.margin_percent);
    EXPECT_NEAR(plan_mission(mission, 0.5).margin_percent, 0.0, 0.012);
    mission.setup.uncertainty.capacity_sd_percent = 3.0;
    const auto wider = plan_mission(mission, 0.95);
    EXPECT_GT(wider.margin_percent, 1.5 * plan.margin_percent) << "what is drawn counts, whatever it is";
    EXPECT_EQ(wider.sources->varied.size(), plan.sources->varied.size() + 1);
}

/// Of two components as strong, the one of less utility has no spread: without a margin it runs for nine tenths of the
/// time, which is more than the other one can with a margin of its own.
TEST(Plan, WithAProbabilityHasABoundThatHoldsForSchedulesWithASmallerMargin) {
    const auto folder = test::scratch_dir();
    for (const auto* name : {"a.csv", "b.csv"}) write_file_atomically(folder / name, "q,power_w\n0,0\n1,12\n");
    const auto problem = std::get<PlanningProblem>(parse_mission(
        "mechanical = 'none'\nduration_s = { takeoff = 0, cruise = 3600, landing = 0 }\nreserve_soc_percent = 10\n"
        "battery = { voltage_v = 10, resistance_ohm = 0, capacity_ah = 1.21 }\n"
        "components.a = { profile = 'a.csv', utility = { weight = 1 } }\n"
        "components.b = { profile = 'b.csv', utility = { weight = 0.95 } }\n"
        "plan.slot_s = 360\nuncertainty.compute_sd_percent.a = 30\n",
        folder / "m.toml", {.allow_unplanned = true}));
    const auto plan = plan_mission(problem, 0.95);
    ASSERT_TRUE(plan.plan.feasible);
    EXPECT_GT(plan.margin_percent, 1.0);
    constexpr double of_b_alone = 0.95 * 0.9;
    EXPECT_GE(plan.plan.utility_bound, of_b_alone);
    EXPECT_NE(summary_with_origin(plan).schedule, ScheduleOrigin::optimal);
}

TEST(Plan, IsWrittenAsAMission) {
    const auto path = test::source_dir() / "missions" / "paper" / "plan.toml";
    auto mission = paper_with_reserve(2.0);
    mission.plan.choices[1].may_be_off = true;
    const auto plan = plan_mission(mission);
    const auto folder = test::scratch_dir();
    const auto text =
        planned_mission_toml(read_file(path), path, plan.mission.setup.compute, plan.mission.schedule, folder).text;
    const auto again = std::get<Mission>(parse_mission(text, folder / "planned.toml"));
    EXPECT_EQ(again.setup.name, "plan");
    EXPECT_EQ(again.setup.reserve_soc_percent, paper_problem("plan").setup.reserve_soc_percent);
    const auto summary = simulate(again).summary;
    EXPECT_EQ(summary.final_soc_percent, plan.summary.final_soc_percent);
    EXPECT_EQ(summary.utility, plan.summary.utility);
}

/// A mission of a .plan has its airspeed from there: as .waypoints it had none, and could not be read.
TEST(Plan, OfAPackHasTheAirspeedThatItsFileDoesNotState) {
    const auto folder = test::scratch_dir();
    for (const auto& [stated, expected] : {std::pair{"", "12.5"}, {"airspeed_m_per_s = 14.5\n", "14.5"}}) {
        const auto text = fmt::format(
            "mechanical = 'm.toml'\nbattery = 'b.toml'\n[path]\nwaypoints = 'a.plan'\n{}[packs]\ncount = 2\n", stated);
        const PlannedPack pack{1, "m, pack 1", "pack-1.waypoints", {}, 12.5};
        const auto written = planned_mission_toml(text, folder / "m.toml", {}, {}, folder, {}, pack).text;
        EXPECT_NE(written.find(fmt::format("airspeed_m_per_s = {}\n", expected)), std::string::npos) << written;
        const PlannedPack of_blocks{1, "m, pack 1", "pack-1.xml", {"Flight"}, 12.5};
        const auto blocks = planned_mission_toml(text, folder / "m.toml", {}, {}, folder, {}, of_blocks).text;
        EXPECT_NE(blocks.find("airspeed_m_per_s = 12.5\n"), std::string::npos) << "a flight plan has no airspeeds";
    }
}

TEST(Plan, NamesTheFilesOfItsPathFromWhereItIsWritten) {
    const auto folder = test::scratch_dir();
    const auto written = planned_mission_toml(
        "mechanical = 'm.toml'\nbattery = 'b.toml'\n[path]\nwaypoints = 'a.plan'\nterrain = 'srtm'\n",
        folder / "m.toml", {}, {}, folder / "planned");
    EXPECT_NE(written.text.find("waypoints = \"../a.plan\"\nterrain = \"../srtm\"\n"), std::string::npos)
        << written.text;
}

struct WrittenPlan {
    MissionPlan plan;
    std::string text;
    bool lost_comments = false;
};

/// Plans a mission whose text is in missions/paper, and writes it into the folder of the sources.
WrittenPlan planned_and_written(const std::string& text) {
    const auto path = test::source_dir() / "missions" / "paper" / "plan.toml";
    const auto problem = parse_mission(text, path, {.allow_unplanned = true});
    const auto plan = plan_mission(std::get<PlanningProblem>(problem));
    const auto written =
        planned_mission_toml(text, path, plan.mission.setup.compute, plan.mission.schedule, test::source_dir());
    return {plan, written.text, written.lost_comments};
}

TEST(Plan, KeepsCommentsAndNumbersOfTheFileThatItComesFrom) {
    const std::string text =
        "# A survey of the north field.\n"
        "name = 'plan'   # in single quotes\n"
        "mechanical = \"../../fits/mechanical/opterra-table1.toml\"\n"
        "battery = '../../fits/battery/paper.toml'   # 9.9, not 9.9000000000000004\n"
        "cutoff_voltage_v = 0.10\n"
        "reserve_soc_percent = 2\n"
        "\n"
        "# What is planned, and how.\n"
        "[plan]\n"
        "slot_s = 60\n"
        "# of the plan\n"
        "levels = { detection = { fps = [5.8, 10] } }\n"
        "\n"
        "# The camera.\n"
        "[components.detection]\n"
        "profile = \"../../fits/compute/tx2-detection.csv\"\n"
        "utility = { parameter = \"fps\", weight = 1.0 }\n"
        "\n"
        "# decided in flight\n"
        "[policy]\n"
        "kind = \"static\"\n"
        "\n"
        "# An afterword.\n";
    const auto [plan, written, lost_comments] = planned_and_written(text);
    EXPECT_FALSE(lost_comments);
    const std::string kept =
        "# A survey of the north field.\n"
        "format = 1\n"
        "name = 'plan'   # in single quotes\n"
        "mechanical = \"fits/mechanical/opterra-table1.toml\"\n"
        "battery = \"fits/battery/paper.toml\"   # 9.9, not 9.9000000000000004\n"
        "cutoff_voltage_v = 0.10\n"
        "reserve_soc_percent = 2\n"
        "\n"
        "# The camera.\n"
        "[components.detection]\n"
        "profile = \"fits/compute/tx2-detection.csv\"\n"
        "utility = { parameter = \"fps\", weight = 1.0 }\n"
        "\n"
        "# An afterword.\n"
        "\n[[schedule]]\n";
    EXPECT_EQ(written.substr(0, kept.size()), kept);
    EXPECT_EQ(written.find("[plan]"), std::string::npos);
    EXPECT_NO_THROW(parse_mission(written, test::source_dir() / "planned.toml"));
    const auto of_windows = "\xEF\xBB\xBF" + std::regex_replace(text, std::regex("\n"), "\r\n");
    EXPECT_EQ(planned_and_written(of_windows).text, written);
}

TEST(Plan, IsWrittenWhateverWayTheFileIsWritten) {
    const std::string text =
        "mechanical = \"../../fits/mechanical/opterra-table1.toml\"\nbattery = '../../fits/battery/paper.toml'\n"
        "plan = { slot_s = 60, levels = { detection = { fps = [\n  5.8,\n  10 ] } } }\n"
        "components = { detection = { profile = \"\"\"../../fits/compute/tx2-detection.csv\"\"\", "
        "utility = { parameter = \"fps\" } } }\n";
    const auto [plan, written, lost_comments] = planned_and_written(text);
    EXPECT_FALSE(lost_comments) << "it has no comments";
    EXPECT_TRUE(planned_and_written("# A survey.\n" + text).lost_comments);
    const auto again = std::get<Mission>(parse_mission(written, test::source_dir() / "planned.toml"));
    EXPECT_EQ(simulate(again).summary.utility, plan.summary.utility);
}

TEST(Planner, DropsWhatIsDominated) {
    auto mission = paper_problem("plan");
    EXPECT_EQ(make_planning_tables(mission).free_choices, 4U);  // longer keys have no utility here
    mission.setup.utilities[1]->weight = 0.01;
    EXPECT_GT(make_planning_tables(mission).free_choices, 4U);
    mission.setup.utilities.assign(2, std::nullopt);
    EXPECT_THROW(make_planning_tables(mission), InputError);
}

TEST(Planner, CutsSlotsAtFixedSegmentsAndPhases) {
    auto mission = paper_problem("plan");
    mission.plan.slot_s = 50.0;
    const auto slots = make_slots(mission);
    std::vector<std::pair<double, double>> times;
    for (const auto& slot : slots) times.emplace_back(slot.start_s, slot.end_s);
    EXPECT_EQ(times, (std::vector<std::pair<double, double>>{{0, 28},
                                                             {0, 50},
                                                             {50, 100},
                                                             {100, 150},
                                                             {150, 200},
                                                             {200, 240},
                                                             {240, 360},
                                                             {360, 400},
                                                             {400, 450},
                                                             {450, 500},
                                                             {500, 550},
                                                             {550, 600},
                                                             {0, 50},
                                                             {50, 60}}));
    EXPECT_TRUE(slots[6].fixed);
    EXPECT_EQ(make_slots(mission, 28.0 + 250.0).front().start_s, 250.0);
    EXPECT_TRUE(make_slots(mission, 688.0).empty());
}

}  // namespace
}  // namespace flightwatt::mission
