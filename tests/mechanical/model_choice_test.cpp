// Which of the models a mission uses: remove_rejected, decide_power, validation_of and add_best_power.

#include "helpers/generated_flights.h"
#include "helpers/generated_motion.h"
#include "mechanical/validation.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

using flight::Phase;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

/// A cruise of 100 Wh, between a take-off and a landing of no energy, with these errors in Wh, and so in percent.
ValidatedFlight flight_of(const std::vector<std::pair<std::string, double>>& errors_wh) {
    ValidatedFlight flight;
    flight.measured_wh.values = {0.0, 100.0, 0.0};
    for (const auto& [model, error_wh] : errors_wh) {
        FlightPrediction prediction{model, {}};
        prediction.phases.values = {EnergyEstimate{0.0}, EnergyEstimate{100.0 + error_wh}, EnergyEstimate{0.0}};
        flight.predictions.push_back(prediction);
    }
    return flight;
}

std::vector<std::string> models_of(const ModelValidation& validation) {
    std::vector<std::string> models;
    for (const auto& score : validation.scores) models.push_back(score.model);
    return models;
}

TEST(RemoveRejected, RemovesWhatIsFurtherOffThanTheMeanPower) {
    const auto flights_off = [](double first_wh, double second_wh) {
        return std::vector{flight_of({{"constant_mean", 10.0}, {"physical", first_wh}}),
                           flight_of({{"constant_mean", -8.0}, {"physical", second_wh}})};
    };
    auto flights = flights_off(-10.0, 8.0);
    EXPECT_EQ(remove_rejected(flights), "");
    EXPECT_THAT(model_names(flights), ElementsAre("constant_mean", "physical")) << "as far off is kept";
    flights = flights_off(102.0, 30.0);
    EXPECT_EQ(remove_rejected(flights), "physical is rejected: 66.0 % off on 2 flights left out, the mean power 9.0 %");
    EXPECT_THAT(model_names(flights), ElementsAre("constant_mean"));
}

TEST(RemoveRejected, ComparesOnTheFlightsThatAModelPredicts) {
    std::vector flights{flight_of({{"constant_mean", 10.0}, {"physical", 9.0}}),
                        flight_of({{"constant_mean", 1.0}})};  // without an airspeed
    EXPECT_THAT(remove_rejected(flights), IsEmpty());
    flights = {flight_of({{"constant_mean", 8.0}, {"physical", 9.0}}), flight_of({{"constant_mean", 50.0}})};
    EXPECT_THAT(remove_rejected(flights), StartsWith("physical is rejected: 9.0 % off on 1 flights"));
}

TEST(RemoveRejected, KeepsBaselines) {
    std::vector flights{flight_of({{"constant_mean", 1.0}, {"in_flight", 40.0}, {"fourier", 2.0}})};
    EXPECT_THAT(remove_rejected(flights), IsEmpty());
}

/// A model of cruises alone, of flights that are sampled all over, and their validation.
struct Decided {
    MechanicalModel model;
    std::vector<MeasuredFlight> flights;
    std::vector<ValidatedFlight> validated;
};

Decided cruises(std::size_t count, double mean_wh, double curve_wh, double mean_w2, double curve_w2) {
    Decided of;
    for (std::size_t i = 0; i < count; ++i) {
        auto& flight = of.flights.emplace_back();
        flight.samples.phases[Phase::cruise] =
            PhaseSamples{"f", 100.0, {0.1, 0.3, 0.5, 0.7, 0.9}, {20, 22, 24, 22, 20}};
        of.model.flights.emplace_back().phases[Phase::cruise] = PhaseContribution{1.0 / 3.0, 100.0, 0.1, 5, 21.6};
        of.validated.push_back(flight_of({{"fourier", curve_wh}, {"constant_mean", mean_wh}}));
        of.validated.back().predictions[0].square_error_w2[Phase::cruise] = curve_w2;
        of.validated.back().predictions[1].square_error_w2[Phase::cruise] = mean_w2;
    }
    of.model.phases[Phase::cruise].duration_s = 100.0;
    return of;
}

PowerDecision decision_of(Decided of) {
    decide_power(of.model, of.flights, of.validated);
    return of.model.phases[Phase::cruise].power;
}

