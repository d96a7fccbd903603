#include "mission/simulation/least_power.h"

#include "helpers/paper_missions.h"
#include "helpers/rejected.h"
#include "mission/prepared_mission.h"
#include "mission/sampled_flights.h"
#include "mission/sampling/flight_draws.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

TEST(LeastPower, IsThatOfAFineGrid) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < 50; ++i) {
        const mechanical::FourierModel curve{0.2 + 0.1 * uniform(random),
                                             1.0,
                                             {uniform(random), uniform(random), uniform(random)},
                                             {uniform(random), uniform(random), uniform(random)}};
        const CurveInterval within{5.0 * (1.0 + uniform(random)), 40.0 + 20.0 * uniform(random)};
        double min_w = 1e9;
        for (int k = 0; k <= 100000; ++k) {
            const double time_s = within.start_s + (within.end_s - within.start_s) * k / 100000.0;
            min_w = std::min(min_w, power_w(curve, time_s));
        }
        const auto least = min_power_w(curve, within, 1e9);
        EXPECT_NEAR(least.power_w, min_w, 1e-6);
        EXPECT_NEAR(power_w(curve, least.time_s), least.power_w, 1e-12);
    }
}

/// The paper's mission with a landing that takes power back.
Mission with_negative_landing() {
    auto mission = test::paper_mission("mechanical-only");
    mission.file = "m.toml";
    mission.mechanical->phases[Phase::landing].fourier = {0.05, -2.0, {1.0}, {0.0}};
    return mission;
}

TEST(Charging, IsRefusedUnlessItIsMeant) {
    auto mission = with_negative_landing();
    const auto text = test::rejected([&] { simulate(mission); });
    EXPECT_EQ(text.substr(0, text.find(';')),
              "m.toml: mechanical-only: 60.0 s into the landing it draws -2.99 W (-2.99 W mechanical, 0 W computing), "
              "which charges the battery in flight");
    EXPECT_THROW(simulate_prepared(prepare_mission(mission)), InputError);
    mission.may_charge = true;
    EXPECT_TRUE(simulate(mission).summary.feasible);
    mission.may_charge = false;
    mission.compute.components.push_back({"camera", compute::make_power_profile("p", {}, {{{}, 5.0, {}}})});
    for (auto& segment : mission.schedule) segment.run = {{0, {}}};
    EXPECT_TRUE(simulate(mission).summary.feasible) << "with what computes, nothing charges";
}

TEST(Charging, IsAskedForByADisturbance) {
    const auto mission = test::paper_mission("mechanical-only");
    Disturbance sun;
    sun.compute_w = -100.0;
    EXPECT_GT(*simulate(mission, {}, {sun}).summary.final_soc_percent, 99.0);
}

TEST(Charging, HappensInNoFlightThatIsDrawn) {
    auto mission = test::paper_mission("mechanical-only");
    for (const auto phase : flight::all_phases) mission.uncertainty.level_sd_percent[phase] = 60.0;
    mission.phase_clock = mechanical::PhaseTimeScaling::absolute;
    const auto spreads = collect_uncertainty(mission);
    double mean_w = 0.0;
    constexpr int flights = 4000;
    for (std::uint64_t i = 0; i < flights; ++i) {
        auto flight = Mission{draw_flight(mission, spreads, 1, i), mission.schedule};
        for (const auto& segment : load_segments(flight, flight.schedule))
            EXPECT_GE(min_power_w(*segment.mechanical, {0.0, segment.end_s - segment.phase_start_s}).power_w, -1e-9);
        const auto& cruise = flight.mechanical->phases[Phase::cruise].fourier;
        mean_w += energy_j(cruise, 600.0) / 600.0 / flights;
    }
    const auto& stated = mission.mechanical->phases[Phase::cruise].fourier;
    const double stated_w = energy_j(stated, 600.0) / 600.0;
    // A normal number that stops at 0: 5 % of the flights are there.
    EXPECT_NEAR(mean_w / stated_w, 1.0 + 0.6 * 0.0212, 0.03);
}

}  // namespace
}  // namespace flightwatt::mission
