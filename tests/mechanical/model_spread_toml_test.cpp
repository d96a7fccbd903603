#include "base/atomic_file.h"
#include "base/error.h"
#include "helpers/made_up_flights.h"
#include "mechanical/mechanical_model.h"

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

MechanicalModel model_with_spread() {
    auto model = test::published_model();
    model.phases[flight::Phase::cruise].level_spread = LevelSpread{4, 5.5, 8.25, 61.0};
    model.phases[flight::Phase::cruise].airspeed = AirspeedLaw{3, 0.0105, 0.04};
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
    EXPECT_EQ(model.phases[flight::Phase::cruise].airspeed->coefficient_w_s3_per_m3, 0.0105);
    EXPECT_FALSE(model.phases[flight::Phase::landing].level_spread.has_value());
}

TEST(ModelSpread, RefusesNonsense) {
    auto model = model_with_spread();
    model.phases[flight::Phase::cruise].level_spread->flights = 1;
    EXPECT_THROW(read_back(to_toml(model)), InputError);
    model = model_with_spread();
    model.phases[flight::Phase::cruise].level_spread->level_sd_w = -1.0;
    EXPECT_THROW(read_back(to_toml(model)), InputError);
    model = model_with_spread();
    model.phases[flight::Phase::cruise].airspeed->coefficient_w_s3_per_m3 = 0.0;
    EXPECT_THROW(read_back(to_toml(model)), InputError);
}

}  // namespace
}  // namespace flightwatt::mechanical
