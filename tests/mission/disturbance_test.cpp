#include "mission/disturbance.h"

#include "mission/simulation.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

const flight::PerPhase<double> durations{{100.0, 600.0, 50.0}};

/// 100 % are 10 Wh, or 36 kJ; 15 W to compute and 5 W mechanical over 1000 s take 55.6 points.
Mission steady_flight() {
    Mission mission;
    mission.name = "steady";
    mission.duration_s[flight::Phase::cruise] = 1000.0;
    mission.battery = {"", 10.0, 0.0, 1.0};
    mission.compute.components.push_back({"load", compute::make_power_profile("load", {}, {{{}, 15.0, {}}})});
    mission.schedule = {{flight::Phase::cruise, 0.0, 1000.0, {{0, {}}}}};
    mission.mechanical = mechanical::MechanicalModel();
    mission.mechanical->phases[flight::Phase::cruise].fourier = {0.01, 5.0, {}, {}};
    mission.mechanical->phases[flight::Phase::cruise].duration_s = 1000.0;
    return mission;
}

double final_soc(const std::vector<Disturbance>& disturbances) {
    return *simulate(steady_flight(), {}, disturbances).summary.final_soc_percent;
}

TEST(Disturbance, ChangesTheDepletion) {
    const double calm = 100.0 - 20.0 * 1000.0 / 360.0;
    Disturbance wind;
    wind.start_s = 200.25;
    wind.end_s = 700.25;
    wind.mechanical_factor = 1.4;
    EXPECT_NEAR(final_soc({wind}), calm - 2.0 * 500.0 / 360.0, 1e-9);
    Disturbance load;
    load.compute_factor = 2.0;
    load.compute_w = -1.0;
    EXPECT_NEAR(final_soc({load}), calm - 14.0 * 1000.0 / 360.0, 1e-9);
    EXPECT_NEAR(final_soc({wind, wind}), calm - (1.96 - 1.0) * 5.0 * 500.0 / 360.0, 1e-9);
    Disturbance weak;
    weak.capacity_factor = 0.8;
    EXPECT_NEAR(final_soc({weak}), 100.0 - 20.0 * 1000.0 / 360.0 / 0.8, 1e-9);
    for (const double at_s : {0.0, 333.3, 500.0}) {
        Disturbance drop;
        drop.start_s = at_s;
        drop.soc_drop_percent = 3.0;
        EXPECT_NEAR(final_soc({drop}), calm - 3.0, 1e-9) << at_s;
    }
}

TEST(Disturbance, DropsBelowEmptyEndTheFlight) {
    Disturbance drop;
    drop.start_s = 400.0;
    drop.soc_drop_percent = 90.0;
    const auto summary = simulate(steady_flight(), {}, {drop}).summary;
    EXPECT_EQ(summary.depleted_at_s, 400.0);
    EXPECT_FALSE(summary.feasible);
}

TEST(Disturbance, KeepsToItsPartOfAPhase) {
    Disturbance wind;
    wind.start_s = 400.0;
    wind.end_s = 725.0;
    const auto moved = rescale_to_flown_durations({wind}, durations, {{100.0, 900.0, 25.0}}).front();
    EXPECT_DOUBLE_EQ(moved.start_s, 550.0);
    EXPECT_DOUBLE_EQ(moved.end_s, 1012.5);
}

}  // namespace
}  // namespace flightwatt::mission
