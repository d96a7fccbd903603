#include "base/atomic_file.h"
#include "base/error.h"
#include "helpers/made_up_flights.h"
#include "mechanical/mechanical_model.h"

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

MechanicalModel model_with_spread() {
    auto model = test::published_model();
    model.phases[flight::Phase::cruise].level_spread = VarianceComponents{4, 5.5, 8.25, 61.0};
    model.phases[flight::Phase::cruise].airspeed_law =
        CovariateRegression{Covariate::airspeed_cubed, 3, 2000.0, 100.0, 1900.0, 2100.0, 21.0, 1.05, 0.84};
    return model;
}

MechanicalModel read_back(const std::string& text) {
    const auto file = test::scratch_dir() / "model.toml";
    write_file_atomically(file, text);
    return read_mechanical_model(file);
}

TEST(ModelSpread, ReadsBackAsItWasWritten) {
    const auto text = to_toml(model_with_spread());
    const auto model = read_back(text);
    EXPECT_EQ(to_toml(model), text);
    EXPECT_EQ(model.phases[flight::Phase::cruise].level_spread->correlation_s, 61.0);
    EXPECT_EQ(model.phases[flight::Phase::cruise].airspeed_law->slope_w, 1.05);
    EXPECT_FALSE(model.phases[flight::Phase::landing].level_spread.has_value());
}

TEST(ModelSpread, ReadsTheAirspeedLawOfVersion01) {
    auto model = test::published_model();
    auto text = to_toml(model);
    text.insert(text.find("\n[landing]"),
                "airspeed = { flights = 3, coefficient_w_s3_per_m3 = 0.0105, relative_sd = 0.04 }\n");
    const auto level = predict_mean_power(read_back(text).phases[flight::Phase::cruise].airspeed_law.value(), 3000.0);
    EXPECT_NEAR(level.power_w, 31.5, 1e-12);
    EXPECT_NEAR(level.sd_w.value(), 0.04 * 31.5, 1e-12);
    EXPECT_EQ(level.degrees_of_freedom, 2.0);
}

TEST(ModelSpread, RefusesNonsense) {
    auto model = model_with_spread();
    model.phases[flight::Phase::cruise].level_spread->flights = 1;
    EXPECT_THROW(read_back(to_toml(model)), InputError);
    model = model_with_spread();
    model.phases[flight::Phase::cruise].level_spread->between_flight_sd_w = -1.0;
    EXPECT_THROW(read_back(to_toml(model)), InputError);
    model = model_with_spread();
    model.phases[flight::Phase::cruise].airspeed_law->mean_power_w = 0.0;
    EXPECT_THROW(read_back(to_toml(model)), InputError);
    model = model_with_spread();
    model.phases[flight::Phase::cruise].airspeed_law->covariate = Covariate::wind;
    EXPECT_THROW(read_back(to_toml(model)), InputError);
}

}  // namespace
}  // namespace flightwatt::mechanical
