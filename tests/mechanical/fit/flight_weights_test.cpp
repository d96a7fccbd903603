#include "mechanical/fit/flight_weights.h"

#include "base/error.h"
#include "helpers/made_up_flights.h"
#include "mechanical/fit/phase_fit.h"
#include "mechanical/mechanical_model.h"

#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

using testing::AllOf;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;

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

template <typename Action>
std::string usage_error_of(const Action& action) {
    try {
        action();
    } catch (const UsageError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(FlightWeights, HaveNamesBothWays) {
    for (const auto weighting :
         {Weighting::uniform, Weighting::inverse_variance, Weighting::agreement, Weighting::manual}) {
        EXPECT_EQ(weighting_from(to_string(weighting)), weighting);
    }
    EXPECT_EQ(to_string(Weighting::inverse_variance), "inverse-variance");
    EXPECT_FALSE(weighting_from("uniformly"));
}

TEST(FlightWeights, SumToOneWhateverTheWay) {
    const auto fit = fit_phase(flight::Phase::landing, test::record_flights(flight::Phase::landing, 6, 0.2, 1));
    std::vector<ManualWeight> by_hand;
    for (std::size_t i = 0; i < 6; ++i) by_hand.push_back({fit.flights[i].flight, {}, static_cast<double>(i)});
    for (const auto& options : {WeightOptions{Weighting::uniform, {}}, WeightOptions{Weighting::inverse_variance, {}},
                                WeightOptions{Weighting::agreement, {}}, WeightOptions{Weighting::manual, by_hand}}) {
        const auto weights = flight_weights(fit, flight::Phase::landing, options);
        ASSERT_EQ(weights.size(), 6U);
        EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0, 1e-14);
        for (const double weight : weights) {
            EXPECT_GE(weight, 0.0);
            EXPECT_LE(weight, 1.0);
        }
    }
}

TEST(FlightWeights, UniformIsTheSameForAll) {
    EXPECT_THAT(flight_weights(fit_with_levels({1, 2, 3, 40}), flight::Phase::cruise, {Weighting::uniform, {}}),
                ElementsAre(0.25, 0.25, 0.25, 0.25));
}

TEST(FlightWeights, InverseVarianceGoesWithSamplesAndScatter) {
    PhaseFit fit;
    fit.flights = {curve_of("a", 20, 1.0, 100), curve_of("b", 20, 2.0, 100), curve_of("c", 20, 1.0, 300)};
    const auto weights = flight_weights(fit, flight::Phase::cruise, {Weighting::inverse_variance, {}});
    EXPECT_NEAR(weights[0] / weights[1], 4.0, 1e-12);
    EXPECT_NEAR(weights[2] / weights[0], 3.0, 1e-12);
}

TEST(FlightWeights, InverseVarianceOfAnExactFlightIsFinite) {
    PhaseFit fit;
    fit.flights = {curve_of("a", 20, 0.0, 100), curve_of("b", 20, 1.0, 100)};
    auto weights = flight_weights(fit, flight::Phase::cruise, {Weighting::inverse_variance, {}});
    EXPECT_NEAR(weights[1], 1e-6, 1e-9);
    fit.flights = {curve_of("a", 20, 0.0, 100), curve_of("b", 20, 0.0, 300)};
    weights = flight_weights(fit, flight::Phase::cruise, {Weighting::inverse_variance, {}});
    EXPECT_THAT(weights, ElementsAre(DoubleEq(0.25), DoubleEq(0.75)));
}

TEST(FlightWeights, AgreementIsTheFormulaOfItsDistances) {
    // Levels 0, 1, 5: distances from the mean of the others are 3, 1.5 and 4.5, their squares' median 9.
    const auto weights = flight_weights(fit_with_levels({20, 21, 25}), flight::Phase::cruise, {});
    const double sum = 1.0 / 18.0 + 1.0 / 11.25 + 1.0 / 29.25;
    EXPECT_NEAR(weights[0], 1.0 / 18.0 / sum, 1e-12);
    EXPECT_NEAR(weights[1], 1.0 / 11.25 / sum, 1e-12);
    EXPECT_NEAR(weights[2], 1.0 / 29.25 / sum, 1e-12);
}

TEST(FlightWeights, AStrayFlightCountsLittle) {
    const auto weights = flight_weights(fit_with_levels({20.0, 20.1, 19.9, 20.05, 35.0}), flight::Phase::cruise, {});
    EXPECT_LT(weights[4], 0.2 * weights[0]);
    EXPECT_NEAR(weights[0], weights[1], 0.05);
}

TEST(FlightWeights, AgreementOfFewOrEqualFlightsIsUniform) {
    EXPECT_THAT(flight_weights(fit_with_levels({20}), flight::Phase::cruise, {}), ElementsAre(1.0));
    EXPECT_THAT(flight_weights(fit_with_levels({20, 25}), flight::Phase::cruise, {}), ElementsAre(0.5, 0.5));
    EXPECT_THAT(flight_weights(fit_with_levels({20.1, 20.1, 20.1, 20.1}), flight::Phase::cruise, {}),
                ElementsAre(0.25, 0.25, 0.25, 0.25));
    // The median distance is 0 and yet some differ: still finite, the odd pair counts less.
    const auto weights = flight_weights(fit_with_levels({20, 20, 20, 19, 21}), flight::Phase::cruise, {});
    EXPECT_NEAR(weights[3], weights[4], 1e-12);
    EXPECT_LT(weights[3], weights[0]);
    EXPECT_TRUE(std::isfinite(weights[0]));
}

TEST(FlightWeights, ByHandAreNormalisedAndMayDifferByPhase) {
    const WeightOptions options{Weighting::manual,
                                {{"f1", {}, 3.0}, {"f2", {}, 1.0}, {"f2", flight::Phase::landing, 0.0}}};
    const auto fit = fit_with_levels({20, 25});
    EXPECT_THAT(flight_weights(fit, flight::Phase::cruise, options), ElementsAre(0.75, 0.25));
    EXPECT_THAT(flight_weights(fit, flight::Phase::landing, options), ElementsAre(1.0, 0.0));
}

TEST(FlightWeights, ByHandRefusesWhatDoesNotFitTheFlights) {
    const std::vector<std::string> flights{"20_07_03", "20_07_05"};
    const auto refusal = [&](Weighting weighting, std::vector<ManualWeight> by_hand) {
        return usage_error_of([&] { validate_weights({weighting, std::move(by_hand)}, flights); });
    };
    EXPECT_EQ(refusal(Weighting::manual, {{"20_07_03", {}, 1.0}, {"20_07_05", {}, 0.0}}), "accepted");
    EXPECT_THAT(refusal(Weighting::manual, {{"20_07_30", {}, 1.0}}),
                AllOf(HasSubstr("'20_07_30', which is none of the flights"), HasSubstr("did you mean '20_07_03'")));
    EXPECT_THAT(refusal(Weighting::manual, {{"20_07_03", {}, -1.0}}), HasSubstr("is -1, expected 0 or more"));
    EXPECT_THAT(refusal(Weighting::manual, {{"20_07_03", {}, std::nan("")}}), HasSubstr("expected 0 or more"));
    EXPECT_THAT(refusal(Weighting::manual,
                        {{"20_07_03", flight::Phase::cruise, 1.0}, {"20_07_03", flight::Phase::cruise, 2.0}}),
                HasSubstr("'20_07_03' has two weights in cruise"));
    EXPECT_THAT(refusal(Weighting::uniform, {{"20_07_03", {}, 1.0}}), HasSubstr("exclude each other"));

    const auto fit = fit_with_levels({20, 25});
    EXPECT_THAT(usage_error_of([&] {
                    flight_weights(fit, flight::Phase::cruise, {Weighting::manual, {{"f1", {}, 1.0}}});
                }),
                HasSubstr("'f2' has no weight by hand in cruise"));
    EXPECT_THAT(usage_error_of([&] {
                    flight_weights(fit, flight::Phase::cruise, {Weighting::manual, {{"f1", {}, 0.0}, {"f2", {}, 0.0}}});
                }),
                HasSubstr("every flight's weight by hand is 0 in cruise"));
}

TEST(FlightWeights, AveragingCoefficientsIsAveragingCurves) {
    for (const auto phase : flight::all_phases) {
        const auto fit = fit_phase(phase, test::record_flights(phase, 5, 0.3, 2));
        const auto weights = flight_weights(fit, phase, {});
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
