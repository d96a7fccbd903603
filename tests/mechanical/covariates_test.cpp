#include "mechanical/covariates.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "flight/segmentation.h"
#include "flight/selected_track.h"
#include "helpers/made_up_flights.h"
#include "helpers/sample_columns.h"
#include "mechanical/fit/flight_variation.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/model_fit.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

TEST(CovariatesOf, TakesWhatWasKnownBeforeTheCruiseAndEarlyInIt) {
    test::SampleColumns series;
    for (int i = 0; i < 300; ++i) {
        series.time_s.push_back(i);
        series.voltage_v.push_back(i < 100 ? 12.5 : 11.0);
        series.throttle_percent.push_back(i < 100 ? 0.0 : 70.0);
        series.wind_speed_m_per_s.push_back(i <= 130 + 60 ? 3.0 : 9.0);
    }
    flight::Sortie sortie;
    sortie.height_m = 85.0;
    sortie.phases.resize(2);
    sortie.phases[0].phase = flight::Phase::takeoff;
    sortie.phases[0].start.time_s = 100.0;
    sortie.phases[1].phase = flight::Phase::cruise;
    sortie.phases[1].start.time_s = 130.0;
    const auto flown = test::series_of(series);
    const auto covariates = covariates_of(flight::SelectedTracks(flown), sortie);
    EXPECT_EQ(covariates[Covariate::height], 85.0);
    EXPECT_EQ(covariates[Covariate::initial_voltage], 12.5);
    EXPECT_EQ(covariates[Covariate::wind], 3.0);
    EXPECT_FALSE(covariates[Covariate::airspeed]);
}

TEST(Covariate, IsFoundByItsName) {
    for (const auto covariate : all_covariates) EXPECT_EQ(covariate_from(to_string(covariate)), covariate);
    EXPECT_FALSE(covariate_from("height"));
}

const CovariateRegression line{Covariate::height, 3, 100.0, 10.0, 90.0, 110.0, 30.0, 2.0, 0.5};
const CovariateRegression through_origin{Covariate::airspeed_cubed, 3, 1000.0, 100.0, 900.0, 1100.0, 30.0, 3.0, 1.5};

TEST(CovariateRegression, IsALineWithTheErrorOfItsParameters) {
    const auto level = predict_mean_power(line, 105.0);
    EXPECT_DOUBLE_EQ(level.power_w, 31.0);
    EXPECT_DOUBLE_EQ(level.law_variance, 1.25 / 3.0);
    EXPECT_EQ(level.sd_w, 0.5);
    EXPECT_EQ(level.degrees_of_freedom, 1.0);
    EXPECT_TRUE(level.within_flights);
}

TEST(CovariateRegression, SaysWhereItReachesBeyondItsFlights) {
    EXPECT_FALSE(predict_mean_power(line, 300.0).within_flights);
    EXPECT_DOUBLE_EQ(predict_mean_power(line, 300.0).power_w, predict_mean_power(line, 110.0).power_w);
}

TEST(CovariateRegression, OfCubedAirspeedIsProportionalAndSoIsItsSpread) {
    const auto level = predict_mean_power(through_origin, 2000.0);
    EXPECT_DOUBLE_EQ(level.power_w, 60.0);
    EXPECT_DOUBLE_EQ(level.sd_w.value(), 3.0);
    EXPECT_DOUBLE_EQ(level.law_variance, 1.0 / 3.0);
    EXPECT_EQ(level.degrees_of_freedom, 2.0);
    EXPECT_FALSE(level.within_flights);
}

TEST(CovariateRegression, AsConstantPowerHoldsItsOwnError) {
    const auto power = constant_power(predict_mean_power(line, 105.0));
    EXPECT_DOUBLE_EQ(power.mean_w, 31.0);
    EXPECT_DOUBLE_EQ(power.sd_w.value(), 0.5 * std::sqrt(1.0 + 1.25 / 3.0));
    EXPECT_EQ(power.degrees_of_freedom, 1.0);
    EXPECT_FALSE(constant_power(RegressionPrediction{}).sd_w);
}

