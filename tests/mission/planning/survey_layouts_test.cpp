#include "mission/planning/survey_layouts.h"

#include "helpers/rejected.h"
#include "helpers/replayed_flights.h"
#include "helpers/survey_missions.h"
#include "mission/planned_mission_toml.h"
#include "mission/prepared_mission.h"
#include "mission/replay.h"

#include <array>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

/// A survey over the made-up field, with more keys of its path.
PlanningProblem field(const std::string& path, const std::string& more = "", double heading_deg = 20.0) {
    const auto text = R"(mechanical = "fits/mechanical/synthetic-wing.toml"
battery = "fits/battery/synthetic-3s.toml"
capacity_ah = 1.2
reserve_soc_percent = 20
[components.detection]
profile = "fits/compute/tx2-detection.csv"
utility = { parameter = "fps" }
[plan]
slot_s = 30
[path]
area = "missions/synthetic/field.geojson"
airspeed_m_per_s = 13
swath_m = 60
utility = { weight = 40 }
)" + fmt::format("heading_deg = {}\n", heading_deg) +
                      path + more;
    return std::get<PlanningProblem>(parse_mission(text, test::source_dir() / "field.toml", {.allow_unplanned = true}));
}

const std::string two_blocks = "spacing_m = { min = 40, max = 100, steps = 4, blocks = 2 }  # chosen\n";
const std::string adaptive = "[policy]\nkind = \"adaptive\"\nmechanical_sd_percent = 0\n";

TEST(SurveyLayouts, AreAllCombinations) {
    const SurveyChoices choices{{0.0, 90.0}, {{30.0}, {20.0}, {10.0}}, 2, {}};
    const auto layouts = all_layouts(choices);
    ASSERT_EQ(layouts.size(), 18U);
    EXPECT_EQ(layouts.front(), (path::SurveyLayout{0.0, {{30.0, 0.5}, {30.0, 1.0}}}));
    EXPECT_EQ(layouts.back(), (path::SurveyLayout{90.0, {{10.0, 0.5}, {10.0, 1.0}}}));
}

TEST(SurveyLayouts, KeepTheLinesThatAreFlown) {
    const SurveyChoices choices{{0.0}, {{30.0}, {20.0}}, 2, {}};
    const SurveyCoverage survey{{0.0, {{30.0, 0.5}, {20.0, 1.0}}},
                                true,
                                {{5.0, 20.0, 0.2}, {20.0, 40.0, 0.5}, {40.0, 60.0, 0.75}, {60.0, 80.0, 1.0}}};
    EXPECT_EQ(remaining_layouts(choices, survey, 0.0).size(), 4U);
    EXPECT_TRUE(remaining_layouts(choices, survey, 4.0).empty()) << "on the way to the first line";
    const auto in_first = remaining_layouts(choices, survey, 6.0);
    ASSERT_EQ(in_first.size(), 4U);
    EXPECT_EQ(in_first[2], (path::SurveyLayout{0.0, {{30.0, 0.2}, {20.0, 0.5}, {30.0, 1.0}}}));
    const auto in_second = remaining_layouts(choices, survey, 20.0);
    ASSERT_EQ(in_second.size(), 2U);
    EXPECT_EQ(in_second[1], (path::SurveyLayout{0.0, {{30.0, 0.5}, {20.0, 1.0}}}));
    EXPECT_EQ(remaining_layouts(choices, survey, 45.0)[0],
              (path::SurveyLayout{0.0, {{30.0, 0.5}, {20.0, 0.75}, {30.0, 1.0}}}));
    EXPECT_TRUE(remaining_layouts(choices, survey, 70.0).empty()) << "the last line";
}

/// The path up to the end of the line under way does not change with what is flown behind it, from either side.
TEST(SurveyLayouts, DoNotChangeWhatIsFlown) {
    for (const double heading : {20.0, 200.0}) {
        const auto problem = field(two_blocks, "", heading);
        const auto flown = problem.survey->mission_with({heading, {{60.0, 0.5}, {40.0, 1.0}}});
        const auto& lines = flown.setup.survey->lines;
        ASSERT_GE(lines.size(), 7U);
        const double now_s = 0.5 * (lines[1].start_s + lines[1].end_s);
        const auto& pieces = *flown.setup.cruise_path->pieces;
        const auto layouts = remaining_layouts(*problem.survey, *flown.setup.survey, now_s);
        ASSERT_EQ(layouts.size(), 16U);
        for (const auto& layout : layouts) {
            const auto other = problem.survey->mission_with(layout);
            const auto& changed = *other.setup.cruise_path->pieces;
            EXPECT_NEAR(other.setup.survey->lines[1].end_s, lines[1].end_s, 1e-6) << heading;
            for (std::size_t i = 0; i < pieces.time_s.size() && pieces.time_s[i] <= lines[1].end_s; ++i) {
                EXPECT_NEAR(changed.time_s[i], pieces.time_s[i], 1e-6);
                EXPECT_NEAR(changed.energy_j[i], pieces.energy_j[i], 1e-4);
            }
        }
    }
}

