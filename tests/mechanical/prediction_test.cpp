#include "mechanical/prediction.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "helpers/made_up_flights.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

WeightedPhase forecast(const VarianceComponents& spread) {
    WeightedPhase cruise{test::published_model().phases[flight::Phase::cruise], 0.25};
    cruise.model.level_spread = spread;
    return cruise;
}

/// The rest of a cruise of which so much was flown at a mean power.
RemainingCruise rest_of(const WeightedPhase& cruise, double seconds, double mean_w, double remaining_s,
                        CruisePrior prior = CruisePrior::curve) {
    flight::PerPhase<std::optional<WeightedPhase>> model;
    model[flight::Phase::cruise] = cruise;
    flight::PerPhase<FlownPhase> flown;
    flown[flight::Phase::cruise] = {seconds, units::wh_from_joule(mean_w * seconds)};
    return predict_remaining_flight(model, {}, flown, {{0.0, remaining_s, 0.0}}, prior).phases[flight::Phase::cruise];
}

/// A cruise of these flights' mean powers and weights.
MechanicalModel cruise_of(const std::vector<double>& means_w, const std::vector<double>& weights) {
    MechanicalModel model;
    auto& cruise = model.phases[flight::Phase::cruise];
    cruise = test::published_model().phases[flight::Phase::cruise];
    cruise.samples = 700;
    if (means_w.size() > 1) cruise.level_spread = VarianceComponents{means_w.size(), sample_sd(means_w), 1.0, 50.0};
    for (std::size_t i = 0; i < means_w.size(); ++i) {
        FlightContribution flight;
        flight.phases[flight::Phase::cruise] = PhaseContribution{weights[i], 600.0, 1.0, 100, means_w[i]};
        model.flights.push_back(flight);
    }
    return model;
}

TEST(MeanPower, IsKnownAsFlightsDiffer) {
    const auto power = mean_power(cruise_of({20.0, 22.0, 27.0, 27.0}, {0.25, 0.25, 0.25, 0.25}), flight::Phase::cruise);
    ASSERT_TRUE(power && power->interval);
    EXPECT_DOUBLE_EQ(power->mean_w, 24.0);
    EXPECT_EQ(power->flights, 4U);
    EXPECT_EQ(power->samples, 700U);
    const double half_w = 3.182446 * std::sqrt(38.0 / 3.0) / 2.0;  // by hand: t of 3, sd 3.559, of 4 flights
    EXPECT_NEAR(power->interval->low, 24.0 - half_w, 1e-5);
    EXPECT_NEAR(power->interval->high, 24.0 + half_w, 1e-5);
}

TEST(MeanPower, WeighsAsTheCurveDoes) {
    const auto model = cruise_of({20.0, 28.0}, {0.75, 0.25});
    const auto power = mean_power(model, flight::Phase::cruise);
    ASSERT_TRUE(power && power->interval);
    EXPECT_DOUBLE_EQ(power->mean_w, 22.0);
    const double half_w = student_t_half_width(1.0) * std::sqrt(32.0) * std::sqrt(0.75 * 0.75 + 0.25 * 0.25);
    EXPECT_NEAR(power->interval->high - 22.0, half_w, 1e-9);
    EXPECT_EQ(power->interval->low, 0.0) << "a drone takes no energy back";
    EXPECT_EQ(mean_power(cruise_of({20.0, 28.0}, {1.0, 0.0}), flight::Phase::cruise)->flights, 1U);
    EXPECT_FALSE(mean_power(model, flight::Phase::landing));
}

TEST(MeanPower, OfOneFlightHasNoInterval) {
    auto model = cruise_of({25.0}, {1.0});
    auto& cruise = model.phases[flight::Phase::cruise];
    cruise.rms_w = 3.0;
    cruise.errors = PhaseErrors{};
    cruise.errors->effective_samples = 36.0;
    EXPECT_FALSE(mean_power(model, flight::Phase::cruise)->interval) << "its samples do not show how flights differ";
    model.flights.front().phases[flight::Phase::cruise]->mean_power_w.reset();
    EXPECT_FALSE(mean_power(model, flight::Phase::cruise));
}

