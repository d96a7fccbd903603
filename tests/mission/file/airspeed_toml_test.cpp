// airspeed_m_per_s of a mission, and which power of its model is stated.

#include "mission/file/airspeed_toml.h"

#include "helpers/path_missions.h"
#include "helpers/rejected.h"
#include "mission/mission_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::cruise_w;
using test::rejected;
using test::scratch_dir;
using test::write_text;
using test::write_wing;

std::filesystem::path folder_with_opterra() {
    auto folder = scratch_dir();
    std::filesystem::copy(test::source_dir() / "fits" / "mechanical" / "opterra-table1.toml", folder / "opterra.toml");
    return folder;
}

/// A mission on a model, with more lines from its third on.
std::string on_model(const std::string& model, const std::string& lines) {
    return "name = \"test\"\nmechanical = \"" + model + "\"\n" + lines + R"(
duration_s = { takeoff = 28, cruise = 600, landing = 60 }
battery = { voltage_v = 10, resistance_ohm = 0.1, capacity_ah = 3 }
)";
}

Mission scheduled(const std::string& text, const std::filesystem::path& path) {
    return std::get<Mission>(parse_mission(text, path));
}

/// A wing that flew 11 to 16 m/s and takes 0.01 W s^3/m^3.
TEST(AirspeedToml, SetsTheLevelOfTheCruise) {
    const auto folder = folder_with_opterra();
    write_wing(mechanical::read_mechanical_model(folder / "opterra.toml"), folder / "wing.toml");
    const auto at = [&](const std::string& model, const std::string& airspeed) {
        return scheduled(on_model(model, "airspeed_m_per_s = " + airspeed), folder / "m.toml");
    };
    const auto mission = at("wing.toml", "12");
    EXPECT_NEAR(cruise_w(mission), 0.01 * 1728.0, 1e-9);
    EXPECT_NEAR(mission.setup.cruise_level->sd_w.value(), 0.04 * 17.28, 1e-9);
    EXPECT_TRUE(mission.setup.notes.empty());
    EXPECT_EQ(
        at("wing.toml", "18").setup.notes.front(),
        "airspeed_m_per_s = 18 is beyond what the model's flights flew (11 to 16 m/s): its power is extrapolated");
    const auto refusal = [&](const std::string& model, const std::string& airspeed) {
        return rejected([&] { at(model, airspeed); }, folder);
    };
    EXPECT_EQ(refusal("wing.toml", "21"),
              "m.toml:3:1: airspeed_m_per_s = 21 is beyond what the model's flights flew; they flew 11 to 16 m/s; give "
              "an airspeed near these, or fit a model to flights that were flown so");
    EXPECT_NE(refusal("wing.toml", "10.9").find("10.9 is beyond what the model's flights flew"), std::string::npos)
        << "no term for induced drag: slower flight would seem to take less and less";
    EXPECT_EQ(
        refusal("opterra.toml", "13"),
        "m.toml:3:1: the mechanical model 'opterra-table1' has no [physical] part, which predicts power from motion; "
        "fit one: flightwatt fit --model-kind physical FLIGHT... -o MODEL.toml, of flights that measured their airspeed");
    EXPECT_NE(refusal("none", "13").find("no meaning"), std::string::npos);
    const auto plain = scheduled(on_model("wing.toml", ""), folder / "m.toml");
    EXPECT_FALSE(plain.setup.cruise_level);
    EXPECT_EQ(cruise_w(plain), cruise_w(scheduled(on_model("opterra.toml", ""), folder / "m.toml")));
}

TEST(AirspeedToml, TakesThePlaceOfTheConditionsOfEarlierVersions) {
    const auto folder = folder_with_opterra();
    const auto refusal = [&](const std::string& conditions) {
        return rejected([&] { parse_mission(on_model("opterra.toml", conditions), folder / "m.toml"); }, folder);
    };
    EXPECT_THAT(refusal("conditions = { wind_m_per_s = 3 }"),
                testing::StartsWith("m.toml:3:1: conditions are no longer read"));
    EXPECT_THAT(refusal("[conditions]\nairspeed_m_per_s = 13\n[plan]"), testing::HasSubstr("state airspeed_m_per_s"));
}