/// Of survey_missions.h, next to all schedules on all lines; studies/planning takes many.
class Surveys : public testing::TestWithParam<unsigned> {};

TEST_P(Surveys, HaveNoBetterPlanThanTheJointOne) {
    const auto made = test::survey_mission(GetParam());
    const auto plan = plan_mission(made.problem());
    const auto best = made.max_utility(plan.plan.feasible ? plan.summary.utility : std::nullopt);
    ASSERT_EQ(plan.plan.feasible, best.has_value());
    if (!best) return;
    EXPECT_TRUE(plan.summary.keeps_reserve);
    EXPECT_GE(*plan.summary.utility, *best * (1.0 - 1e-3));
    EXPECT_GE(plan.plan.utility_bound, *best * (1.0 - 1e-9));
    EXPECT_LE(plan.plan.utility_bound, *plan.summary.utility * (1.0 + 1e-3));
    EXPECT_TRUE(plan.plan.bound_is_proven);
}

INSTANTIATE_TEST_SUITE_P(Generated, Surveys, testing::Range(1U, 9U));

TEST(SurveyPlan, IsWrittenWithItsLines) {
    const auto problem = field(two_blocks);
    const auto plan = plan_mission(problem);
    ASSERT_TRUE(plan.plan.feasible);
    const auto& setup = plan.mission.setup;
    const auto folder = test::source_dir();
    const std::string text =
        "# kept\nmechanical = \"none\"\n[path]  # p\nspacing_m = { min = 1, max = 2 }  # s\n"
        "heading_deg = 4  # h\n";
    const auto written = [&](const path::SurveyLayout& layout) {
        return planned_mission_toml(text, folder / "m.toml", setup.compute, {}, folder, layout);
    };
    EXPECT_EQ(written({4.0, {{25.0}}}).text,
              "# kept\nformat = 1\nmechanical = \"none\"\n[path]  # p\nspacing_m = 25.0  # s\nheading_deg = 4  # h\n");
    EXPECT_EQ(
        written({4.0, {{25.0, 0.5}, {30.0, 1.0, 12.0}}}).text,
        "# kept\nformat = 1\nmechanical = \"none\"\n[path]  # p\nheading_deg = 4  # h\n\n[[path.strip]]\nto = 0.5\n"
        "spacing_m = 25.0\n\n[[path.strip]]\nto = 1.0\nspacing_m = 30.0\nairspeed_m_per_s = 12.0\n");
    std::string strips;
    for (const auto& strip : setup.survey->layout.strips)
        strips += fmt::format("[[path.strip]]\nto = {}\nspacing_m = {}\n", strip.to, strip.spacing_m);
    const auto stated = plan_mission(field(strips));
    EXPECT_NEAR(*stated.summary.utility, *plan.summary.utility, 1e-6) << "stated lines have their utility";
    EXPECT_FALSE(stated.summary.lines);
    EXPECT_EQ(plan.summary.lines, setup.survey->layout);
}

TEST(SurveyPlan, KeepsTheReserveWithAProbability) {
    auto problem = field(two_blocks);
    const auto plan = plan_mission(problem);
    const auto sure = plan_mission(problem, 0.95);
    ASSERT_TRUE(sure.plan.feasible);
    EXPECT_GT(sure.margin_percent, 0.5);
    EXPECT_GE(*sure.summary.final_soc_percent, 20.0 + sure.margin_percent - 0.01);
    EXPECT_LE(*sure.summary.utility, *plan.summary.utility);
    EXPECT_GE(sure.plan.utility_bound, *sure.summary.utility);
}

/// Turns between lines 20 m apart do not fit, between 100 m they do.
TEST(SurveyPlan, HasTheNotesOfItsLinesAndNotOfThoseThatWereReadFirst) {
    for (const auto& [chosen, stated] : {std::pair{"spacing_m = { levels = [20, 100] }\n", "spacing_m = 20\n"},
                                         std::pair{"spacing_m = { levels = [20, 100] }\n", "spacing_m = 100\n"}}) {
        const auto lines = field(stated).setup;
        const auto planned = field(chosen).survey->mission_with(lines.survey->layout).setup;
        EXPECT_EQ(planned.notes, lines.notes);
        EXPECT_EQ(planned.uncertain, lines.uncertain);
    }
    EXPECT_NE(field("spacing_m = 20\n").setup.notes, field("spacing_m = 100\n").setup.notes);
}

