#include "helpers/drawn_mission.h"
#include "helpers/generated_missions.h"
#include "mission/sampling/flight_draws.h"
#include "mission/sampling/landing_distribution.h"
#include "mission/simulation.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

std::vector<std::vector<double>> drawn_numbers(const MissionSetup& setup, std::size_t count) {
    std::vector<std::vector<double>> normals;
    for (std::size_t i = 0; i < count; ++i) normals.push_back(draw_normals(count_normals(setup), 5, i));
    return normals;
}

/// The flight of these numbers with the mission's schedule, its charge noted at times of the mission as planned.
DrawnFlight drawn_flight(const Mission& mission, const FlightUncertainty& spreads, const std::vector<double>& normals,
                         const std::vector<double>& times_s = {}) {
    const auto& planned_s = mission.setup.duration_s;
    DrawnFlight flight{apply_draw(mission.setup, spreads, normals), {}, times_s};
    for (auto& time_s : flight.times_s)
        time_s = rescale_to_flown_durations_s(time_s, planned_s, flight.setup.duration_s);
    const auto schedule = rescale_to_flown_durations(mission.schedule, planned_s, flight.setup.duration_s);
    flight.segments = disturbed(load_segments(flight.setup, schedule), {}, flight.times_s);
    return flight;
}

std::vector<FlightOutcome> fly(const Mission& mission, const std::vector<std::vector<double>>& normals,
                               const std::vector<double>& times_s = {}) {
    const auto spreads = collect_uncertainty(mission.setup);
    const FlightDraw draw = [&](std::size_t i, DrawnFlight& flight) {
        flight = drawn_flight(mission, spreads, normals[i], times_s);
    };
    return fly_drawn(mission.setup, draw, 0, normals.size());
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
TEST(FlightOutcome, LandAsRungeKuttaDoes) {
    std::size_t compared = 0;
    std::size_t failed = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
        const auto mission = flown_mission(seed, seed % 3 == 0 ? 0.8 : 1.0);
        const auto spreads = collect_uncertainty(mission.setup);
        const auto normals = drawn_numbers(mission.setup, 3);
        const auto landings = fly(mission, normals);
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

TEST(FlightOutcome, NotesTheChargeAtTimesOfTheMission) {
    for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U, 18U}) {  // of 18 flights fail one after the other
        const auto mission = flown_mission(seed, seed % 3 == 0 ? 0.8 : 1.0);
        const auto spreads = collect_uncertainty(mission.setup);
        const auto normals = drawn_numbers(mission.setup, 70);
        const std::vector<double> times_s{0.0, 31.0, 250.0, 400.0, 2000.0};
        const auto landings = fly(mission, normals, times_s);
        for (std::size_t i = 0; i < normals.size(); ++i) {
            const auto flight = drawn_flight(mission, spreads, normals[i], times_s);
            battery::Discharge alone{{flight.setup.initial_soc_percent}};
            std::vector<double> noted_percent;
            for (const auto& segment : flight.segments) {
                while (noted_percent.size() < times_s.size() &&
                       flight.times_s[noted_percent.size()] <= segment.start_s + 1e-9)
                    noted_percent.push_back(alone.soc_percent);
                alone = advance_segment(flight.setup.battery, flight.setup.cutoff_voltage_v, segment, alone);
            }
            noted_percent.resize(times_s.size(), alone.soc_percent);
            EXPECT_EQ(landings[i].battery_failure, alone.ended_at_s() || alone.undeliverable)
                << seed << ", flight " << i;
            EXPECT_NEAR(landings[i].final_soc_percent, alone.soc_percent, 1e-8) << seed << ", flight " << i;
            ASSERT_EQ(landings[i].soc_percent.size(), times_s.size());
            for (std::size_t k = 0; k < times_s.size(); ++k)
                EXPECT_NEAR(landings[i].soc_percent[k], noted_percent[k], 1e-8) << seed << ", flight " << i;
        }
    }
}

/// Under disturbances, each of another kind, and along pieces of power as a path has them.
TEST(FlightOutcome, FlyDisturbancesAndPieces) {
    auto mission = flown_mission(2, 1.0);
    const double cruise_s = mission.setup.duration_s[Phase::cruise];
    mission.setup.measured_power[Phase::cruise] = std::make_shared<const path::PiecewisePower>(
        path::PiecewisePower{{0.0, 0.3 * cruise_s, cruise_s}, {0.0, 6.0 * cruise_s, 27.0 * cruise_s}});
    Disturbance gust{20.0, 90.0, 1.3};
    Disturbance drop{100.0, 200.0};
    drop.soc_drop_percent = 3.0;
    auto segments = disturbed(load_segments(mission.setup, mission.schedule), {gust, drop});
    battery::Discharge alone{{100.0}};
    for (const auto& segment : segments)
        alone = advance_segment(mission.setup.battery, mission.setup.cutoff_voltage_v, segment, alone);
    EXPECT_NEAR(simulate_flight({mission.setup, segments}).final_soc_percent, alone.soc_percent, 1e-8);
    const auto exact = simulate(mission.setup, mission.schedule, {60.0, 0.25}, {gust, drop}).summary;
    EXPECT_NEAR(alone.soc_percent, exact.final_soc_percent.value(), 1e-3);
}

}  // namespace
}  // namespace flightwatt::mission
