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

TEST(FlightDraws, LeaveAloneWhatTheMissionStates) {
    auto mission = test::paper_mission("phased");
    for (const double duration_s : {570.0, 630.0}) {
        mechanical::FlightContribution flight;
        flight.phases[flight::Phase::cruise] = mechanical::PhaseContribution{0.5, duration_s, 1.0, 100};
        mission.mechanical->flights.push_back(flight);
    }
    mission.battery.intervals.capacity_ah = battery::Interval{3.0, 3.3};
    EXPECT_GT(find_spreads(mission).duration_sd_s[flight::Phase::cruise], 0.0);
    mission.duration_is_stated[flight::Phase::cruise] = true;
    mission.capacity_is_stated = true;
    auto spreads = find_spreads(mission);
    EXPECT_EQ(spreads.duration_sd_s[flight::Phase::cruise], 0.0);
    EXPECT_EQ(draw_flight(mission, spreads, 1, 1).battery.capacity_ah, mission.battery.capacity_ah);
    const auto said = describe(spreads.sources);
    EXPECT_NE(said.find("not drawn: "), std::string::npos);
    EXPECT_NE(said.find("cruise duration (fixed, as the mission states it without duration_sd_s)"), std::string::npos);
    EXPECT_NE(said.find("capacity (fixed, as the mission states capacity_ah without capacity_sd_percent)"),
              std::string::npos);
    mission.uncertainty.duration_sd_s[flight::Phase::cruise] = 7.0;
    mission.uncertainty.capacity_sd_percent = 2.0;
    spreads = find_spreads(mission);
    EXPECT_EQ(spreads.duration_sd_s[flight::Phase::cruise], 7.0);
    EXPECT_NE(draw_flight(mission, spreads, 1, 1).battery.capacity_ah, mission.battery.capacity_ah);
}

TEST(FlightDraws, CopyFasterWithoutEvidenceAndFlyTheSame) {
    auto mission = test::paper_mission("phased");
    mission.uncertainty.capacity_sd_percent = 2.0;
    mission.compute.components[0].profile.standard_error_w.assign(mission.compute.components[0].profile.power_w.size(),
                                                                  0.2);
    const auto spreads = find_spreads(mission);
    const auto lean = without_evidence(mission);
    EXPECT_EQ(count_normals(lean), count_normals(mission));
    const auto whole = draw_flight(mission, spreads, 3, 4);
    const auto same = draw_flight(lean, spreads, 3, 4);
    EXPECT_EQ(whole.battery.capacity_ah, same.battery.capacity_ah);
    EXPECT_EQ(whole.compute.components[0].profile.power_w, same.compute.components[0].profile.power_w);
    EXPECT_EQ(whole.mechanical->phases[flight::Phase::cruise].fourier.a0_w,
              same.mechanical->phases[flight::Phase::cruise].fourier.a0_w);
}

}  // namespace
}  // namespace flightwatt::mission