TEST(DecidePower, TakesTheCurveOnlyWhereItPredictsNoWorse) {
    const auto basis = [](double mean_wh, double curve_wh, double mean_w2, double curve_w2) {
        return decision_of(cruises(3, mean_wh, curve_wh, mean_w2, curve_w2)).by;
    };
    EXPECT_EQ(basis(10.0, 10.0, 4.0, 1.0), PowerBasis::curve);
    EXPECT_EQ(basis(10.0, 10.4, 4.0, 1.0), PowerBasis::curve) << "three flights do not distinguish 4 %";
    EXPECT_EQ(basis(10.0, 10.6, 4.0, 1.0), PowerBasis::mean);
    EXPECT_EQ(basis(10.0, 10.0, 4.0, 4.1), PowerBasis::mean);
    EXPECT_EQ(basis(10.0, 10.0, 4.0, 4.0), PowerBasis::mean) << "the simpler one of equals";
    EXPECT_THAT(decision_of(cruises(3, 10.0, 806.0, 4.0, 1e4)).reason,
                StartsWith("on 3 flights left out the curve is 806 Wh off and 100 W over time, the mean power 10 Wh"));
}

TEST(DecidePower, TakesTheMeanOfFewFlights) {
    for (const std::size_t count : {1U, 2U})
        EXPECT_EQ(decision_of(cruises(count, 10.0, 1.0, 4.0, 1.0)).by, PowerBasis::mean) << count;
    EXPECT_THAT(decision_of(cruises(1, 10.0, 1.0, 4.0, 1.0)).reason, testing::HasSubstr("no variability"));
    EXPECT_EQ(decision_of(cruises(3, 10.0, 1.0, 4.0, 1.0)).by, PowerBasis::curve);
}

TEST(DecidePower, TakesTheMeanWhereSamplesDoNotCoverThePhase) {
    auto with_gap = cruises(3, 10.0, 1.0, 4.0, 1.0);
    with_gap.flights[1].samples.phases[Phase::cruise]->tau = {0.1, 0.2, 0.3, 0.56, 0.9};
    EXPECT_EQ(decision_of(with_gap).reason, "of 3 flights, 2 with samples all over the phase: a curve needs 3");
    with_gap.flights[1].samples.phases[Phase::cruise]->tau = {0.1, 0.3, 0.5, 0.74, 0.76};
    EXPECT_EQ(decision_of(with_gap).by, PowerBasis::curve);
    with_gap.flights[1].samples.phases[Phase::cruise]->tau = {0.1, 0.3, 0.5, 0.73, 0.74};
    EXPECT_EQ(decision_of(with_gap).by, PowerBasis::mean) << "nothing near the end";
}

TEST(ValidationOf, HasTheScoreOfPhasesThatDiffer) {
    auto flight = flight_of({{"fourier", 3.0}, {"constant_mean", 4.0}});
    flight.measured_wh[Phase::landing] = 100.0;
    for (auto& prediction : flight.predictions)
        prediction.phases[Phase::landing] = EnergyEstimate{prediction.model == "fourier" ? 906.0 : 102.0};
    MechanicalModel model;
    model.phases[Phase::landing].power.by = PowerBasis::mean;
    const auto validation = validation_of({flight}, model).value();
    EXPECT_EQ(validation.default_model, "by_phase");
    EXPECT_THAT(models_of(validation), ElementsAre("constant_mean", "fourier", "by_phase"));
    EXPECT_NEAR(validation.scores[2].mean_absolute_error_percent, 2.5, 1e-12) << "3 Wh of the curve, 2 of the mean";
}

TEST(ValidationOf, HasTheScoresOfWhatMissionsCanUse) {
    const auto validation =
        validation_of({flight_of({{"fourier", 3.0}, {"constant_mean", 4.0}, {"in_flight", 1.0}, {"physical", 2.0}}),
                       flight_of({{"fourier", 5.0}, {"constant_mean", -6.0}})},
                      {})
            .value();
    EXPECT_THAT(models_of(validation), ElementsAre("constant_mean", "fourier", "physical"));
    EXPECT_EQ(validation.scores[0].flights, 2U);
    EXPECT_NEAR(validation.scores[0].mean_absolute_error_percent, 5.0, 1e-12);
    EXPECT_EQ(validation.scores[2].flights, 1U);
    EXPECT_NEAR(validation.scores[2].mean_absolute_error_percent, 2.0, 1e-12);
    EXPECT_FALSE(validation_of({flight_of({{"fourier", 3.0}})}, {})) << "nothing to compare with";
}

TEST(ValidationOf, HasNoScoreOfFlightsOfWhichAPhaseWasNotPredicted) {
    const auto whole = flight_of({{"fourier", 3.0}, {"constant_mean", 4.0}});
    auto without_cruise = flight_of({{"fourier", 50.0}, {"constant_mean", 60.0}});
    without_cruise.measured_wh[Phase::cruise] = std::nullopt;
    EXPECT_FALSE(validation_of({without_cruise}, {}));
    const auto validation = validation_of({whole, without_cruise}, {}).value();
    EXPECT_EQ(validation.scores[0].flights, 1U);
    EXPECT_NEAR(validation.scores[0].mean_absolute_error_percent, 4.0, 1e-12);
}