TEST(Prediction, BeforeTheFlightIsTheStretchedCurvesEnergyWithStudentsInterval) {
    const auto cruise = forecast({4, 2.0, 1.0, 50.0});
    const auto estimate = predict_before_flight(cruise, 1200.0);
    EXPECT_NEAR(estimate.energy_wh, 2.0 * units::wh_from_joule(energy_j(cruise.model.fourier, 600.0)), 1e-9);
    const double half_wh = student_t_half_width(3.0) * 2.0 * std::sqrt(1.25) * 1200.0 / 3600.0;
    EXPECT_NEAR(interval_95(estimate).value().high, estimate.energy_wh + half_wh, 1e-9);
}

TEST(Prediction, BeforeFlightOfTheRestMissesOnlyTheFlownPart) {
    const auto cruise = forecast({4, 2.0, 1.0, 50.0});
    const auto whole = predict_before_flight(cruise, 600.0);
    const auto rest = predict_remaining_before_flight(cruise, 200.0, 400.0);
    EXPECT_NEAR(whole.energy_wh - rest.energy_wh, units::wh_from_joule(energy_j(cruise.model.fourier, 200.0)), 1e-9);
}

TEST(Prediction, KeepsTheModelWhereFlightsAreAllAlike) {
    const auto cruise = forecast({4, 0.0, 5.0, 1.0});
    const auto rest = rest_of(cruise, 300.0, 40.0, 3000.0);
    EXPECT_LT(rest.gain, 0.01);
    EXPECT_NEAR(rest.energy.energy_wh, predict_remaining_before_flight(cruise, 300.0, 3000.0).energy_wh, 0.1);
}

TEST(Prediction, TakesTheFlightsOwnLevelWhereFlightsDifferAndDoNotDrift) {
    const auto cruise = forecast({4, 5.0, 1e-3, 1.0});
    const auto rest = rest_of(cruise, 300.0, 40.0, 300.0);
    EXPECT_NEAR(rest.gain, 1.0, 1e-6);
    EXPECT_NEAR(rest.remaining_mean_w - 40.0,
                2.0 * units::joule_from_wh(predict_remaining_before_flight(cruise, 300.0, 300.0).energy_wh) / 600.0 -
                    rest.expected_w,
                1e-3);
    EXPECT_NEAR(rest.remaining_mean_w + rest.beyond_w - 40.0,
                units::joule_from_wh(predict_before_flight(cruise, 600.0).energy_wh) / 600.0 - rest.expected_w, 1e-3)
        << "a longer cruise does not stay at the power of the end of the curve";
}

TEST(Prediction, ShrinksByTheVariances) {
    // B^2 = 4; the mean of 300 s drifts by V = 4 too, and without a relevant correlation.
    const double correlation_s = 0.01;
    const double sd_w = 2.0 / std::sqrt(2.0 * correlation_s / 300.0);
    const auto cruise = forecast({4, 2.0, sd_w, correlation_s});
    const auto rest = rest_of(cruise, 300.0, 40.0, 900.0);
    EXPECT_NEAR(rest.gain, 0.5, 1e-4);
    const double hours = 900.0 / 3600.0;
    const double variance_w2 = rest.energy.variance_wh2 / hours / hours;
    // 1 + 1/4 times: B^2 / 4 for the level, V / 3 + V / 4 for the drift (C is 0), and the gain's variance
    // (B^2 V / (B^2 + V)^2)^2 (2/3 + 2/3) on the variance 8 of what was seen.
    EXPECT_NEAR(variance_w2, 1.25 * (1.0 + 4.0 / 3.0 + 1.0 + 8.0 / 16.0 * 4.0 / 3.0), 1e-3);
    // Each of the three rests on 4 flights.
    EXPECT_NEAR(rest.energy.satterthwaite_sum / std::pow(hours, 4),
                1.25 * 1.25 * (1.0 + std::pow(7.0 / 3.0, 2) + std::pow(2.0 / 3.0, 2)) / 3.0, 2e-3);
}

TEST(Prediction, IntervalNarrowsAsTheFlightGoesOn) {
    const auto cruise = forecast({4, 5.0, 8.0, 60.0});
    double last_wh = 1e9;
    for (const double seconds : {10.0, 100.0, 300.0, 600.0, 890.0}) {
        const auto rest = rest_of(cruise, seconds, 30.0, 900.0 - seconds);
        const auto interval = interval_95(rest.energy).value();
        EXPECT_LT(interval.high - interval.low, last_wh) << seconds;
        last_wh = interval.high - interval.low;
    }
}

