// Plans for batteries whose source follows their charge, and for those that may be cut off.

#include "base/error.h"
#include "helpers/paper_missions.h"
#include "helpers/small_missions.h"
#include "mission/feasibility_limits.h"
#include "mission/mission_file.h"
#include "mission/plan.h"
#include "mission/planning/planner.h"
#include "mission/sampled_flights.h"
#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

std::function<PlanningProblem(double)> thevenin_plan(double reserve_soc_percent = 20.0,
                                                     double cutoff_voltage_v = 10.5) {
    return [=](double cruise_s) {
        auto mission = std::get<PlanningProblem>(
            read_mission(test::source_dir() / "missions" / "synthetic" / "thevenin-plan.toml", {true, cruise_s}));
        mission.setup.reserve_soc_percent = reserve_soc_percent;
        mission.setup.cutoff_voltage_v = cutoff_voltage_v;
        return mission;
    };
}

/// A pack that sags and recovers, and a mission of few slots and two levels.
PlanningProblem small_mission(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    auto mission = thevenin_plan(0.0, 0.0)(1500.0);
    mission.setup.battery.resistance_ohm = 0.02 + 0.1 * uniform(random);
    mission.setup.battery.thevenin->rc_resistance_ohm = 0.1 * uniform(random);
    mission.setup.battery.thevenin->rc_time_constant_s = 10.0 + 100.0 * uniform(random);
    mission.plan.slot_s = 150.0 + 100.0 * uniform(random);
    mission.plan.choices[0].levels = {{5.8, 12.0 + 20.0 * uniform(random)}};
    return mission;
}

/// The most utility of any schedule that lands, by simulating them. One that computes more in every slot than another
/// draws more, so those above one that does not land are passed over.
double best_of_all(const PlanningProblem& mission, const PlanningTables& planner) {
    const auto slots = make_slots(mission);
    std::vector<bool> lands(std::size_t{1} << slots.size());
    double best = -1.0;
    for (std::size_t code = 0; code < lands.size(); ++code) {
        std::vector<ScheduleSegment> schedule;
        bool may_land = true;
        for (std::size_t i = 0; i < slots.size(); ++i) {
            const auto bit = std::size_t{1} << i;
            may_land = may_land && ((code & bit) == 0 || lands[code & ~bit]);
            schedule.push_back({slots[i], planner.configurations[(code >> i) & 1]});
        }
        if (!may_land) continue;
        const auto summary = simulate(mission.setup, schedule, {1e3, 4.0}).summary;
        lands[code] = summary.keeps_reserve;
        if (lands[code]) best = std::max(best, *summary.utility);
    }
    return best;
}

TEST(SimulatedPlan, KeepsTheReserve) {
    for (const double reserve : {12.0, 20.0, 28.0}) {
        const auto mission = thevenin_plan(reserve)(1800.0);
        const auto plan = plan_mission(mission);
        ASSERT_TRUE(plan.plan.feasible) << reserve;
        EXPECT_TRUE(plan.summary.keeps_reserve) << reserve;
        EXPECT_TRUE(simulate(plan.mission).summary.keeps_reserve);
        EXPECT_LT(*plan.summary.final_soc_percent, reserve + 0.1) << "a part of a slot of 60 s";
        EXPECT_TRUE(plan.plan.bound_is_proven);
        EXPECT_GE(plan.plan.utility_bound, *plan.summary.utility);
        EXPECT_LE(plan.plan.utility_bound, *plan.summary.utility * (1.0 + 1e-4));
    }
}

