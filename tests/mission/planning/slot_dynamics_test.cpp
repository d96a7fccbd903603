#include "mission/planning/slot_dynamics.h"

#include "battery/discharge.h"
#include "helpers/small_missions.h"

#include <optional>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

struct Prepared {
    PlanningProblem problem;
    std::vector<compute::Configuration> runs;
    std::vector<PhaseSegment> slots;
    SlotDynamics dynamics;
};

Prepared prepared(unsigned seed, double mechanical_factor = 1.0) {
    Prepared made{test::small_mission(seed).problem, {}, {}, {}};
    const auto planner = make_planning_tables(made.problem);
    made.runs = planner.configurations;
    for (const auto& slot : make_slots(made.problem)) made.slots.push_back(slot);
    made.dynamics = make_slot_dynamics(made.problem.setup, made.slots, planner.compute_w, mechanical_factor);
    return made;
}

battery::Discharge discharged(const Prepared& made, std::size_t slot, std::size_t choice,
                              const battery::BatteryState& state) {
    const auto load = make_mission_load(made.problem.setup);
    const auto segment = load_segments(load, {made.slots[slot], made.runs[choice]}).front();
    const auto power = [&](double time_s) { return power_w(segment, time_s); };
    return discharge(made.problem.setup.battery, {power, segment.start_s, segment.end_s}, state,
                     {0.1, made.problem.setup.cutoff_voltage_v});
}

TEST(SlotDynamics, AgreeWithTheDischarge) {
    int ended = 0;
    for (unsigned seed = 1; seed <= 10; ++seed) {
        const auto made = prepared(seed);
        for (std::size_t choice = 0; choice < made.runs.size(); choice += 3) {
            battery::BatteryState state{made.problem.setup.initial_soc_percent};
            for (std::size_t i = 0; i < made.slots.size(); ++i) {
                const auto expected = discharged(made, i, choice, state);
                const auto after = advance_slot(made.dynamics, i, choice, state);
                if (!after || after->soc_percent <= 0.0) {
                    EXPECT_TRUE(expected.ended_at_s() || expected.undeliverable) << seed << ' ' << i;
                    ++ended;
                    break;
                }
                ASSERT_FALSE(expected.undeliverable || expected.ended_at_s()) << seed << ' ' << i;
                EXPECT_NEAR(after->soc_percent, expected.soc_percent, 3e-6) << seed << ' ' << i;
                EXPECT_NEAR(after->rc_voltage_v, expected.rc_voltage_v, 1e-6);
                state = *after;
            }
        }
    }
    EXPECT_GT(ended, 5);
}

TEST(SlotDynamics, ScaleMechanicalPower) {
    const auto plain = prepared(1);
    const auto windy = prepared(1, 1.2);
    const auto& plain_w = plain.dynamics.slots[1].parts.at(0).mechanical_w;
    const auto& windy_w = windy.dynamics.slots[1].parts.at(0).mechanical_w;
    ASSERT_EQ(windy_w.size(), plain_w.size());
    for (std::size_t k = 0; k < plain_w.size(); ++k) EXPECT_NEAR(windy_w[k], 1.2 * plain_w[k], 1e-12);
    EXPECT_NEAR(windy.dynamics.slots[1].max_mechanical_w, 1.2 * plain.dynamics.slots[1].max_mechanical_w, 1e-12);
}

TEST(SlotDynamics, KeepTheOrderOfStates) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (unsigned seed = 1; seed <= 20; ++seed) {
        auto made = prepared(seed);
        made.dynamics.cutoff_voltage_v = 0.0;
        for (std::size_t i = 0; i < made.slots.size(); ++i) {
            const battery::BatteryState low{30.0 + 60.0 * uniform(random), 0.1 * uniform(random)};
            const battery::BatteryState high{low.soc_percent + uniform(random), low.rc_voltage_v * uniform(random)};
            const auto choice = static_cast<std::size_t>(uniform(random) * static_cast<double>(made.runs.size()));
            const auto low_end = advance_slot(made.dynamics, i, choice, low);
            const auto high_end = advance_slot(made.dynamics, i, choice, high);
            if (!low_end) continue;
            ASSERT_TRUE(high_end) << seed;
            EXPECT_LE(high_end->rc_voltage_v, low_end->rc_voltage_v + 1e-12);
            EXPECT_GE(high_end->soc_percent - low_end->soc_percent, high.soc_percent - low.soc_percent - 1e-12)
                << "charges never come nearer to each other";
        }
    }
}

}  // namespace
}  // namespace flightwatt::mission
