#include "mission/flight_replanner.h"

#include "helpers/paper_missions.h"
#include "mission/planning/planner.h"
#include "mission/sampling/flight_spreads.h"
#include "mission/simulation/load_segments.h"

#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

AdaptivePlanner planner() { return make_adaptive_planner(test::paper_problem("adaptive-replanned")); }

TEST(FlightReplanner, LearnsThePowerThatIsFlown) {
    const auto adaptive = planner();
    FlightReplanner decider(adaptive);
    EXPECT_EQ(decider.mechanical_factor(), 1.0);
    const PhaseSegment interval{Phase::cruise, 0.0, 60.0};
    const auto plan = decider.replan({Phase::cruise, 0.0}, {90.0, 0.0});
    const auto run = clip_to_interval(plan.schedule, interval);
    ASSERT_FALSE(run.empty());
    EXPECT_EQ(run.front().start_s, 0.0);
    EXPECT_EQ(run.back().end_s, 60.0);
    // As planned, nothing is learned; twice as much power moves the factor half of the way after learning_time_s.
    FlightReplanner calm = decider;
    const auto load = make_mission_load(adaptive.nominal.setup);
    const auto lost_percent = [&](double mechanical_factor) {
        battery::Discharge now{{90.0}};
        Disturbance wind;
        wind.mechanical_factor = mechanical_factor;
        for (const auto& scheduled : run)
            for (const auto& segment : disturbed(load_segments(load, scheduled), {wind}))
                now = advance_segment(adaptive.nominal.setup.battery, 0.0, segment, now);
        return 90.0 - now.soc_percent;
    };
    const double planned_percent = lost_percent(1.0);
    calm.update(interval, run, {90.0, 0.0}, 90.0 - planned_percent);
    EXPECT_NEAR(calm.mechanical_factor(), 1.0, 1e-9);
    decider.update(interval, run, {90.0, 0.0}, 90.0 - lost_percent(1.2));
    const double learning_s = adaptive.nominal.adaptive->learning_time_s;
    EXPECT_NEAR(decider.mechanical_factor(), 1.0 + 0.2 * 60.0 / (60.0 + learning_s), 1e-4);
    const double before = decider.mechanical_factor();
    decider.update({Phase::cruise, 60.0, 120.0}, clip_to_interval(plan.schedule, {Phase::cruise, 60.0, 120.0}),
                   {80.0, 0.0}, 20.0);
    EXPECT_EQ(decider.mechanical_factor(), before) << "a jump of the charge is no wind";
}

TEST(FlightReplanner, RunsWhatDemandsLeastFromHereOnWhereNoPlanKeepsTheReserve) {
    const auto adaptive = planner();
    FlightReplanner decider(adaptive);
    const auto poor = decider.replan({Phase::cruise, 200.0}, {10.0, 0.0});
    EXPECT_FALSE(poor.feasible);
    ASSERT_FALSE(poor.schedule.empty());
    EXPECT_EQ(poor.schedule.front().phase, Phase::cruise);
    EXPECT_EQ(poor.schedule.front().start_s, 200.0);
}

/// Levels that differ by 10 % from flight to flight, each phase's for itself, are energy that differs by less.
TEST(FlightReplanner, ExpectsFlightsToDifferAsTheMissionSaysTheyDo) {
    auto problem = test::paper_problem("adaptive-replanned");
    double energy_j = 0.0;
    double squares = 0.0;
    for (const auto phase : all_phases) {
        problem.setup.uncertainty.level_sd_percent[phase] = 10.0;
        const double own_j = mean_level_w(problem.setup, phase) * problem.setup.duration_s[phase];
        energy_j += own_j;
        squares += own_j * own_j;
    }
    const auto decided = [&](std::optional<double> sd_percent) {
        problem.adaptive->mechanical_sd_percent = sd_percent;
        const auto adaptive = make_adaptive_planner(problem);
        std::vector<Schedule> schedules;
        for (double soc_percent = 10.0; soc_percent < 95.0; soc_percent += 1.0)
            schedules.push_back(FlightReplanner(adaptive).replan({Phase::cruise, 200.0}, {soc_percent, 0.0}).schedule);
        return schedules;
    };
    const auto by_flights = decided(std::nullopt);
    EXPECT_EQ(by_flights, decided(10.0 * std::sqrt(squares) / energy_j));
    EXPECT_NE(by_flights, decided(0.0));
    for (const auto phase : all_phases) problem.setup.uncertainty.level_sd_percent[phase].reset();
    problem.setup.mechanical->phases[Phase::cruise].level_spread.reset();
    EXPECT_EQ(decided(std::nullopt), decided(5.0)) << "nothing states how they differ";
}

TEST(FlightReplanner, APartOfAPlanLiesWithinItsInterval) {
    const Schedule plan{
        {{Phase::takeoff, 0.0, 30.0}, {}}, {{Phase::cruise, 0.0, 50.0}, {}}, {{Phase::cruise, 50.0, 90.0}, {}}};
    const auto part = clip_to_interval(plan, {Phase::cruise, 40.0, 60.0});
    ASSERT_EQ(part.size(), 2U);
    EXPECT_EQ(part[0].start_s, 40.0);
    EXPECT_EQ(part[0].end_s, 50.0);
    EXPECT_EQ(part[1].end_s, 60.0);
    EXPECT_TRUE(clip_to_interval(plan, {Phase::landing, 0.0, 10.0}).empty());
}

}  // namespace
}  // namespace flightwatt::mission