TEST(Prediction, HoldsOneLevelWhereAsked) {
    const auto cruise = forecast({4, 5.0, 1e-3, 1.0});
    const auto rest = rest_of(cruise, 300.0, 40.0, 300.0, CruisePrior::constant);
    EXPECT_NEAR(rest.remaining_mean_w, 40.0, 1e-3);
    const double mean_w = energy_j(cruise.model.fourier, 600.0) / 600.0;
    EXPECT_NEAR(rest.expected_w, mean_w, 1e-9);
    // The curve, if it is right after all, differs by so much in the two halves.
    const double shape_wh = units::wh_from_joule(2.0 * (mean_w * 300.0 - energy_j(cruise.model.fourier, 300.0)));
    EXPECT_NEAR(rest.energy.variance_wh2, shape_wh * shape_wh, 1e-4 * shape_wh * shape_wh);
}

TEST(Prediction, SaysWhenTheModelHasNoSpread) {
    const WeightedPhase cruise{test::published_model().phases[flight::Phase::cruise], 1.0};
    EXPECT_THROW(rest_of(cruise, 300.0, 20.0, 900.0), NoResultError);
    EXPECT_FALSE(interval_95(predict_before_flight(cruise, 600.0)).has_value());
}

TEST(Prediction, OfNothingLeftIsNothing) {
    const auto rest = rest_of(forecast({4, 2.0, 1.0, 50.0}), 300.0, 40.0, 0.0);
    EXPECT_DOUBLE_EQ(rest.energy.energy_wh, 0.0);
    EXPECT_DOUBLE_EQ(rest.energy.variance_wh2, 0.0);
}

flight::PerPhase<std::optional<WeightedPhase>> three_phases() {
    flight::PerPhase<std::optional<WeightedPhase>> model;
    for (const auto phase : flight::all_phases) {
        model[phase] = {test::published_model().phases[phase], 0.0};
        model[phase]->model.level_spread = VarianceComponents{1000, 2.0, 1e-3, 1.0};
    }
    return model;
}

PhaseCorrelations all_correlated(double correlation) {
    PhaseCorrelations all;
    for (const auto a : flight::all_phases)
        for (const auto b : flight::all_phases) all[a][b] = a == b ? 1.0 : correlation;
    return all;
}

/// A flight that needs more for its take-off needs as much more later, if phases vary together.
TEST(RemainingFlight, IsUpdatedByThePhasesFlown) {
    const auto model = three_phases();
    const double takeoff_s = model[flight::Phase::takeoff]->model.duration_s;
    const double usual_j = energy_j(model[flight::Phase::takeoff]->model.fourier, takeoff_s);
    flight::PerPhase<FlownPhase> flown;
    flown[flight::Phase::takeoff] = {takeoff_s, units::wh_from_joule(usual_j + 3.0 * takeoff_s)};
    const flight::PerPhase<double> ahead_s{{0.0, 600.0, 30.0}};
    // A second of the take-off may have been cruise: its mean power is known as well as its 2 W differ between flights.
    const auto& cruise = model[flight::Phase::cruise]->model;
    const double boundary_w = (usual_j / takeoff_s - energy_j(cruise.fourier, 600.0) / 600.0) / takeoff_s;
    const double part = 4.0 / (4.0 + boundary_w * boundary_w);
    const auto apart = predict_remaining_flight(model, all_correlated(0.0), flown, ahead_s, CruisePrior::curve);
    const auto together = predict_remaining_flight(model, all_correlated(0.9), flown, ahead_s, CruisePrior::curve);
    for (const auto phase : {flight::Phase::cruise, flight::Phase::landing}) {
        const double seconds = ahead_s[phase];
        const double before_wh = predict_before_flight(*model[phase], seconds).energy_wh;
        EXPECT_NEAR(apart.phases[phase].energy.energy_wh, before_wh, 1e-9);
        EXPECT_NEAR(together.phases[phase].energy.energy_wh - before_wh,
                    units::wh_from_joule(0.9 * 3.0 * seconds * part), 1e-6);
        // 2 W of which a correlation of 0.9 leaves sqrt(1 - 0.81), and its own error of 0.19 / sqrt(1002).
        EXPECT_NEAR(std::sqrt(together.phases[phase].energy.variance_wh2) * 3600.0 / seconds, 2.0 * std::sqrt(0.19),
                    0.01);
    }
    EXPECT_NEAR(together.total.energy_wh,
                together.phases[flight::Phase::cruise].energy.energy_wh +
                    together.phases[flight::Phase::landing].energy.energy_wh,
                1e-12);
}

