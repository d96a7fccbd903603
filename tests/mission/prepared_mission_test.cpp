#include "mission/prepared_mission.h"

#include "battery/battery_toml.h"
#include "helpers/paper_missions.h"
#include "mission/plan.h"

#include <memory>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

TEST(PreparedMission, KeepsAScheduleThatIsGiven) {
    const auto mission = test::paper_mission("phased");
    const auto prepared = prepare_mission(mission);
    EXPECT_EQ(prepared.schedule, mission.schedule);
    EXPECT_EQ(prepared.origin, ScheduleOrigin::given);
    EXPECT_EQ(simulate_prepared(prepared).simulation.summary.final_soc_percent,
              simulate(mission).summary.final_soc_percent);
}

TEST(PreparedMission, LandsAsTheFlightsOfItsPackIndicateToo) {
    auto mission = test::paper_mission("computing-only");
    EXPECT_FALSE(simulate_prepared(prepare_mission(mission)).simulation.summary.by_flights);
    const double left_percent = *simulate(mission).summary.final_soc_percent;
    mission.setup.battery.flight_estimate = std::make_shared<battery::FlightEstimate>(
        battery::FlightEstimate{2.0 * mission.setup.battery.capacity_ah, {5.0, 8.0}});
    const auto summary = simulate_prepared(prepare_mission(mission)).simulation.summary;
    EXPECT_NEAR(*summary.final_soc_percent, left_percent, 1e-9);
    ASSERT_TRUE(summary.by_flights);
    EXPECT_NEAR(summary.by_flights->final_soc_percent.value(), 100.0 - (100.0 - left_percent) / 2.0, 1e-6);
}

TEST(PreparedMission, HasAPlanWhereNoneIsGiven) {
    const auto problem = test::paper_problem("plan");
    const auto flown = simulate_prepared(prepare_mission(problem));
    EXPECT_FALSE(flown.schedule.empty());
    EXPECT_EQ(flown.simulation.summary.schedule, ScheduleOrigin::optimal);
    EXPECT_TRUE(flown.simulation.summary.keeps_reserve);
    auto infeasible = problem;
    infeasible.setup.reserve_soc_percent = 60.0;
    const auto summary = simulate_prepared(prepare_mission(infeasible)).simulation.summary;
    EXPECT_EQ(summary.schedule, ScheduleOrigin::infeasible);
    EXPECT_FALSE(summary.feasible);
}

TEST(PreparedMission, LeavesTheScheduleToAPolicy) {
    const auto prepared = prepare_mission(test::paper_problem("adaptive-replanned"));
    EXPECT_TRUE(prepared.schedule.empty());
    ASSERT_TRUE(prepared.adaptive);
    const auto flown = simulate_prepared(prepared);
    EXPECT_EQ(flown.simulation.summary.schedule, ScheduleOrigin::replanned);
    EXPECT_EQ(flown.schedule.front().start_s, 0.0);
    EXPECT_EQ(flown.schedule.back().end_s, prepared.setup.duration_s[flight::Phase::landing]);
}

using test::paper_mission;
using test::paper_problem;

/// The best schedule of the same mission if nothing happens.
PlanningProblem planned_beforehand() {
    auto mission = paper_problem("adaptive-replanned");
    mission.adaptive.reset();
    return mission;
}

MissionSummary flown(const MissionVariant& mission, const std::vector<Disturbance>& disturbances) {
    return simulate_prepared(prepare_mission(mission), {}, disturbances).simulation.summary;
}

Disturbance headwind(double factor) {
    Disturbance wind;
    wind.mechanical_factor = factor;
    return wind;
}

Disturbance weak_pack(double factor) {
    Disturbance weak;
    weak.capacity_factor = factor;
    return weak;
}

Disturbance drop(double at_s, double percent) {
    Disturbance lost;
    lost.start_s = at_s;
    lost.soc_drop_percent = percent;
    return lost;
}

TEST(AdaptiveFlight, KeepsItsReserveInAHeadwindThatEmptiesStaticSchedules) {
    const auto summary = flown(paper_problem("adaptive-replanned"), {headwind(1.1)});
    EXPECT_TRUE(summary.keeps_reserve) << *summary.final_soc_percent;
    EXPECT_LT(*summary.final_soc_percent, 2.5) << "and does not hoard";
    const std::vector<MissionVariant> others{paper_mission("phased"), paper_mission("invariant-10fps-240bit"),
                                             planned_beforehand()};
    for (const auto& mission : others)
        EXPECT_TRUE(flown(mission, {headwind(1.1)}).depleted_at_s) << setup_of(mission).name;
}

TEST(AdaptiveFlight, KeepsItsReserveWhateverElseHappens) {
    const std::vector<std::vector<Disturbance>> cases{
        {weak_pack(0.95)}, {drop(328.0, 3.0)}, {drop(600.0, 0.2)}, {headwind(1.04), weak_pack(0.98), drop(200.0, 1.0)},
        {headwind(0.9)},
    };
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const auto summary = flown(paper_problem("adaptive-replanned"), cases[i]);
        EXPECT_TRUE(summary.keeps_reserve) << i << ": " << *summary.final_soc_percent;
    }
    for (std::size_t i = 0; i < 4; ++i) EXPECT_FALSE(flown(planned_beforehand(), cases[i]).keeps_reserve) << i;
}