/// Three cruises whose level follows the height exactly: 1 W a 10 m.
std::vector<FlightSamples> recorded() {
    std::mt19937 random(1);
    std::vector<FlightSamples> recorded;
    for (const double step : {-1.0, 0.0, 1.0}) {
        FlightSamples flight{"flight" + std::to_string(recorded.size()), {}};
        for (const auto phase : flight::all_phases) {
            auto curve = test::published_model().phases[phase];
            if (phase == flight::Phase::cruise) curve.fourier.a0_w += step;
            flight.phases[phase] = test::record(curve, {curve.duration_s, 1.1, 0.1, 0.1}, random, flight.flight);
        }
        flight.phases[flight::Phase::cruise]->covariates[Covariate::height] = 100.0 + 10.0 * step;
        recorded.push_back(flight);
    }
    return recorded;
}

ModelFitOptions following(Covariate covariate) {
    ModelFitOptions options;
    options.level_covariate = covariate;
    return options;
}

MechanicalModel read_back(const std::string& text) {
    const auto file = test::scratch_dir() / "model.toml";
    write_file_atomically(file, text);
    return read_mechanical_model(file);
}

TEST(CovariateRegression, IsStoredInTheModelAndReadBack) {
    const auto text = to_toml(fit_model(recorded(), following(Covariate::height)).model);
    EXPECT_THAT(text, testing::HasSubstr("level_law = { covariate = \"height_m\", flights = 3"));
    const auto model = read_back(text);
    EXPECT_EQ(to_toml(model), text);
    EXPECT_NEAR(model.phases[flight::Phase::cruise].level_law->slope_w, 2.0 / 3.0, 0.03);
    EXPECT_FALSE(model.phases[flight::Phase::landing].level_law);
}

TEST(CovariateRegression, IsRefusedWhereTheFlightsDoNotTellIt) {
    EXPECT_THROW(fit_model(recorded(), following(Covariate::wind)).model, NoResultError);
    auto two = recorded();
    two.pop_back();
    EXPECT_THROW(fit_model(two, following(Covariate::height)).model, NoResultError);
}

TEST(CovariateRegression, RefusesNonsenseInAFile) {
    const auto good = to_toml(fit_model(recorded(), following(Covariate::height)).model);
    const auto with = [&](std::string_view old, std::string_view replacement) {
        auto text = good;
        const auto place = text.find(old, text.find("level_law"));
        EXPECT_NE(place, std::string::npos) << old;
        return text.replace(place, old.size(), replacement);
    };
    EXPECT_THROW(read_back(with("height_m", "length_m")), InputError);
    EXPECT_THROW(read_back(with("flights = 3", "flights = 2")), InputError);
    EXPECT_THROW(read_back(with("least = 90", "least = 105")), InputError);
    EXPECT_THROW(read_back(with("slope_w", "slope_kw")), InputError);
}

/// A cruise of constant power at a height, and at an airspeed that goes with it.
PhaseSamples cruise(double power_w, double height_m) {
    PhaseSamples samples{"flight", 600.0, {0.0, 0.5, 1.0}, {power_w, power_w, power_w}};
    samples.covariates[Covariate::height] = height_m;
    samples.airspeed_cubed_m3_per_s3 = 10.0 * height_m;
    return samples;
}

const std::vector<PhaseSamples> flights{cruise(29.0, 90.0), cruise(30.0, 100.0), cruise(31.0, 110.0)};

TEST(LevelLawFit, IsARidgeLineThatWeighsAsOneMoreFlight) {
    const auto law = fit_covariate_regression(flights, Covariate::height).value();
    EXPECT_EQ(law.flights, 3u);
    EXPECT_DOUBLE_EQ(law.least, 90.0);
    EXPECT_DOUBLE_EQ(law.most, 110.0);
    EXPECT_NEAR(law.slope_w, 2.0 / 3.0, 1e-12);
    EXPECT_NEAR(law.residual_sd_w.value(), std::sqrt(2.0 / 9.0), 1e-12);
    const auto level = predict_mean_power(law, 105.0);
    EXPECT_NEAR(level.power_w, 30.0 + 0.5 * 2.0 / 3.0, 1e-12);
    EXPECT_NEAR(level.law_variance, 1.0 / 3.0 + 0.25 / 3.0, 1e-12);
    EXPECT_TRUE(level.within_flights);
}