TEST(SimulatedPlan, IsTheBestOfAllSimulatedSchedules) {
    std::mt19937 random(5);
    int feasible = 0;
    for (int i = 0; i < 8; ++i) {
        auto mission = small_mission(random);
        const auto least = simulate(with_minimum_energy_schedule(mission)).summary;
        if (!least.feasible) continue;
        std::uniform_real_distribution<double> share(0.3, 1.0);
        mission.setup.reserve_soc_percent = share(random) * *least.final_soc_percent;
        if (i % 2 == 1) mission.setup.cutoff_voltage_v = 10.4;
        const auto plan = plan_mission(mission);
        const double best = best_of_all(mission, make_planning_tables(mission));
        ASSERT_EQ(plan.plan.feasible, best >= 0.0);
        if (!plan.plan.feasible) continue;
        ++feasible;
        EXPECT_TRUE(plan.summary.keeps_reserve);
        EXPECT_GE(plan.plan.utility_bound, best - 1e-9);
        EXPECT_GE(*plan.summary.utility, best * (1.0 - 1e-4));
        EXPECT_LE(plan.plan.utility_bound, *plan.summary.utility * (1.0 + 1e-4));
    }
    EXPECT_GE(feasible, 5);
}

/// Of small_missions.h, next to all schedules; studies/planning takes many.
class SmallMissions : public testing::TestWithParam<unsigned> {};

TEST_P(SmallMissions, HaveNoBetterScheduleThanThePlan) {
    const auto [problem, kind] = test::small_mission(GetParam());
    const auto plan = plan_mission(problem);
    const auto best = test::EverySchedule(problem, make_planning_tables(problem))
                          .max_utility(plan.plan.feasible ? plan.summary.utility : std::nullopt);
    ASSERT_EQ(plan.plan.feasible, best.has_value()) << kind;
    if (!best) return;
    EXPECT_TRUE(plan.summary.keeps_reserve) << kind;
    EXPECT_GE(*plan.summary.utility, *best * (1.0 - 1e-4)) << kind;
    EXPECT_GE(plan.plan.utility_bound, *best * (1.0 - 1e-9)) << kind;
    EXPECT_LE(plan.plan.utility_bound, *plan.summary.utility * (1.0 + 1e-4)) << kind;
    EXPECT_TRUE(plan.plan.bound_is_proven);
}

// All schedules of 6 and 8 take seconds.
INSTANTIATE_TEST_SUITE_P(Generated, SmallMissions, testing::Values(1U, 2U, 3U, 4U, 5U, 7U, 9U, 10U, 11U, 12U));

TEST(SimulatedPlanStudy, IsProvenForManySlotsAndChoices) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        for (const bool dwells : {false, true}) {
            const auto made = test::SmallMissionGenerator(seed).make_long(dwells, false);
            EXPECT_GT(make_slots(made.problem).size(), 60U);
            const auto plan = plan_mission(made.problem);
            ASSERT_TRUE(plan.plan.feasible) << seed;
            EXPECT_TRUE(plan.summary.keeps_reserve) << seed;
            EXPECT_LE(plan.plan.utility_bound, *plan.summary.utility * (1.0 + 1e-4)) << seed << ' ' << made.kind;
        }
    }
}

TEST(SimulatedPlanStudy, UsesWhatATightCutOffLeaves) {
    // What nothing but the least power at the end can land with: most of the power of a beam is cut off there.
    const auto made = test::SmallMissionGenerator(4).make_long(false, true);
    const auto plan = plan_mission(made.problem);
    ASSERT_TRUE(plan.plan.feasible);
    EXPECT_TRUE(plan.summary.keeps_reserve);
    EXPECT_GT(*plan.summary.utility, 1.2 * *simulate(with_minimum_energy_schedule(made.problem)).summary.utility);
    EXPECT_LE(plan.plan.utility_bound, *plan.summary.utility * 1.05);
}

TEST(SimulatedPlanStudy, IsNoWorseThanOneOfFewerChangesBeforeALateCutOff) {
    // With a cut-off just below what the least power leads to, most schedules of great utility end early.
    auto free = test::SmallMissionGenerator(71017).make_long(false, true).problem;
    auto staying = free;
    staying.plan.dwell_s = 3.0 * free.plan.slot_s;
    const auto plan = plan_mission(free);
    const auto of_fewer = plan_mission(staying);
    ASSERT_TRUE(plan.plan.feasible && of_fewer.plan.feasible);
    EXPECT_GE(*plan.summary.utility, 1.04 * *of_fewer.summary.utility);
    EXPECT_LE(*plan.summary.utility, plan.plan.utility_bound);
}