TEST(SurveyPlan, NamesTheWaysThatCannotBeFlown) {
    for (const auto* speeds : {"13, 5", "5, 13"}) {
        const auto text = fmt::format(R"(mechanical = "fits/mechanical/synthetic-wing.toml"
battery = "fits/battery/synthetic-3s.toml"
[path]
area = "missions/synthetic/field.geojson"
airspeed_m_per_s = {{ levels = [{}] }}
spacing_m = 60
heading_deg = 30
swath_m = 60
utility = {{ weight = 1 }}
)",
                                      speeds);
        const auto read = parse_mission(text, test::source_dir() / "field.toml", {.allow_unplanned = true});
        const auto plan = plan_mission(std::get<PlanningProblem>(read));
        EXPECT_EQ(plan.mission.setup.survey->layout.strips.front().airspeed_m_per_s, 13.0) << speeds;
        ASSERT_FALSE(plan.mission.setup.notes.empty());
        const auto& note = plan.mission.setup.notes.back();
        EXPECT_EQ(note.find("1 of 2 ways to cover the area cannot be flown, for example: "), 0U) << note;
        EXPECT_NE(note.find("5 m/s is beyond what the model's flights flew"), std::string::npos) << note;
    }
}

TEST(SurveyPlan, IsInfeasibleIfNoLinesLand) {
    const auto plan = plan_mission(field("spacing_m = { min = 10, max = 12 }\n"));
    EXPECT_FALSE(plan.plan.feasible);
    EXPECT_EQ(plan.plan.utility_bound, 0.0);
    EXPECT_EQ(plan.mission.setup.survey->layout.strips.front().spacing_m, 12.0) << "the most charge";
}

TEST(SurveyPlan, IsChangedInFlight) {
    const auto problem = field("spacing_m = { min = 40, max = 100, steps = 4 }\n", adaptive);
    const auto prepared = prepare_mission(problem);
    const auto calm = simulate_prepared(prepared);
    ASSERT_TRUE(calm.setup);
    EXPECT_TRUE(calm.simulation.summary.keeps_reserve);
    EXPECT_GE(*calm.simulation.summary.utility, *plan_mission(problem).summary.utility * 0.99);
    Disturbance fault;
    fault.start_s = 0.4 * timeline_of(calm.setup->duration_s).duration_s;
    fault.soc_drop_percent = 12.0;
    const auto faulty = simulate_prepared(prepared, {}, {fault});
    const auto& summary = faulty.simulation.summary;
    ASSERT_TRUE(summary.lines && calm.simulation.summary.lines);
    EXPECT_TRUE(summary.keeps_reserve);
    EXPECT_LT(*summary.coverage, *calm.simulation.summary.coverage);
    EXPECT_EQ(summary.lines->strips.front().spacing_m, calm.simulation.summary.lines->strips.front().spacing_m);
    // As it was decided, the battery is on the path that is simulated in the end.
    const auto again = simulate(*faulty.setup, faulty.schedule, {}, {fault}).summary;
    EXPECT_EQ(again.final_soc_percent, summary.final_soc_percent);
}

TEST(SurveyPlan, IsReplayedOnTheLinesThatItChooses) {
    const auto problem = field("spacing_m = { min = 40, max = 100, steps = 4 }\n", adaptive);
    const std::array missions{MissionVariant(problem)};
    const std::array flights{test::flight_of_model("as modelled", problem.setup)};
    ReplayOptions options;
    options.model = problem.setup.mechanical;
    const auto replays = replay_flights(missions, flights, options);
    ASSERT_EQ(replays.replays.size(), 1U);
    const auto& replay = replays.replays.front();
    EXPECT_FALSE(replay.bound) << "in flight lines may change within a block";
    EXPECT_EQ(replay.schedules.size(), 6U);
    for (const auto& [way, summary, expected_percent, schedule, regret] : replay.schedules) {
        ASSERT_TRUE(summary.lines) << to_string(way);
        EXPECT_GE(regret.value_or(0.0), 0.0) << to_string(way);
        EXPECT_NEAR(*summary.final_soc_percent, expected_percent.value_or(*summary.final_soc_percent), 0.1);
    }
}

TEST(SurveyPlan, RefusesWhatIsNoChoice) {
    const auto refusal = [](const std::string& path) { return test::rejected([&] { field(path); }); };
    EXPECT_NE(refusal("spacing_m = { levels = [30] }\n").find("fewer than two levels leave no choice"),
              std::string::npos);
    EXPECT_NE(refusal("spacing_m = { min = 30, max = 60, levels = [30, 60] }\n").find("min and levels are two choices"),
              std::string::npos);
    EXPECT_NE(refusal("spacing_m = { min = 30, max = 60, steps = 20, blocks = 3 }\n").find("combinations"),
              std::string::npos);
    EXPECT_NE(refusal("spacing_m = 30\n[[path.strip]]\nto = 1\nspacing_m = 30\n").find("an area needs spacing_m"),
              std::string::npos);
    EXPECT_NE(refusal("[[path.strip]]\nto = 0.5\nspacing_m = 30\n").find("the last strip ends before the area does"),
              std::string::npos);
    EXPECT_NE(refusal(two_blocks + "[packs]\ncount = 2\nchange_s = 60\n").find("several packs cannot be chosen"),
              std::string::npos);
}

}  // namespace
}  // namespace flightwatt::mission