TEST(RemainingFlight, PhasesThatVaryTogetherAddTheirDeviations) {
    const auto model = three_phases();
    const flight::PerPhase<double> ahead_s{{60.0, 600.0, 30.0}};
    for (const auto& [correlation, deviation_s] : {std::pair{0.0, std::hypot(60.0, 600.0, 30.0)}, {1.0, 690.0}}) {
        const auto correlations = all_correlated(correlation);
        const auto rest = predict_remaining_flight(model, correlations, {}, ahead_s, CruisePrior::curve);
        EXPECT_NEAR(std::sqrt(rest.total.variance_wh2), 2.0 * deviation_s / 3600.0, 1e-6) << correlation;
        flight::PerPhase<std::optional<EnergyEstimate>> parts;
        for (const auto phase : flight::all_phases) parts[phase] = predict_before_flight(*model[phase], ahead_s[phase]);
        EXPECT_NEAR(sum_of(parts, correlations).variance_wh2, rest.total.variance_wh2, 1e-9) << correlation;
    }
}

/// r of all flights, as if three more had shown no correlation; none of two.
TEST(RemainingFlight, CorrelationsOfFewFlightsAreShrunk) {
    std::vector<flight::PerPhase<std::optional<double>>> powers{
        {{1.0, 10.0, {}}}, {{2.0, 20.0, {}}}, {{3.0, 30.0, 5.0}}};
    const auto found = correlate_phases(powers);
    EXPECT_NEAR(found[flight::Phase::takeoff][flight::Phase::cruise], 2.0 / 5.0, 1e-12);
    EXPECT_DOUBLE_EQ(found[flight::Phase::takeoff][flight::Phase::landing], 0.0);
    powers.pop_back();
    EXPECT_DOUBLE_EQ(correlate_phases(powers)[flight::Phase::takeoff][flight::Phase::cruise], 0.0);
}

EnergyEstimate estimate(double energy_wh, double variance_wh2, double degrees_of_freedom) {
    EnergyEstimate result{energy_wh, true, 0.0, 0.0};
    add_variance(result, variance_wh2, degrees_of_freedom);
    return result;
}

TEST(EnergyEstimate, HasAnIntervalOfItsOneShare) {
    const auto interval = interval_95(estimate(10.0, 4.0, 5.0)).value();
    EXPECT_NEAR(interval.low, 10.0 - 2.0 * 2.5706, 1e-3);
    EXPECT_NEAR(interval.high, 10.0 + 2.0 * 2.5706, 1e-3);
    EXPECT_TRUE(interval.contains(5.0));
    EXPECT_FALSE(interval.contains(15.2));
}

/// Two equal shares of 3 degrees each are as one of 6 (Welch and Satterthwaite).
TEST(EnergyEstimate, AddsVariancesAndDegreesOfFreedom) {
    const auto sum = sum_of(estimate(10.0, 2.0, 3.0), estimate(20.0, 2.0, 3.0));
    EXPECT_DOUBLE_EQ(sum.energy_wh, 30.0);
    EXPECT_NEAR(interval_95(sum).value().high, 30.0 + 2.0 * student_t_half_width(6.0), 1e-9);
}

TEST(EnergyEstimate, WithoutKnownUncertaintyHasNoIntervalNorHasASum) {
    const EnergyEstimate unknown{1.0, false, 0.0, 0.0};
    EXPECT_FALSE(interval_95(unknown).has_value());
    EXPECT_FALSE(interval_95(sum_of(unknown, estimate(1.0, 1.0, 3.0))).has_value());
}

TEST(EnergyEstimate, CannotFallBelowNothing) {
    const auto interval = interval_95(estimate(1.0, 100.0, 2.0)).value();
    EXPECT_DOUBLE_EQ(interval.low, 0.0);
    EXPECT_GT(interval.high, 40.0);
}

}  // namespace
}  // namespace flightwatt::mechanical