TEST(SimulatedPlan, IsNotCutOff) {
    const auto mission = thevenin_plan(20.0, 11.0)(1800.0);
    const auto plan = plan_mission(mission);
    ASSERT_TRUE(plan.plan.feasible);
    for (const auto& row : simulate(plan.mission).curve.rows) ASSERT_GE(row.terminal_voltage_v, 11.0);
    // What has most utility without a cut-off would be.
    auto careless = plan_mission(thevenin_plan(20.0, 0.0)(1800.0)).mission;
    careless.setup.cutoff_voltage_v = 11.0;
    EXPECT_TRUE(simulate(careless).summary.cut_off_at_s);
}

TEST(SimulatedPlan, KeepsThePapersBatteryFromItsCutOff) {
    auto mission = test::paper_problem("plan");
    mission.fixed.clear();
    mission.setup.reserve_soc_percent = 1.0;
    mission.setup.battery = {"", 3.6, 0.02, 3.4};
    const double min_v = [&] {
        const auto rows = simulate(with_minimum_energy_schedule(mission)).curve.rows;
        return std::min_element(
                   rows.begin(), rows.end(),
                   [](const auto& a, const auto& b) { return a.terminal_voltage_v < b.terminal_voltage_v; })
            ->terminal_voltage_v;
    }();
    mission.setup.cutoff_voltage_v = min_v - 0.005;
    const auto plan = plan_mission(mission);
    ASSERT_TRUE(plan.plan.feasible);
    EXPECT_TRUE(plan.summary.keeps_reserve);
    EXPECT_LE(plan.plan.utility_bound, *plan.summary.utility * 1.001) << "a constant source: tables are exact";
    mission.setup.cutoff_voltage_v = min_v + 0.005;
    EXPECT_FALSE(plan_mission(mission).plan.feasible);
}

TEST(PlanRest, AnswersALearnedFactorOnAPackWhoseVoltageFalls) {
    const auto problem = thevenin_plan()(1800.0);
    const auto planner = make_planning_tables(problem);
    PlanStart start{600.0, 80.0};
    start.mechanical_factor = 1.1;
    start.rc_voltage_v = 0.02;
    const auto plan = plan_remaining(problem, planner, start, 20.0);
    ASSERT_TRUE(plan.feasible);
    auto windy = problem;
    for (const auto phase : flight::all_phases) {
        auto& curve = windy.setup.mechanical->phases[phase].fourier;
        curve.a0_w *= 1.1;
        for (auto* terms_w : {&curve.cos_w, &curve.sin_w})
            for (auto& term_w : *terms_w) term_w *= 1.1;
    }
    battery::Discharge state{{80.0, 0.02}};
    for (const auto& segment : load_segments(windy.setup, plan.schedule)) {
        const auto power = [&](double time_s) { return power_w(segment, time_s); };
        state = discharge(problem.setup.battery, {power, segment.start_s, segment.end_s}, state, {0.1, 10.5});
    }
    EXPECT_FALSE(state.ended_at_s() || state.undeliverable);
    EXPECT_NEAR(plan.final_soc_percent, state.soc_percent, 3e-6);
    EXPECT_LE(plan.utility_bound, plan.utility * (1.0 + 1e-4));
    start.mechanical_factor = 1.0;
    EXPECT_GT(plan_remaining(problem, planner, start, 20.0).utility, plan.utility);
    start.soc_percent = 30.0;
    const auto lost = plan_remaining(problem, planner, start, 20.0);
    EXPECT_FALSE(lost.feasible);
    EXPECT_EQ(lost.schedule.back().run, min_power_configuration(problem)) << "it does the least";
}