TEST(LevelLawFit, SaysWhereItReachesBeyondItsFlights) {
    const auto law = fit_covariate_regression(flights, Covariate::height).value();
    const auto beyond = predict_mean_power(law, 300.0);
    EXPECT_FALSE(beyond.within_flights);
    EXPECT_DOUBLE_EQ(beyond.power_w, predict_mean_power(law, 110.0).power_w);
}

TEST(LevelLawFit, OfCubedAirspeedGoesThroughTheOriginWithARelativeSpread) {
    const auto law = fit_covariate_regression(flights, Covariate::airspeed_cubed).value();
    const double coefficient = (29.0 / 900.0 + 30.0 / 1000.0 + 31.0 / 1100.0) / 3.0;
    const auto near = predict_mean_power(law, 1000.0);
    const auto far = predict_mean_power(law, 2000.0);
    EXPECT_NEAR(near.power_w, 1000.0 * coefficient, 1e-12);
    EXPECT_NEAR(far.power_w, 2.0 * near.power_w, 1e-12);
    EXPECT_NEAR(far.sd_w.value(), 2.0 * near.sd_w.value(), 1e-12);
    EXPECT_EQ(near.degrees_of_freedom, 2.0);
}

TEST(PowerByCovariate, IsARidgeLineThatWeighsAsOneMoreFlight) {
    // Powers on the line 20 + height / 10; centre 100, standard deviation 10, so z is -1, 0, 1: slope 2 / (2
    // + 1).
    const auto power = power_by_covariate(flights, Covariate::height, 105.0);
    ASSERT_TRUE(power);
    EXPECT_NEAR(power->mean_w, 30.0 + 0.5 * 2.0 / 3.0, 1e-12);
    // Residuals -1/3, 0, 1/3, one degree of freedom; z = 0.5 over 3 weights.
    EXPECT_EQ(power->degrees_of_freedom, 1.0);
    EXPECT_NEAR(power->sd_w.value(), std::sqrt(2.0 / 9.0 * (1.0 + 1.0 / 3.0 + 0.25 / 3.0)), 1e-12);
}

TEST(PowerByCovariate, DoesNotReachBeyondWhatTheFlightsShowed) {
    EXPECT_EQ(power_by_covariate(flights, Covariate::height, 500.0)->mean_w,
              power_by_covariate(flights, Covariate::height, 110.0)->mean_w);
}

TEST(PowerByCovariate, HasNoIntervalFromTwoFlights) {
    const std::vector<PhaseSamples> others{cruise(29.0, 90.0), cruise(31.0, 110.0)};
    const auto power = power_by_covariate(others, Covariate::height, 100.0);
    ASSERT_TRUE(power);
    EXPECT_NEAR(power->mean_w, 30.0, 1e-12);
    EXPECT_FALSE(power->sd_w);
}

TEST(PowerByCovariate, IsUnknownWithoutTheCovariateOrItsSpread) {
    const std::vector<PhaseSamples> others{cruise(29.0, 90.0), cruise(31.0, 110.0)};
    EXPECT_FALSE(power_by_covariate(others, Covariate::height, std::nullopt));
    EXPECT_FALSE(power_by_covariate(others, Covariate::wind, 100.0));
    const std::vector<PhaseSamples> same{cruise(29.0, 90.0), cruise(31.0, 90.0)};
    EXPECT_FALSE(power_by_covariate(same, Covariate::height, 90.0));
}

TEST(PowerByCovariate, OfTheAirspeedNeedsTwoFlightsThatMeasuredIt) {
    auto two = std::vector{cruise(20.0, 200.0), cruise(22.0, 220.0)};
    EXPECT_NEAR(power_by_covariate(two, Covariate::airspeed_cubed, 3000.0).value().mean_w, 30.0, 1e-9);
    EXPECT_FALSE(power_by_covariate(two, Covariate::airspeed_cubed, std::nullopt));
    two[1].airspeed_cubed_m3_per_s3.reset();
    EXPECT_FALSE(power_by_covariate(two, Covariate::airspeed_cubed, 3000.0));
}

}  // namespace
}  // namespace flightwatt::mechanical
