#include "mission/sampling/flight_draws.h"

#include "helpers/paper_missions.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

TEST(FlightDraws, TakeWhatTheModelsKnow) {
    auto mission = test::paper_mission("phased");
    mission.uncertainty.level_sd_percent = {};
    auto& cruise = mission.mechanical->phases[flight::Phase::cruise];
    cruise.level_spread = mechanical::LevelSpread{3, 1.0, 0.0, 1.0};
    cruise.flights = 3;
    for (const double duration_s : {570.0, 600.0, 630.0}) {
        mechanical::FlightContribution flight;
        flight.phases[flight::Phase::cruise] = mechanical::PhaseContribution{1.0 / 3.0, duration_s, 1.0, 100};
        mission.mechanical->flights.push_back(flight);
    }
    auto& detection = mission.compute.components[0].profile;
    detection.standard_error_w.assign(detection.power_w.size(), 0.5);
    mission.battery.intervals.capacity_ah = battery::Interval{3.0, 3.3};
    const auto spreads = find_spreads(mission);
    const double new_flight = std::sqrt(1.0 + 1.0 / 3.0);
    EXPECT_NEAR(spreads.level_sd_w[flight::Phase::cruise], new_flight, 1e-12);
    EXPECT_NEAR(spreads.duration_sd_s[flight::Phase::cruise], 30.0 * new_flight, 1e-9);
    double capacity_below = 0.0;
    double power_square_sum = 0.0;
    constexpr int flights = 4000;
    for (int i = 0; i < flights; ++i) {
        const auto flight = draw_flight(mission, spreads, 1, static_cast<std::uint64_t>(i));
        capacity_below += flight.battery.capacity_ah < 3.0 ? 1.0 : 0.0;
        const double off_w = flight.compute.components[0].profile.power_w[0] - detection.power_w[0];
        power_square_sum += off_w * off_w;
    }
    EXPECT_NEAR(capacity_below / flights, 0.025, 0.01) << "each side of the interval has 2.5 %";
    EXPECT_NEAR(std::sqrt(power_square_sum / flights), 0.5, 0.025);
}

}  // namespace
}  // namespace flightwatt::mission
