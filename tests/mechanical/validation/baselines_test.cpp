#include "mechanical/validation/baselines.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

PhaseSamples constant(double power_w, double duration_s) {
    return {"constant", duration_s, {0.0, 0.5, 1.0}, {power_w, power_w, power_w}};
}

TEST(Baselines, ConstantMeanIsThatOfTheFlights) {
    const std::vector flights{constant(20.0, 600.0), constant(22.0, 60.0), constant(27.0, 900.0)};
    const auto power = constant_mean(flights);
    EXPECT_DOUBLE_EQ(power.mean_w, 23.0);
    EXPECT_NEAR(power.sd_w.value(), std::sqrt(13.0 * 4.0 / 3.0), 1e-12);
    EXPECT_DOUBLE_EQ(power.degrees_of_freedom, 2.0);
    EXPECT_NEAR(energy_of(power, 360.0).energy_wh, 2.3, 1e-12);
    EXPECT_NEAR(energy_of(power, 360.0).variance_wh2, 0.01 * 13.0 * 4.0 / 3.0, 1e-12);
}

TEST(Baselines, OneFlightHasNoInterval) {
    const std::vector flights{constant(20.0, 600.0)};
    EXPECT_FALSE(interval_95(energy_of(constant_mean(flights), 100.0)).has_value());
    EXPECT_FALSE(interval_95(energy_of(single_flight_power(flights, 0), 100.0)).has_value());
}

TEST(Baselines, OneFlightForAnotherIsTwiceAsUncertain) {
    const std::vector flights{constant(20.0, 600.0), constant(22.0, 60.0)};
    EXPECT_DOUBLE_EQ(single_flight_power(flights, 1).mean_w, 22.0);
    EXPECT_NEAR(single_flight_power(flights, 1).sd_w.value(), 2.0, 1e-12);
}

TEST(Baselines, NearestFlightIsByTheDurationsOfCommonPhases) {
    std::vector<FlightSamples> flights(3);
    flights[0].phases[flight::Phase::takeoff] = constant(1.0, 28.0);
    flights[0].phases[flight::Phase::cruise] = constant(1.0, 1200.0);
    flights[1].phases[flight::Phase::cruise] = constant(1.0, 630.0);
    FlightSamples other;
    other.phases[flight::Phase::takeoff] = constant(1.0, 28.0);
    other.phases[flight::Phase::cruise] = constant(1.0, 600.0);
    EXPECT_EQ(nearest_flight(flights, flight::Phase::cruise, other), 1u);
    other.phases[flight::Phase::cruise] = constant(1.0, 1100.0);
    EXPECT_EQ(nearest_flight(flights, flight::Phase::cruise, other), 0u);
    EXPECT_EQ(nearest_flight(flights, flight::Phase::takeoff, other), 0u);
    FlightSamples landing_only;
    landing_only.phases[flight::Phase::landing] = constant(1.0, 60.0);
    EXPECT_FALSE(nearest_flight(flights, flight::Phase::landing, landing_only).has_value());
}

}  // namespace
}  // namespace flightwatt::mechanical
