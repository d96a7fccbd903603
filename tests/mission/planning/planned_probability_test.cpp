// What --probability asked for is what --samples finds, in missions of every kind.

#include "helpers/generated_missions.h"
#include "mission/feasibility_limits.h"
#include "mission/plan.h"
#include "mission/sampled_flights.h"

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

constexpr std::size_t samples = 1000;

double share_below(const Mission& mission) {
    return sample_flights({mission.setup, mission.schedule, std::nullopt}, {}, {samples, 11, 0})
        .probability_below_reserve;
}

double standard_errors(double share, double probability) {
    return (share - (1.0 - probability)) / std::sqrt(probability * (1.0 - probability) / static_cast<double>(samples));
}

void expect_what_the_flights_keep(unsigned seed) {
    const auto [problem, probability, kind] = test::generated_mission(seed);
    const auto plan = plan_mission(problem, probability);
    ASSERT_TRUE(plan.plan.feasible) << kind;
    const double errors = standard_errors(share_below(plan.mission), probability);
    EXPECT_LT(errors, 3.5) << kind;
    EXPECT_GT(errors, -3.5) << kind;
    EXPECT_LT(*plan.summary.utility, std::sqrt(32.0) - 0.01) << "has charge for everything: no test of the line above";
    EXPECT_GE(*plan.summary.final_soc_percent, problem.setup.reserve_soc_percent + plan.margin_percent - 1e-6);
}

TEST(PlannedProbability, IsWhatTheFlightsOfThePlanKeep) {
    for (const unsigned seed : {2U, 5U}) expect_what_the_flights_keep(seed);
}

TEST(PlannedProbabilityStudy, IsWhatTheFlightsOfThePlanKeep) {
    for (const unsigned seed : {1U, 3U, 4U}) expect_what_the_flights_keep(seed);
}

TEST(PlannedProbability, IsWhatTheFlightsOfAnAnswerKeep) {
    const auto generated = test::generated_mission(5);
    const auto& problem = generated.problem;
    const double probability = generated.probability;
    const auto least = with_minimum_energy_schedule(problem);
    const auto payload = largest_payload(least, probability);
    EXPECT_NEAR(standard_errors(share_below(with_payload(least, payload.value)), probability), 0.0, 3.5);
    EXPECT_NEAR(payload.residual_percent, 0.0, 0.02);
    auto smaller = least;
    smaller.setup.battery.capacity_ah = min_capacity_ah(least, probability).value();
    EXPECT_NEAR(standard_errors(share_below(smaller), probability), 0.0, 3.5);
    const auto mission_of = [&](double cruise_s) {
        auto other = problem;
        other.fixed.clear();
        other.setup.duration_s[flight::Phase::cruise] = cruise_s;
        other.setup.duration_is_stated[flight::Phase::cruise] = true;
        return other;
    };
    const auto cruise = longest_cruise(mission_of, probability);
    const auto longest = with_minimum_energy_schedule(mission_of(cruise.value));
    EXPECT_NEAR(standard_errors(share_below(longest), probability), 0.0, 3.5);
}

TEST(PlannedProbability, NamesRemediesThatAreOnes) {
    auto made = test::generated_mission(3);
    auto& problem = made.problem;
    const double probability = made.probability;
    problem.setup.battery.capacity_ah *= 0.7;
    const auto plan = plan_mission(problem, probability);
    ASSERT_FALSE(plan.plan.feasible);
    const auto mission_of = [&](double cruise_s) {
        auto other = problem;
        other.setup.duration_s[flight::Phase::cruise] = cruise_s;
        other.setup.duration_is_stated[flight::Phase::cruise] = true;
        return other;
    };
    const auto report = infeasibility_report(problem, plan, mission_of, probability);
    EXPECT_GT(report.shortfall_percent, 0.0);
    ASSERT_TRUE(report.cruise_s && report.capacity_ah);
    EXPECT_TRUE(plan_mission(mission_of(*report.cruise_s - 0.5), probability).plan.feasible);
    EXPECT_FALSE(plan_mission(mission_of(*report.cruise_s + 0.5), probability).plan.feasible);
    for (const double more_ah : {-0.005, 0.005}) {
        auto other = problem;
        other.setup.battery.capacity_ah = *report.capacity_ah + more_ah;
        EXPECT_EQ(plan_mission(other, probability).plan.feasible, more_ah > 0.0);
    }
}

}  // namespace
}  // namespace flightwatt::mission
