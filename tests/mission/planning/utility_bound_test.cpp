#include "mission/planning/utility_bound.h"

#include "helpers/small_missions.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

std::vector<CurvePoint> random_points(std::mt19937& random, int count) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<CurvePoint> points;
    for (int i = 0; i < count; ++i) points.push_back({uniform(random), uniform(random)});
    return points;
}

TEST(ConcaveHull, IsTheLeastConcaveCurveAboveItsPoints) {
    std::mt19937 random(1);
    for (int round = 0; round < 50; ++round) {
        const auto points = random_points(random, 1 + round);
        const auto hull = concave_hull(points);
        for (const auto& point : points) EXPECT_GE(value_at(hull, point.x), point.y - 1e-12);
        double last_slope = INFINITY;
        for (std::size_t i = 0; i < hull.size(); ++i) {
            const bool is_given =
                std::ranges::any_of(points, [&](const auto& p) { return p.x == hull[i].x && p.y == hull[i].y; });
            EXPECT_TRUE(is_given) << "corners are points: nothing concave is lower";
            if (i == 0) continue;
            const auto& a = hull[i - 1];
            const auto& b = hull[i];
            const double slope = (b.y - a.y) / (b.x - a.x);
            EXPECT_GT(slope, 0.0);
            EXPECT_LT(slope, last_slope);
            last_slope = slope;
        }
    }
}

TEST(ConcaveHull, IsMinusInfinityBeforeItsFirstPointAndLevelAfterItsLast) {
    const auto hull = concave_hull({{0.0, 1.0}, {1.0, 3.0}, {2.0, 2.0}});
    EXPECT_EQ(value_at(hull, -1e-9), -INFINITY);
    EXPECT_EQ(value_at(hull, 0.0), 1.0);
    EXPECT_EQ(value_at(hull, 0.5), 2.0);
    EXPECT_EQ(value_at(hull, 1.0), 3.0);
    EXPECT_EQ(value_at(hull, 5.0), 3.0);
    EXPECT_EQ(value_at(concave_hull({}), 0.0), -INFINITY);
}

/// A generated mission as the search sees it.
struct BoundCase {
    explicit BoundCase(unsigned seed) : mission(test::small_mission(seed).problem) {
        const auto planner = make_planning_tables(mission);
        const auto slots = make_slots(mission);
        dynamics = make_slot_dynamics(mission.setup, {slots.begin(), slots.end()}, planner.compute_w);
        choices = {{}, planner.utility_per_s, planner.free_choices, 0.0, std::nullopt};
        for (const auto& slot : slots) choices.slots.push_back({slot.duration_s(), std::nullopt});
    }

    ScheduleProblem problem() const {
        return {dynamics, choices, {mission.setup.initial_soc_percent}, mission.setup.reserve_soc_percent};
    }

    PlanningProblem mission;
    SlotDynamics dynamics;
    ScheduleChoices choices;
};

/// The states at the starts of the slots and the mission's end; fewer if the battery ends.
std::vector<battery::BatteryState> states_of(const BoundCase& made, const std::vector<std::size_t>& schedule) {
    std::vector<battery::BatteryState> states{made.problem().start};
    for (std::size_t i = 0; i < schedule.size(); ++i) {
        const auto after = advance_slot(made.dynamics, i, schedule[i], states.back());
        if (!after) break;
        states.push_back(*after);
    }
    return states;
}

TEST(UtilityBound, HoldsFromEveryStateOfSchedulesThatLand) {
    std::mt19937 random(2);
    int landed = 0;
    for (unsigned seed = 1; seed <= 30; ++seed) {
        const BoundCase made(seed);
        const auto graph = make_schedule_graph(made.choices);
        std::uniform_int_distribution<std::size_t> any(0, made.choices.free_choices - 1);
        std::vector<std::size_t> reference(graph.slots);
        std::ranges::generate(reference, [&] { return any(random) / 2; });
        for (const auto& bound :
             {make_utility_bound(made.problem(), graph, 8), make_utility_bound(made.problem(), graph, 8, reference)}) {
            if (!bound.lands) continue;
            for (int round = 0; round < 50; ++round) {
                std::vector<std::size_t> schedule(graph.slots);
                std::ranges::generate(schedule, [&] { return any(random) * any(random) / made.choices.free_choices; });
                const auto states = states_of(made, schedule);
                if (states.size() <= graph.slots || states.back().soc_percent < made.problem().reserve_soc_percent)
                    continue;
                ++landed;
                double to_go = 0.0;
                for (std::size_t i = graph.slots; i-- > 0;) {
                    to_go += made.choices.utility_per_s[schedule[i]] * made.choices.slots[i].duration_s;
                    ASSERT_GE(utility_to_go(bound, i, 0, states[i]) * (1.0 + 1e-9), to_go) << seed << ", slot " << i;
                }
            }
        }
    }
    EXPECT_GT(landed, 500);
}

TEST(UtilityBound, HasCostsOfRcVoltageThatHold) {
    int finite = 0;
    for (unsigned seed = 1; seed <= 30; ++seed) {
        const BoundCase made(seed);
        const auto bound = make_utility_bound(made.problem(), make_schedule_graph(made.choices), 8);
        if (!bound.lands || made.dynamics.circuit.rc_resistance_ohm == 0.0) continue;
        // Two states of a schedule that differ in RC voltage: the costs before and after a slot agree with their ends.
        constexpr double more_v = 1e-3;
        const std::vector<std::size_t> schedule(made.choices.slots.size(), made.choices.free_choices / 3);
        const auto states = states_of(made, schedule);
        for (std::size_t i = 0; i + 1 < states.size() && states[i + 1].soc_percent > bound.lowest_percent[i + 1]; ++i) {
            auto other = states[i];
            other.rc_voltage_v += more_v;
            const auto end = advance_slot(made.dynamics, i, schedule[i], other);
            if (!end) break;
            const double lost = states[i + 1].soc_percent - end->soc_percent;
            const double left_v = end->rc_voltage_v - states[i + 1].rc_voltage_v;
            EXPECT_LE(bound.rc_min_cost[i] * more_v, lost + bound.rc_min_cost[i + 1] * left_v + 1e-12) << seed;
            if (!std::isfinite(bound.rc_max_cost[i])) continue;
            EXPECT_GE(bound.rc_max_cost[i] * more_v, lost + bound.rc_max_cost[i + 1] * left_v - 1e-12) << seed;
            ++finite;
        }
    }
    EXPECT_GT(finite, 50);
}

}  // namespace
}  // namespace flightwatt::mission
