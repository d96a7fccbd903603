#include "mechanical/prediction/level_law.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "helpers/made_up_flights.h"
#include "mechanical/model_fit.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

PhaseSamples cruise(double power_w, double height_m) {
    PhaseSamples samples{"flight", 600.0, {0.0, 0.5, 1.0}, {power_w, power_w, power_w}};
    samples.covariates[Covariate::height] = height_m;
    samples.airspeed_cubed_m3_per_s3 = 10.0 * height_m;
    return samples;
}

const std::vector<PhaseSamples> flights{cruise(29.0, 90.0), cruise(30.0, 100.0), cruise(31.0, 110.0)};

TEST(LevelLaw, IsARidgeLineThatWeighsAsOneMoreFlight) {
    const auto law = level_law(flights, Covariate::height).value();
    EXPECT_EQ(law.flights, 3u);
    EXPECT_DOUBLE_EQ(law.least, 90.0);
    EXPECT_DOUBLE_EQ(law.most, 110.0);
    EXPECT_NEAR(law.slope_w, 2.0 / 3.0, 1e-12);
    EXPECT_NEAR(law.residual_sd_w.value(), std::sqrt(2.0 / 9.0), 1e-12);
    const auto level = level_at(law, 105.0);
    EXPECT_NEAR(level.power_w, 30.0 + 0.5 * 2.0 / 3.0, 1e-12);
    EXPECT_NEAR(level.law_variance, 1.0 / 3.0 + 0.25 / 3.0, 1e-12);
    EXPECT_TRUE(level.within_flights);
}

TEST(LevelLaw, SaysWhereItReachesBeyondItsFlights) {
    const auto law = level_law(flights, Covariate::height).value();
    const auto beyond = level_at(law, 300.0);
    EXPECT_FALSE(beyond.within_flights);
    EXPECT_DOUBLE_EQ(beyond.power_w, level_at(law, 110.0).power_w);
}

TEST(LevelLaw, OfCubedAirspeedGoesThroughTheOriginWithARelativeSpread) {
    const auto law = level_law(flights, Covariate::airspeed_cubed).value();
    const double coefficient = (29.0 / 900.0 + 30.0 / 1000.0 + 31.0 / 1100.0) / 3.0;
    const auto near = level_at(law, 1000.0);
    const auto far = level_at(law, 2000.0);
    EXPECT_NEAR(near.power_w, 1000.0 * coefficient, 1e-12);
    EXPECT_NEAR(far.power_w, 2.0 * near.power_w, 1e-12);
    EXPECT_NEAR(far.sd_w.value(), 2.0 * near.sd_w.value(), 1e-12);
    EXPECT_EQ(near.freedom, 2.0);
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
            flight.phases[phase] =
                test::record(curve, {curve.duration_s, 1.1, 0.1, 0.1}, random, flight.flight);
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

TEST(LevelLaw, IsStoredInTheModelAndReadBack) {
    const auto text = to_toml(fit_mechanical_model(recorded(), following(Covariate::height)));
    EXPECT_THAT(text, testing::HasSubstr("level_law = { covariate = \"height_m\", flights = 3"));
    const auto model = read_back(text);
    EXPECT_EQ(to_toml(model), text);
    EXPECT_NEAR(model.phases[flight::Phase::cruise].level_law->slope_w, 2.0 / 3.0, 0.03);
    EXPECT_FALSE(model.phases[flight::Phase::landing].level_law);
}

TEST(LevelLaw, IsRefusedWhereTheFlightsDoNotTellIt) {
    EXPECT_THROW(fit_mechanical_model(recorded(), following(Covariate::wind)), NoAnswerError);
    auto two = recorded();
    two.pop_back();
    EXPECT_THROW(fit_mechanical_model(two, following(Covariate::height)), NoAnswerError);
}

TEST(LevelLaw, RefusesNonsenseInAFile) {
    const auto good = to_toml(fit_mechanical_model(recorded(), following(Covariate::height)));
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

}  // namespace
}  // namespace flightwatt::mechanical
