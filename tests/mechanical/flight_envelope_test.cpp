#include "mechanical/flight_envelope.h"

#include "mechanical/fit/flight_weights.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

/// Flights of constant power.
PhaseFit flights_of(const std::vector<double>& powers_w) {
    PhaseFit fit;
    fit.theta_rad = 4.0;
    for (const double power_w : powers_w) {
        fit.flights.push_back({"flight", 100.0, {0.04, power_w, {}, {}}, 0.1, 50});
    }
    return fit;
}

TEST(FlightEnvelope, OfEqualWeightsIsTheUsualStandardDeviation) {
    const auto spread = flight_envelope(flights_of({20.0, 22.0, 24.0, 30.0}), std::vector(4, 0.25), 5);
    ASSERT_TRUE(spread);
    ASSERT_EQ(spread->low_w.size(), 5U);
    const double standard_deviation_w = std::sqrt((16.0 + 4.0 + 0.0 + 36.0) / 3.0);
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_DOUBLE_EQ(spread->low_w[i], 20.0);
        EXPECT_DOUBLE_EQ(spread->high_w[i], 30.0);
        EXPECT_NEAR(spread->standard_deviation_w[i], standard_deviation_w, 1e-12);
        EXPECT_NEAR(population_standard_error_w(*spread, i), standard_deviation_w / 2.0, 1e-12);
    }
    EXPECT_DOUBLE_EQ(spread->counted_flights, 4.0);
}

TEST(FlightEnvelope, AFlightWithoutWeightIsNotInIt) {
    const auto spread = flight_envelope(flights_of({20.0, 22.0, 90.0}), std::vector{0.5, 0.5, 0.0});
    ASSERT_TRUE(spread);
    EXPECT_EQ(spread->low_w.size(), points_of_spread);
    EXPECT_DOUBLE_EQ(spread->high_w[0], 22.0);
    EXPECT_NEAR(spread->standard_deviation_w[0], std::sqrt(2.0), 1e-12);
    EXPECT_FALSE(flight_envelope(flights_of({20.0, 22.0}), std::vector{1.0, 0.0}));
}

TEST(FlightEnvelope, ComparesFlightsAtEqualPartsOfThePhase) {
    PhaseFit fit;
    fit.theta_rad = 4.0;
    for (const double duration_s : {80.0, 120.0}) {
        fit.flights.push_back({"flight", duration_s, {4.0 / duration_s, 25.0, {2.0}, {-1.0}}, 0.1, 50});
    }
    const auto spread = flight_envelope(fit, std::vector{0.5, 0.5});
    for (const double deviation_w : spread->standard_deviation_w) EXPECT_NEAR(deviation_w, 0.0, 1e-12);
    EXPECT_NEAR(spread->high_w.front(), 27.0, 1e-12);
}

}  // namespace
}  // namespace flightwatt::mechanical