TEST(AdaptiveFlight, LandsWithAsMuchAsPossibleWhereTheReserveCannotBeKept) {
    const auto summary = flown(paper_problem("adaptive-replanned"), {headwind(1.13)});
    // The paper's schedule of that name runs the least wherever nothing is fixed.
    const auto least = flown(paper_mission("adaptive"), {headwind(1.13)});
    EXPECT_TRUE(summary.feasible);
    EXPECT_FALSE(summary.keeps_reserve);
    EXPECT_LT(*least.final_soc_percent, 2.0);
    EXPECT_NEAR(*summary.final_soc_percent, *least.final_soc_percent, 0.5);
    EXPECT_NE(describe(summary).find("less than the reserve of 2 %"), std::string::npos);
    EXPECT_NE(describe(summary).find("what demands least energy was run"), std::string::npos);
}

TEST(AdaptiveFlight, IsNearlyAsGoodAsThePlanIfNothingHappens) {
    const auto adaptive = flown(paper_problem("adaptive-replanned"), {});
    const auto plan = plan_mission(planned_beforehand());
    EXPECT_TRUE(adaptive.keeps_reserve);
    EXPECT_GE(*adaptive.utility, 0.97 * *plan.summary.utility);
    EXPECT_LE(*adaptive.utility, plan.plan.utility_bound + 1e-9) << "nothing keeps the reserve and has more utility";
}

TEST(AdaptiveFlight, LearnsHowMuchMoreMechanicalPowerIs) {
    const auto at = [](const std::vector<Disturbance>& disturbances) {
        return flown(paper_problem("adaptive-replanned"), disturbances).decisions->mechanical_factor;
    };
    EXPECT_NEAR(at({}), 1.0, 1e-6);
    EXPECT_NEAR(at({headwind(1.1)}), 1.0 + 0.1 * 688.0 / (688.0 + 60.0), 1e-6) << "shrunk by the learning time";
    EXPECT_NEAR(at({drop(328.0, 3.0)}), 1.0, 1e-6) << "a jump of the charge is no wind";
}

TEST(AdaptiveFlight, KeepsWhatIsFixed) {
    const auto flight = simulate_prepared(prepare_mission(paper_problem("adaptive-replanned")), {}, {headwind(1.3)});
    bool found = false;
    for (const auto& segment : flight.schedule) {
        if (segment.phase != flight::Phase::cruise || segment.start_s != 240.0) continue;
        found = segment.end_s == 360.0 && segment.run == compute::Configuration{{0, {32.0}}, {1, {448.0}}};
    }
    EXPECT_TRUE(found);
}

TEST(AdaptiveFlight, DecidesAsOftenAsItIsTold) {
    auto mission = paper_problem("adaptive-replanned");
    EXPECT_EQ(flown(mission, {}).decisions->made, 69U);
    mission.adaptive->decide_every_s = 60.0;
    const auto summary = flown(mission, {headwind(1.1)});
    EXPECT_EQ(summary.decisions->made, 12U);
    EXPECT_TRUE(summary.keeps_reserve);
}

TEST(AdaptiveFlight, FliesAPackWhoseVoltageFalls) {
    auto mission = paper_problem("adaptive-replanned");
    mission.setup.battery = battery::read_battery(test::source_dir() / "fits" / "battery" / "synthetic-3s.toml");
    mission.setup.battery.capacity_ah = 1.05;
    for (const double factor : {1.0, 1.1}) {
        const auto summary = flown(mission, {headwind(factor)});
        EXPECT_TRUE(summary.keeps_reserve) << *summary.final_soc_percent;
        EXPECT_LT(*summary.final_soc_percent, 6.0) << factor;
    }
}

TEST(AdaptiveFlight, ForeseesACutOff) {
    auto mission = paper_problem("adaptive-replanned");
    mission.setup.battery = battery::read_battery(test::source_dir() / "fits" / "battery" / "synthetic-3s.toml");
    mission.setup.battery.capacity_ah = 1.05;
    mission.setup.cutoff_voltage_v = 10.9;
    mission.fixed.clear();
    auto careless = mission;
    careless.setup.cutoff_voltage_v = 0.0;
    for (const double factor : {1.0, 1.05}) {
        const auto summary = flown(mission, {headwind(factor)});
        EXPECT_FALSE(summary.cut_off_at_s) << factor;
        EXPECT_TRUE(summary.keeps_reserve) << factor;
        const auto schedule = simulate_prepared(prepare_mission(careless), {}, {headwind(factor)}).schedule;
        EXPECT_TRUE(simulate(mission.setup, schedule, {}, {headwind(factor)}).summary.cut_off_at_s)
            << factor << ": without foresight it is cut off";
    }
}

}  // namespace
}  // namespace flightwatt::mission
