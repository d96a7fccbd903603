#include "mechanical/validation_score.h"

#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

using flight::Phase;

/// A cruise of that energy, predicted with a standard deviation that 30 degrees of freedom tell (none: unknown).
ValidatedFlight cruise(double measured_wh, double predicted_wh, std::optional<double> sd_wh) {
    ValidatedFlight flight;
    flight.measured_wh[Phase::cruise] = measured_wh;
    EnergyEstimate estimate;
    estimate.energy_wh = predicted_wh;
    estimate.uncertainty_known = sd_wh.has_value();
    if (sd_wh) add_share(estimate, {*sd_wh * *sd_wh, 30.0});
    FlightPrediction prediction;
    prediction.model = "fourier";
    prediction.phases[Phase::cruise] = estimate;
    flight.predictions.push_back(prediction);
    return flight;
}

TEST(ScoreOf, AveragesTheErrorsOfTheFlights) {
    const std::vector flights{cruise(4.0, 4.2, 0.2), cruise(5.0, 4.9, 0.2), cruise(4.0, 5.0, 0.2)};
    const auto score = score_of(flights, "fourier", Phase::cruise).value();
    EXPECT_EQ(score.flights, 3U);
    EXPECT_NEAR(score.mean_absolute_error_wh, (0.2 + 0.1 + 1.0) / 3.0, 1e-12);
    EXPECT_NEAR(score.bias_wh, (0.2 - 0.1 + 1.0) / 3.0, 1e-12);
    EXPECT_NEAR(score.mean_absolute_error_percent.value(), (5.0 + 2.0 + 25.0) / 3.0, 1e-9);
    EXPECT_NEAR(score.coverage_95.value(), 2.0 / 3.0, 1e-12) << "+-0.41 Wh";
}

TEST(ScoreOf, HasNoCoverageWithoutIntervals) {
    const std::vector flights{cruise(4.0, 4.2, {}), cruise(5.0, 4.9, {})};
    EXPECT_FALSE(score_of(flights, "fourier", Phase::cruise)->coverage_95);
}

TEST(ScoreOf, HasNoPercentOfLandings) {
    auto landing = cruise(4.0, 4.2, 0.2);
    landing.measured_wh[Phase::landing] = landing.measured_wh[Phase::cruise];
    landing.predictions[0].phases[Phase::landing] = landing.predictions[0].phases[Phase::cruise];
    const std::vector flights{landing};
    EXPECT_FALSE(score_of(flights, "fourier", Phase::landing)->mean_absolute_error_percent);
    EXPECT_TRUE(score_of(flights, "fourier", Phase::cruise)->mean_absolute_error_percent);
}

TEST(ScoreOf, IsOfTheModelsThatPredictedAllThatAnotherDid) {
    auto flights = std::vector{cruise(4.0, 4.2, 0.2), cruise(5.0, 4.9, 0.2)};
    EXPECT_FALSE(score_of(flights, "constant_mean", Phase::cruise));
    EXPECT_FALSE(score_of(flights, "fourier", Phase::takeoff)) << "no flight has one";
    flights[0].predictions.push_back(flights[0].predictions[0]);
    flights[0].predictions[1].model = "airspeed_cubed";
    EXPECT_FALSE(score_of(flights, "airspeed_cubed", Phase::cruise)) << "the second flight was not predicted";
    EXPECT_THAT(model_names(flights), testing::ElementsAre("fourier", "airspeed_cubed"));
}

TEST(PredictedEnergy, OfTheWholeIsTheSumOfWhatWasMeasured) {
    auto flight = cruise(4.0, 4.2, 0.3);
    flight.measured_wh[Phase::takeoff] = 0.25;
    EXPECT_FALSE(predicted_energy(flight, "fourier", std::nullopt)) << "the take-off was not predicted";
    auto takeoff = *flight.predictions[0].phases[Phase::cruise];
    takeoff.energy_wh = 0.2;
    takeoff.variance_wh2 = 0.16;
    flight.predictions[0].phases[Phase::takeoff] = takeoff;
    flight.predictions[0].phases[Phase::landing] = takeoff;  // not measured, so not asked for
    const auto energy = predicted_energy(flight, "fourier", std::nullopt).value();
    EXPECT_DOUBLE_EQ(energy.measured_wh, 4.25);
    EXPECT_DOUBLE_EQ(energy.estimate.energy_wh, 4.4);
    EXPECT_DOUBLE_EQ(energy.estimate.variance_wh2, 0.09 + 0.16);
    EXPECT_FALSE(predicted_energy(flight, "nearest_flight", std::nullopt));
}

}  // namespace
}  // namespace flightwatt::mechanical
