#include "helpers/path_missions.h"
#include "mission/feasibility_limits.h"
#include "mission/sampled_flights.h"
#include "mission/simulation.h"
#include "mission/simulation/load_segments.h"
#include "path/cruise_path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using path::Circles;
using path::Hold;
using path::Leg;
using path::Wind;
using test::path_element;
using test::path_mission;

const path::FlightPath up_and_on{{path_element(Leg{1300.0, 0.0}), path_element(Hold{50.0}, 13.0, 50.0),
                                  path_element(Leg{1400.0, 90.0}, 14.0), path_element(Leg{700.0, 0.0}, 14.0)}};

TEST(MissionOnAPath, IsFlownBySimulation) {
    const auto mission = path_mission(up_and_on);
    const auto flown = simulate(mission);
    const double energy_wh = energy_j(*mission.setup.cruise_path) / 3600.0;
    EXPECT_NEAR(flown.summary.mechanical_energy_wh, energy_wh, 1e-9);
    EXPECT_NEAR(*flown.summary.final_soc_percent, 100.0 - energy_wh / 10.0 * 100.0, 1e-9);  // 10 V, 1 Ah
    const auto is_jump = [](const SocRow& a, const SocRow& b) {
        return a.time_s == b.time_s && a.power_w != b.power_w;
    };
    EXPECT_EQ(std::adjacent_find(flown.curve.rows.begin(), flown.curve.rows.end(), is_jump)->time_s, 100.0);
    // Disturbed in the middle of a piece, and across two.
    Disturbance gust;
    gust.start_s = 90.0;
    gust.end_s = 110.0;
    gust.mechanical_w = 3.0;
    EXPECT_NEAR(simulate(mission, {}, {gust}).summary.mechanical_energy_wh, energy_wh + 60.0 / 3600.0, 1e-9);
}

/// Integrals of the pieces and Runge-Kutta agree.
TEST(MissionOnAPath, IsIntegratedAsItIsSimulated) {
    auto mission = path_mission({{path_element(Leg{1300.0, 0.0}), path_element(Circles{60.0, 3.3}),
                                  path_element(Leg{900.0, 200.0}, 14.5, 70.0)}},
                                {5.0, 30.0});
    mission.setup.battery.resistance_ohm = 0.2;
    ASSERT_GT(mission.setup.cruise_path->pieces->time_s.size(), 20U);
    const double simulated = *simulate(mission).summary.final_soc_percent;
    battery::Discharge state{{mission.setup.initial_soc_percent}};
    for (const auto& segment : load_segments(mission.setup, mission.schedule))
        state = advance_segment(mission.setup.battery, 0.0, segment, state);
    EXPECT_NEAR(state.soc_percent, simulated, 1e-7);
}

TEST(MissionOnAPath, DiffersWithTheWind) {
    auto mission =
        path_mission({{path_element(Leg{4000.0, 0.0}), path_element(Leg{4000.0, 180.0})}}, {4.0, 0.0, 1.5, 20.0});
    mission.setup.uncertainty.level_sd_percent = {{0.0, 0.0, 0.0}};
    const auto drawn =
        sample_flights({mission.setup, mission.schedule, std::nullopt, ScheduleOrigin::given}, {}, {4000, 7, 0});
    // By the same numbers, flown one by one.
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    double sum = 0.0;
    double square_sum = 0.0;
    constexpr int flights = 4000;
    for (int i = 0; i < flights; ++i) {
        const Wind wind{std::max(0.0, 4.0 + 1.5 * normal(random)), 20.0 * normal(random)};
        const auto flown = compute_cruise(mission.setup.cruise_path->plan, wind, path::InfeasibleLegPolicy::refuse);
        const double final_percent = 100.0 - energy_j(flown) / 3600.0 * 10.0;
        sum += final_percent;
        square_sum += final_percent * final_percent;
    }
    const double mean = sum / flights;
    const double sd = std::sqrt(square_sum / flights - mean * mean);
    EXPECT_NEAR(drawn.final_soc_mean_percent, mean, 6.0 * sd / std::sqrt(flights));
    EXPECT_NEAR(drawn.final_soc_sd_percent / sd, 1.0, 0.1);
    const std::vector<std::string> expected{"cruise duration (as the path and the wind make it)",
                                            "wind speed (sd 1.5 m/s, stated)",
                                            "wind direction (sd 20 degrees, stated)"};
    EXPECT_EQ(drawn.sources.varied, expected);
    // Where a drawn wind leaves less than 2 % of the airspeed (0.26 m/s) over ground, the flight fails.
    const auto windy = path_mission({{path_element(Leg{40.0, 0.0})}}, {12.0, 0.0, 2.0, 0.0});
    const auto stormy =
        sample_flights({windy.setup, windy.schedule, std::nullopt, ScheduleOrigin::given}, {}, {4000, 7, 0});
    EXPECT_NEAR(stormy.probability_below_reserve, 0.5 * std::erfc(0.37 / std::sqrt(2.0)), 0.025);
}

/// The level moves the power of every piece by the same part.
TEST(MissionOnAPath, DiffersWithTheLevel) {
    auto mission = path_mission(up_and_on);
    mission.setup.uncertainty.level_sd_percent[flight::Phase::cruise] = 5.0;
    const auto drawn =
        sample_flights({mission.setup, mission.schedule, std::nullopt, ScheduleOrigin::given}, {}, {4000, 3, 0});
    const double used = 100.0 - *simulate(mission).summary.final_soc_percent;
    EXPECT_NEAR(drawn.final_soc_sd_percent, 0.05 * used, 0.004 * used);
}

}  // namespace
}  // namespace flightwatt::mission
