#include "mission/sampling/flight_lanes.h"

#include "helpers/generated_missions.h"
#include "helpers/paper_missions.h"
#include "mission/simulation.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

std::vector<std::vector<double>> drawn_numbers(const MissionSetup& setup, std::size_t count) {
    std::vector<std::vector<double>> normals;
    for (std::size_t i = 0; i < count; ++i) normals.push_back(draw_normals(count_normals(setup), 5, i));
    return normals;
}

/// A made-up mission, flown with most and least computing by turns; of less charge, so that some flights fail.
Mission flown_mission(unsigned seed, double charge_part) {
    auto problem = test::generated_mission(seed, false).problem;
    problem.setup.battery.capacity_ah *= charge_part;
    if (seed % 4 < 2) problem.setup.uncertainty.initial_soc_sd_percent = 3.0;
    Mission mission{problem.setup, {}};
    for (const auto phase : all_phases) {
        const double planned_s = mission.setup.duration_s[phase];
        for (int k = 0; k < 6; ++k)
            mission.schedule.push_back(
                {{phase, planned_s * k / 6.0, planned_s * (k + 1) / 6.0}, {{0, {k % 2 == 0 ? 5.0 : 32.0}}}});
        mission.schedule.back().end_s = planned_s;
    }
    return mission;
}

// Missions of odd seeds have the paper's battery, those of even ones Thévenin's.
TEST(FlightLanes, LandAsRungeKuttaDoes) {
    std::size_t compared = 0;
    std::size_t failed = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
        const auto mission = flown_mission(seed, seed % 3 == 0 ? 0.8 : 1.0);
        const auto spreads = collect_uncertainty(mission.setup);
        const auto normals = drawn_numbers(mission.setup, 3);
        std::vector<FlightOutcome> landings(normals.size());
        SimdFlightSimulator(mission.setup, spreads, mission.schedule).simulate(normals, landings);
        for (std::size_t i = 0; i < normals.size(); ++i) {
            auto flight = apply_draw(mission.setup, spreads, normals[i]);
            flight.may_charge = true;
            const auto schedule =
                rescale_to_flown_durations(mission.schedule, mission.setup.duration_s, flight.duration_s);
            const auto exact = simulate(flight, schedule, {60.0, 0.25}).summary;
            const bool has_failed = exact.depleted_at_s || exact.cut_off_at_s || exact.undeliverable;
            EXPECT_EQ(landings[i].battery_failure, has_failed) << seed << ", flight " << i;
            if (has_failed) {
                ++failed;
                continue;
            }
            ++compared;
            EXPECT_NEAR(landings[i].final_soc_percent, exact.final_soc_percent.value(), 0.01)
                << seed << ", flight " << i;
        }
    }
    EXPECT_GT(compared, 80U);
    EXPECT_GT(failed, 5U);
}

TEST(FlightLanes, LandAsFlightsAlone) {
    for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U, 18U}) {  // of 18 flights fail one after the other
        const auto mission = flown_mission(seed, seed % 3 == 0 ? 0.8 : 1.0);
        const auto spreads = collect_uncertainty(mission.setup);
        const auto normals = drawn_numbers(mission.setup, 70);
        std::vector<FlightOutcome> landings(normals.size());
        const std::vector<double> times_s{0.0, 31.0, 250.0, 400.0, 2000.0};
        const SimdFlightSimulator lanes(mission.setup, spreads, mission.schedule, times_s);
        lanes.simulate(normals, landings);
        for (std::size_t i = 0; i < normals.size(); ++i) {
            const auto alone = lanes.simulate_scalar(normals[i]);
            ASSERT_EQ(landings[i].battery_failure, alone.battery_failure) << seed << ", flight " << i;
            EXPECT_EQ(landings[i].depleted, alone.depleted) << seed << ", flight " << i;
            EXPECT_NEAR(landings[i].final_soc_percent, alone.final_soc_percent, 5e-3) << seed << ", flight " << i;
            // A moment of failure that differs by some hundredths of a second misses as much.
            EXPECT_NEAR(landings[i].remaining_percent, alone.remaining_percent, 2e-2) << seed << ", flight " << i;
            ASSERT_EQ(landings[i].soc_percent.size(), times_s.size());
            for (std::size_t k = 0; k < times_s.size(); ++k)
                EXPECT_NEAR(landings[i].soc_percent[k], alone.soc_percent[k], 5e-3) << seed << ", flight " << i;
        }
    }
}

TEST(FlightLanes, DependOnNothingBeside) {
    const auto mission = flown_mission(2, 0.9);
    const auto spreads = collect_uncertainty(mission.setup);
    auto normals = drawn_numbers(mission.setup, 45);
    const SimdFlightSimulator lanes(mission.setup, spreads, mission.schedule);
    std::vector<FlightOutcome> landings(normals.size());
    lanes.simulate(normals, landings);
    std::ranges::reverse(normals);
    std::vector<FlightOutcome> reversed(normals.size());
    lanes.simulate(normals, reversed);
    for (std::size_t i = 0; i < normals.size(); ++i)
        EXPECT_EQ(landings[i].remaining_percent, reversed[normals.size() - 1 - i].remaining_percent) << i;
}

TEST(FlightLanes, FlyAloneWhatIsFarOut) {
    auto mission = test::paper_mission("phased");
    const auto spreads = collect_uncertainty(mission.setup);
    std::vector<std::vector<double>> normals(1, std::vector<double>(count_normals(mission.setup)));
    normals[0][level_index(Phase::cruise)] = -40.0;
    const SimdFlightSimulator lanes(mission.setup, spreads, mission.schedule);
    std::vector<FlightOutcome> landings(1);
    lanes.simulate(normals, landings);
    EXPECT_EQ(landings[0].final_soc_percent, lanes.simulate_scalar(normals[0]).final_soc_percent);
}

}  // namespace
}  // namespace flightwatt::mission
