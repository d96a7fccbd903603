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
    EXPECT_FALSE(model.phases[flight::Phase::landing].level_spread.has_value());
}

std::string with_cruise_line(const std::string& line) {
    auto text = to_toml(test::published_model());
    return text.insert(text.find("\n[landing]"), line + "\n");
}

TEST(ModelSpread, ReadsFilesWithTheAirspeedLawsOfEarlierVersions) {
    const auto plain = to_toml(test::published_model());
    for (const auto* line : {"airspeed = { flights = 3, coefficient_w_s3_per_m3 = 0.0105, relative_sd = 0.04 }",
                             "airspeed_law = { covariate = \"airspeed_cubed_m3_per_s3\", flights = 3, mean = 2700.0 }",
                             "airspeed_cubed_parts_m3_per_s3 = [2500.0, 2600.0]"})
        EXPECT_EQ(to_toml(read_back(with_cruise_line(line))), plain) << line;
}

TEST(ModelSpread, RefusesTheLevelLawOfEarlierVersions) {
    try {
        read_back(with_cruise_line("level_law = { covariate = \"wind_m_per_s\", flights = 3 }"));
        FAIL() << "it was read";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("unknown key 'level_law'"), std::string::npos) << error.what();
        EXPECT_GT(error.where().line, 1U);
    }
}

TEST(ModelSpread, RefusesNonsense) {
    auto model = model_with_spread();
    model.phases[flight::Phase::cruise].level_spread->flights = 1;
    EXPECT_THROW(read_back(to_toml(model)), InputError);
    model = model_with_spread();
    model.phases[flight::Phase::cruise].level_spread->between_flight_sd_w = -1.0;
    EXPECT_THROW(read_back(to_toml(model)), InputError);
}

}  // namespace
}  // namespace flightwatt::mechanical
