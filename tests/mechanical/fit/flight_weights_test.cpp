
#include "mechanical/fit/flight_weights.h"

#include "helpers/made_up_flights.h"
#include "mechanical/fit/phase_fit.h"
#include "mechanical/mechanical_model.h"

#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

using testing::ElementsAre;

FlightCurve curve_of(const std::string& flight, double a0_w, double rms_w, std::size_t samples) {
    return {flight, 100.0, {0.05, a0_w, {1.0}, {0.5}}, rms_w, samples};
}

/// Flights whose curves differ in their level alone.
PhaseFit fit_with_levels(const std::vector<double>& levels_w) {
    PhaseFit fit;
    fit.theta_rad = 5.0;
    for (std::size_t i = 0; i < levels_w.size(); ++i) {
        fit.flights.push_back(curve_of("f" + std::to_string(i + 1), levels_w[i], 1.0, 100));
    }
    return fit;
}

TEST(FlightWeights, HaveNamesBothWays) {
    for (const auto weighting : {Weighting::uniform, Weighting::agreement}) {
        EXPECT_EQ(weighting_from(to_string(weighting)), weighting);
    }
    EXPECT_EQ(to_string(Weighting::agreement), "agreement");
    EXPECT_FALSE(weighting_from("uniformly"));
}

TEST(FlightWeights, SumToOneWhateverTheWay) {
    const auto fit = fit_phase(flight::Phase::landing, test::record_flights(flight::Phase::landing, 6, 0.2, 1));
    for (const auto weighting : {Weighting::uniform, Weighting::agreement}) {
        const auto weights = flight_weights(fit, weighting);
        ASSERT_EQ(weights.size(), 6U);
        EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0, 1e-14);
        for (const double weight : weights) {
            EXPECT_GE(weight, 0.0);
            EXPECT_LE(weight, 1.0);
        }
    }
}

TEST(FlightWeights, UniformIsTheSameForAll) {
    EXPECT_THAT(flight_weights(fit_with_levels({1, 2, 3, 40}), Weighting::uniform),
                ElementsAre(0.25, 0.25, 0.25, 0.25));
}

TEST(FlightWeights, AgreementIsTheFormulaOfItsDistances) {
    // Levels 0, 1, 5: distances from the mean of the others are 3, 1.5 and 4.5, their squares' median 9.
    const auto weights = flight_weights(fit_with_levels({20, 21, 25}), Weighting::agreement);
    const double sum = 1.0 / 18.0 + 1.0 / 11.25 + 1.0 / 29.25;
    EXPECT_NEAR(weights[0], 1.0 / 18.0 / sum, 1e-12);
    EXPECT_NEAR(weights[1], 1.0 / 11.25 / sum, 1e-12);
    EXPECT_NEAR(weights[2], 1.0 / 29.25 / sum, 1e-12);
}

TEST(FlightWeights, AStrayFlightCountsLittle) {
    const auto weights = flight_weights(fit_with_levels({20.0, 20.1, 19.9, 20.05, 35.0}), Weighting::agreement);
    EXPECT_LT(weights[4], 0.2 * weights[0]);
    EXPECT_NEAR(weights[0], weights[1], 0.05);
}

TEST(FlightWeights, AgreementOfFewOrEqualFlightsIsUniform) {
    EXPECT_THAT(flight_weights(fit_with_levels({20}), Weighting::agreement), ElementsAre(1.0));
    EXPECT_THAT(flight_weights(fit_with_levels({20, 25}), Weighting::agreement), ElementsAre(0.5, 0.5));
    EXPECT_THAT(flight_weights(fit_with_levels({20.1, 20.1, 20.1, 20.1}), Weighting::agreement),
                ElementsAre(0.25, 0.25, 0.25, 0.25));
    // The median distance is 0 and yet some differ: still finite, the odd pair counts less.
    const auto weights = flight_weights(fit_with_levels({20, 20, 20, 19, 21}), Weighting::agreement);
    EXPECT_NEAR(weights[3], weights[4], 1e-12);
    EXPECT_LT(weights[3], weights[0]);
    EXPECT_TRUE(std::isfinite(weights[0]));
}

TEST(FlightWeights, AveragingCoefficientsIsAveragingCurves) {
    for (const auto phase : flight::all_phases) {
        const auto fit = fit_phase(phase, test::record_flights(phase, 5, 0.3, 2));
        const auto weights = flight_weights(fit, Weighting::agreement);
        const auto average = average_phase(fit, weights);
        double duration_s = 0.0;
        for (std::size_t i = 0; i < 5; ++i) duration_s += weights[i] * fit.flights[i].duration_s;
        EXPECT_NEAR(average.duration_s, duration_s, 1e-12 * duration_s);
        EXPECT_NEAR(test::theta_rad(average), fit.theta_rad, 1e-12 * fit.theta_rad);
        const auto curve = curve_w(average.fourier, average.duration_s, 100);
        std::vector<double> expected(100, 0.0);
        for (std::size_t i = 0; i < 5; ++i) {
            const auto own = curve_w(fit.flights[i].fourier, fit.flights[i].duration_s, 100);
            for (std::size_t j = 0; j < 100; ++j) expected[j] += weights[i] * own[j];
        }
        for (std::size_t j = 0; j < 100; ++j) EXPECT_NEAR(curve[j], expected[j], 1e-9);
    }
}

}  // namespace
}  // namespace flightwatt::mechanical