/// Constant power, in fits that take no time.
std::vector<MeasuredFlight> steady_flights(std::size_t count) {
    std::mt19937 random(2);
    std::vector<MeasuredFlight> flights;
    for (std::size_t i = 0; i < count; ++i) {
        auto truth = test::published_model().phases;
        for (auto& phase : truth.values) phase.fourier = {0.01, 20.0 + 0.1 * static_cast<double>((7 * i) % 11), {}, {}};
        flights.push_back(test::measured("flight" + std::to_string(i), truth, random));
    }
    return flights;
}

ModelFitOptions of_order(int order) {
    ModelFitOptions options;
    options.phases.order = order;
    return options;
}

MechanicalModel model_of(const std::vector<MeasuredFlight>& flights) {
    std::vector<FlightSamples> samples;
    for (const auto& flight : flights) samples.push_back(flight.samples);
    return fit_model(samples, of_order(0)).model;
}

TEST(AddBestPower, ValidatesAtMostFortyFlights) {
    for (const auto& [given, used] : {std::pair(40U, 40U), std::pair(95U, 40U), std::pair(2U, 2U)}) {
        auto model = model_of(steady_flights(given));
        add_best_power(model, steady_flights(given), of_order(0));
        ASSERT_TRUE(model.validation);
        EXPECT_EQ(model.validation->scores.front().flights, used);
        EXPECT_EQ(model.validation->default_model, "constant_mean") << "they are the same";
        EXPECT_FALSE(model.physical) << "no airspeed was measured";
    }
}

TEST(AddBestPower, HasTheMeanPowerOfOneFlight) {
    auto model = model_of(steady_flights(1));
    add_best_power(model, steady_flights(1), of_order(0));
    EXPECT_FALSE(model.validation);
    EXPECT_EQ(default_model(model), "constant_mean");
}

/// Flights that fly as their motion: energies and samples are its bins'.
std::vector<MeasuredFlight> flights_of(const std::vector<BinnedFlight>& motions) {
    std::vector<MeasuredFlight> flights;
    for (const auto& motion : motions) {
        MeasuredFlight flight;
        flight.motion = motion;
        flight.samples.flight = motion.flight;
        for (const auto phase : flight::all_phases) {
            PhaseSamples samples{motion.flight, 0.0, {}, {}};
            double energy_j = 0.0;
            for (const auto& bin : motion.bins) {
                if (bin.phase != phase) continue;
                for (double time_s = 1.0; time_s < bin.duration_s; time_s += 2.0) {
                    samples.tau.push_back(samples.duration_s + time_s);
                    samples.power_w.push_back(bin.power_w);
                }
                samples.duration_s += bin.duration_s;
                energy_j += bin.power_w * bin.duration_s;
            }
            for (auto& tau : samples.tau) tau /= samples.duration_s;
            flight.energy_wh[phase] = units::wh_from_joule(energy_j);
            flight.samples.phases[phase] = samples;
        }
        flights.push_back(std::move(flight));
    }
    return flights;
}

TEST(AddBestPower, AddsThePhysicalModelWherePowerFollowsTheMotion) {
    const auto flights = flights_of(test::made_up_motions(6, 40, {}, 3));
    auto model = model_of(flights);
    add_best_power(model, flights, of_order(0));
    ASSERT_TRUE(model.validation);
    EXPECT_THAT(models_of(*model.validation), testing::Contains("physical"));
    ASSERT_TRUE(model.physical);
    EXPECT_EQ(model.physical->flights.size(), 6U);
    EXPECT_TRUE(model.physical->level_sd);
    EXPECT_TRUE(motion_predicts_best(model));
}

/// Motion whose power is not that of the flight.
TEST(AddBestPower, KeepsAPhysicalModelThatPredictsWorseForQuestionsOfAirspeed) {
    auto flights = flights_of(test::made_up_motions(6, 40, {}, 3));
    double power_w = 25.0;
    for (auto& flight : flights) {
        for (const auto phase : flight::all_phases) {
            auto& samples = *flight.samples.phases[phase];
            std::ranges::fill(samples.power_w, power_w);
            flight.energy_wh[phase] = units::wh_from_joule(power_w * samples.duration_s);
        }
        power_w += 0.01;
    }
    auto model = model_of(flights);
    add_best_power(model, flights, of_order(0));
    ASSERT_TRUE(model.validation);
    EXPECT_THAT(models_of(*model.validation), ElementsAre("constant_mean", "fourier"));
    EXPECT_TRUE(model.physical);
    EXPECT_FALSE(motion_predicts_best(model)) << "missions without an airspeed use the mean";
}

}  // namespace
}  // namespace flightwatt::mechanical