/// Of a model file that knows how its models predict: which one states the power.
TEST(AirspeedToml, NamesTheModelThatSaysThePowerAndItsError) {
    const auto folder = folder_with_opterra();
    auto model = mechanical::read_mechanical_model(folder / "opterra.toml");
    model.flights = {{"a", {}}, {"b", {}}};
    for (auto& flight : model.flights)
        flight.phases[flight::Phase::cruise] = mechanical::PhaseContribution{0.5, 600.0, 0.1, 500, 25.0};
    model.validation = {"constant_mean", {{"constant_mean", 4, 18.6}, {"fourier", 4, 15.0}, {"physical", 3, 2.7}}};
    const auto read = [&](const std::string& lines) {
        write_wing(model, folder / "model.toml");
        return scheduled(on_model("model.toml", lines), folder / "m.toml");
    };
    EXPECT_EQ(read("").setup.power_model.value().model, "constant_mean");
    EXPECT_DOUBLE_EQ(cruise_w(read("")), 25.0);
    model.validation->default_model = "fourier";
    EXPECT_EQ(read("").setup.power_model.value().mean_absolute_error_percent, 15.0);
    EXPECT_NE(cruise_w(read("")), 25.0);
    const auto physical = read("airspeed_m_per_s = 12");
    EXPECT_EQ(physical.setup.power_model.value().model, "physical");
    EXPECT_NEAR(cruise_w(physical), 0.01 * 1728.0, 1e-9);
    EXPECT_TRUE(physical.setup.notes.empty());
    model.validation->scores.pop_back();
    EXPECT_NE(read("airspeed_m_per_s = 12").setup.notes.front().find("is unproven"), std::string::npos);
    model.validation.reset();
    EXPECT_FALSE(read("airspeed_m_per_s = 12").setup.power_model) << "nothing is known of its error";
    EXPECT_TRUE(read("airspeed_m_per_s = 12").setup.notes.empty());
}

TEST(AirspeedToml, SaysWhereFlightsDoNotShowWhatAirspeedCosts) {
    const auto folder = folder_with_opterra();
    auto model = mechanical::read_mechanical_model(folder / "opterra.toml");
    model.physical = test::made_up_wing();
    model.physical->terms = {mechanical::PowerTerm::constant};
    model.physical->coefficients = {};
    model.physical->coefficients[mechanical::PowerTerm::constant] = 100.0;
    model.physical->covariance = {{1.0}};
    model.physical->mean_airspeed_m_per_s = 0.0;
    model.physical->bins = 100;
    model.physical->bin_s = 30.0;
    model.physical->correlation_s = 60.0;
    write_text(folder / "constant.toml", mechanical::to_toml(model));
    const auto notes = scheduled(on_model("constant.toml", "airspeed_m_per_s = 12"), folder / "m.toml").setup.notes;
    EXPECT_THAT(notes, testing::Contains(testing::StartsWith("its cruise power is assumed not to grow")));
    EXPECT_THAT(scheduled(on_model("constant.toml", ""), folder / "m.toml").setup.notes, testing::IsEmpty());
    const auto drag = mechanical::PowerTerm::drag;
    const auto induced = mechanical::PowerTerm::induced;
    mechanical::SpeedTerms shown{{drag, induced}, {}, {{1e-7, 0.0}, {0.0, 1.0}}, 4.0};
    shown.coefficients[drag] = 0.01;
    shown.coefficients[induced] = 300.0;
    model.physical->speed_terms = shown;
    model.physical->level_sd = 0.05;
    model.physical->degrees_of_freedom = 4.0;
    write_text(folder / "speeds.toml", mechanical::to_toml(model));
    const auto at_12 = scheduled(on_model("speeds.toml", "airspeed_m_per_s = 12"), folder / "m.toml");
    EXPECT_NEAR(cruise_w(at_12), 0.01 * 1728.0 + 25.0, 1e-9);
    EXPECT_THAT(at_12.setup.notes, testing::Not(testing::Contains(testing::StartsWith("its cruise power is assumed"))));
}

// A wing that circled took twice the power that straight flight at the same airspeed was predicted to take.
TEST(AirspeedToml, KeepsWhatTurnsAndGustsOfTheFlightsTook) {
    const auto folder = folder_with_opterra();
    auto model = mechanical::read_mechanical_model(folder / "opterra.toml");
    const auto& cruise = model.phases[flight::Phase::cruise];
    const double flown_w = energy_j(cruise.fourier, cruise.duration_s) / cruise.duration_s;
    write_wing(model, folder / "wing.toml");
    auto wing = mechanical::read_mechanical_model(folder / "wing.toml");
    wing.physical->mean_airspeed_m_per_s = 12.0;
    write_text(folder / "wing.toml", mechanical::to_toml(wing));
    const auto at = [&](const std::string& airspeed) {
        return scheduled(on_model("wing.toml", "airspeed_m_per_s = " + airspeed), folder / "m.toml");
    };
    EXPECT_NEAR(cruise_w(at("12")), flown_w, 1e-9);
    EXPECT_NEAR(cruise_w(at("14")), flown_w + 0.01 * (2744.0 - 1728.0), 1e-9);
    EXPECT_THAT(at("12").setup.notes.front(), testing::HasSubstr("W are added to level flight straight ahead"));
}

}  // namespace
}  // namespace flightwatt::mission