TEST(SimulatedPlanStudy, KeepsTheReserveWithAProbability) {
    auto mission = thevenin_plan()(1800.0);
    EXPECT_THROW(plan_mission(mission, 0.95), InputError) << "a model that does not state how flights differ";
    for (const auto phase : flight::all_phases) {
        mission.setup.mechanical->phases[phase].flights = 5;
        mission.setup.mechanical->phases[phase].level_spread = {5, 0.5, 0.1, 20.0};
    }
    const auto plan = plan_mission(mission, 0.95);
    ASSERT_TRUE(plan.plan.feasible);
    EXPECT_GT(plan.margin_percent, 0.5);
    EXPECT_NEAR(*plan.summary.final_soc_percent, 20.0 + plan.margin_percent, 0.05);
    constexpr std::size_t flights = 1000;
    const auto sampled = sample_flights({plan.mission.setup, plan.mission.schedule, std::nullopt}, {}, {flights, 1, 0});
    EXPECT_NEAR(sampled.probability_below_reserve, 0.05, 3.0 * std::sqrt(0.05 * 0.95 / flights));
    EXPECT_EQ(sampled.sources.varied, plan.sources->varied);
}

TEST(SimulatedPlan, ProvesNothingWhereTheBatteryIsCharged) {
    auto mission = thevenin_plan()(1800.0);
    mission.setup.mechanical->phases[flight::Phase::landing].fourier.a0_w = -60.0;
    mission.setup.may_charge = true;
    const auto plan = plan_mission(mission);
    ASSERT_TRUE(plan.plan.feasible);
    EXPECT_FALSE(plan.plan.bound_is_proven);
    EXPECT_TRUE(plan.summary.keeps_reserve);
}

TEST(SimulatedPlan, SaysWhatIsMissing) {
    const auto mission_of = thevenin_plan(20.0, 11.1);
    const auto mission = mission_of(1800.0);
    const auto plan = plan_mission(mission);
    ASSERT_FALSE(plan.plan.feasible);
    const auto report = infeasibility_report(mission, plan, mission_of);
    EXPECT_GT(report.shortfall_percent, 0.0);
    EXPECT_GT(report.shortfall_wh, 0.0);
    ASSERT_TRUE(report.cut_off_at_s && report.cruise_s && report.capacity_ah);
    EXPECT_FALSE(report.reserve_soc_percent) << "it is not the reserve";
    EXPECT_TRUE(plan_mission(mission_of(*report.cruise_s)).plan.feasible);
    EXPECT_FALSE(plan_mission(mission_of(*report.cruise_s + 0.1)).plan.feasible);
    for (const double more_ah : {-1e-5, 1e-5}) {
        auto other = mission;
        other.setup.battery.capacity_ah = *report.capacity_ah + more_ah;
        EXPECT_EQ(plan_mission(other).plan.feasible, more_ah > 0.0);
    }
}

TEST(SimulatedPlan, HasFeasibilityLimits) {
    const auto cruise = longest_cruise(thevenin_plan());
    EXPECT_NEAR(cruise.residual_percent, 0.0, 1e-6);
    EXPECT_EQ(cruise.limited_by, LimitingFactor::charge);
    const auto cut_off = longest_cruise(thevenin_plan(20.0, 11.0));
    EXPECT_LT(cut_off.value, cruise.value);
    EXPECT_EQ(cut_off.limited_by, LimitingFactor::cut_off);
    EXPECT_GT(cut_off.residual_percent, 1.0);
    const auto mission = thevenin_plan()(1800.0);
    const auto payload = largest_payload(mission);
    EXPECT_NEAR(payload.residual_percent, 0.0, 1e-6);
    EXPECT_FALSE(
        simulate(with_payload(with_minimum_energy_schedule(mission), payload.value + 0.01)).summary.keeps_reserve);
}

}  // namespace
}  // namespace flightwatt::mission
