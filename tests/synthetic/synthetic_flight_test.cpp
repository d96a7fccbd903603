#include "synthetic/synthetic_flight.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace flightwatt::synthetic {
namespace {

using flight::Phase;

SyntheticFlight flight_at(double power_w) {
    SyntheticFlight flight;
    flight.power_w = [power_w](Phase, double) { return power_w; };
    return flight;
}

double height_m(const SyntheticFlight& flight, double time_s) {
    return state_at(flight, time_s).altitude_m - flight.ground_altitude_m;
}

TEST(SyntheticFlight, PhasesFollowOneAnotherFromLiftOff) {
    const auto flight = flight_at(27.0);
    EXPECT_EQ(flight.start_s(Phase::takeoff), flight.lift_off_s);
    EXPECT_EQ(flight.start_s(Phase::cruise), flight.end_s(Phase::takeoff));
    EXPECT_EQ(flight.start_s(Phase::landing), flight.end_s(Phase::cruise));
    EXPECT_EQ(flight.log_end_s(), flight.end_s(Phase::landing) + flight.ground_after_s);
}

TEST(StateAt, StandsClimbsHoldsItsHeightAndLands) {
    const auto flight = flight_at(27.0);
    EXPECT_EQ(height_m(flight, 0.0), 0.0);
    EXPECT_EQ(height_m(flight, flight.log_end_s()), 0.0);
    const double cruise_s = flight.start_s(Phase::cruise);
    for (double time_s = cruise_s + 30.0; time_s < flight.end_s(Phase::cruise) - 30.0; time_s += 1.0) {
        ASSERT_NEAR(height_m(flight, time_s), flight.height_m, 0.01 * flight.height_m) << time_s;
    }
    EXPECT_GT(state_at(flight, flight.lift_off_s + 10.0).climb_m_per_s, 1.0);
    EXPECT_LT(state_at(flight, flight.start_s(Phase::landing) + 10.0).climb_m_per_s, -0.5);
}

/// Neither height nor power of an ordinary flight jumps; its motor switches on and off on the ground alone.
TEST(StateAt, IsContinuousInTheAir) {
    const auto flight = flight_at(27.0);
    constexpr double step_s = 0.1;
    for (double time_s = flight.lift_off_s; time_s < flight.end_s(Phase::landing); time_s += step_s) {
        ASSERT_NEAR(height_m(flight, time_s), height_m(flight, time_s + step_s), 1.5) << time_s;
        ASSERT_NEAR(state_at(flight, time_s).power_w, 27.0, 1e-9) << time_s;
    }
}

TEST(StateAt, TakesThePhasesPower) {
    auto flight = flight_at(0.0);
    flight.power_w = [](Phase phase, double tau) { return phase == Phase::cruise ? 20.0 + tau : 50.0; };
    const double middle_s = 0.5 * (flight.start_s(Phase::cruise) + flight.end_s(Phase::cruise));
    EXPECT_NEAR(state_at(flight, middle_s).power_w, 20.5, 1e-9);
    EXPECT_EQ(state_at(flight, flight.lift_off_s + 5.0).power_w, 50.0);
    EXPECT_EQ(state_at(flight, flight.motor_run_up_s + 1.0).power_w, flight.motor_run_up_power_w);
    EXPECT_EQ(state_at(flight, 0.0).power_w, 0.0);
    EXPECT_EQ(state_at(flight, flight.log_end_s()).power_w, 0.0);
}

TEST(StateAt, FliesCirclesAtItsAirspeedInTheWind) {
    const auto flight = flight_at(27.0);
    double fastest = 0.0;
    double slowest = 1e9;
    for (double time_s = flight.start_s(Phase::cruise); time_s < flight.end_s(Phase::cruise); time_s += 0.5) {
        const auto state = state_at(flight, time_s);
        EXPECT_EQ(state.airspeed_m_per_s, flight.airspeed_m_per_s);
        fastest = std::max(fastest, state.ground_speed_m_per_s);
        slowest = std::min(slowest, state.ground_speed_m_per_s);
    }
    const double wind = std::hypot(flight.wind_east_m_per_s, flight.wind_north_m_per_s);
    EXPECT_NEAR(fastest, flight.airspeed_m_per_s + wind, 0.05);
    EXPECT_NEAR(slowest, flight.airspeed_m_per_s - wind, 0.05);
}

TEST(Hazards, HaveNamesOfTheirOwn) {
    const std::set<std::string> names(anomaly_names().begin(), anomaly_names().end());
    EXPECT_EQ(names.size(), 10U);
    EXPECT_EQ(anomaly_names().size(), 10U);
}

TEST(ScenarioWith, ChangesWhatTheHazardSays) {
    const auto flight = flight_at(27.0);
    const auto plain = make_scenario(flight);
    EXPECT_EQ(plain.flights.size(), 1U);
    EXPECT_EQ(plain.end_s, flight.log_end_s());
    const auto two = make_scenario(flight, "two-sorties");
    ASSERT_EQ(two.flights.size(), 2U);
    EXPECT_GT(two.flights[1].lift_off_s, plain.end_s);
    EXPECT_EQ(two.end_s, two.flights[1].log_end_s());
    EXPECT_GT(make_scenario(flight, "begins-in-the-air").begin_s, flight.start_s(Phase::cruise));
    EXPECT_LT(make_scenario(flight, "ends-in-the-air").end_s, flight.end_s(Phase::cruise));
    EXPECT_EQ(make_scenario(flight, "dives-in-cruise").flights[0].dives_s.size(), 4U);
}

TEST(ScenarioWith, DivesLowAndComesUpAgain) {
    const auto flight = make_scenario(flight_at(27.0), "dives-in-cruise").flights[0];
    const double dive_s = flight.dives_s[0];
    EXPECT_LT(height_m(flight, dive_s + 10.0), 0.4 * flight.height_m);
    EXPECT_EQ(state_at(flight, dive_s + 1.0).throttle_percent, 0.0);
    EXPECT_EQ(state_at(flight, dive_s + 10.0).throttle_percent, 100.0);
    EXPECT_NEAR(height_m(flight, dive_s + 60.0), flight.height_m, 0.01 * flight.height_m);
}

}  // namespace
}  // namespace flightwatt::synthetic
