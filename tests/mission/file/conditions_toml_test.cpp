#include "mission/file/conditions_toml.h"

#include "helpers/path_missions.h"
#include "helpers/rejected.h"
#include "mission/mission_file.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::rejected;
using test::scratch_dir;
using test::write_text;

std::filesystem::path folder_with_opterra() {
    auto folder = scratch_dir();
    std::filesystem::copy(test::source_dir() / "fits" / "mechanical" / "opterra-table1.toml", folder / "opterra.toml");
    return folder;
}

/// A folder with a model whose cruise follows the height: 27 W at 100 m, 2 W more 10 m higher.
std::filesystem::path folder_with_law() {
    auto folder = folder_with_opterra();
    auto model = mechanical::read_mechanical_model(folder / "opterra.toml");
    model.phases[flight::Phase::cruise].level_law =
        mechanical::CovariateRegression{mechanical::Covariate::height, 4, 100.0, 10.0, 90.0, 110.0, 27.0, 2.0, 1.5};
    write_text(folder / "law.toml", mechanical::to_toml(model));
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

TEST(ConditionsToml, SetsTheCruiseLevelByTheStatedConditions) {
    const auto folder = folder_with_law();
    const auto mission = scheduled(on_model("law.toml", "conditions = { height_m = 105 }"), folder / "m.toml");
    const auto& cruise = mission.mechanical->phases[flight::Phase::cruise];
    EXPECT_NEAR(energy_j(cruise.fourier, cruise.duration_s) / cruise.duration_s, 28.0, 1e-9);
    ASSERT_TRUE(mission.cruise_level);
    EXPECT_NEAR(mission.cruise_level->mean_w, 28.0, 1e-12);
    EXPECT_NEAR(mission.cruise_level->sd_w.value(), 1.5 * std::sqrt(1.25 + 0.25 / 4.0), 1e-12);
    // Without conditions: the average of the flights, as before.
    const auto plain = scheduled(on_model("law.toml", ""), folder / "m.toml");
    EXPECT_FALSE(plain.cruise_level);
    EXPECT_EQ(plain.mechanical->phases[flight::Phase::cruise].fourier.a0_w,
              mechanical::read_mechanical_model(folder / "opterra.toml").phases[flight::Phase::cruise].fourier.a0_w);
}

/// Any model whose flights measured airspeed: 27 W at 13 m/s, from 12 to 14 m/s.
TEST(ConditionsToml, SetsTheCruiseLevelByTheAirspeed) {
    const auto folder = folder_with_opterra();
    auto model = mechanical::read_mechanical_model(folder / "opterra.toml");
    auto& cruise_model = model.phases[flight::Phase::cruise];
    cruise_model.airspeed_law = mechanical::CovariateRegression{
        mechanical::Covariate::airspeed_cubed, 3, 2197.0, 400.0, 1728.0, 2744.0, 27.0, 27.0 * 400.0 / 2197.0, 1.5};
    write_text(folder / "law.toml", mechanical::to_toml(model));
    cruise_model.level_law =
        mechanical::CovariateRegression{mechanical::Covariate::airspeed, 4, 13.0, 1.0, 12.0, 14.0, 26.0, 5.0, 1.5};
    cruise_model.airspeed_law.reset();
    write_text(folder / "line.toml", mechanical::to_toml(model));
    const auto at = [&](const std::string& law, const std::string& airspeed) {
        return scheduled(on_model(law, "airspeed_m_per_s = " + airspeed), folder / "m.toml");
    };
    const auto mean_w = [](const Mission& mission) {
        const auto& cruise = mission.mechanical->phases[flight::Phase::cruise];
        return energy_j(cruise.fourier, cruise.duration_s) / cruise.duration_s;
    };
    const auto mission = at("law.toml", "13.5");
    const double cubed = 13.5 * 13.5 * 13.5 / 2197.0;
    EXPECT_NEAR(mean_w(mission), 27.0 * cubed, 1e-9);
    EXPECT_NEAR(mission.cruise_level->sd_w.value(), 1.5 * cubed * std::sqrt(4.0 / 3.0), 1e-9);
    EXPECT_NEAR(mission.cruise_level->degrees_of_freedom, 2.0, 1e-12);
    EXPECT_TRUE(mission.notes.empty());
    EXPECT_NEAR(mean_w(at("line.toml", "13.5")), 28.5, 1e-9);
    // Beyond what was flown drag's law is used and said, a line is not.
    EXPECT_EQ(
        at("law.toml", "15").notes.front(),
        "airspeed_m_per_s = 15 is beyond what the model's flights flew: the 3 flights of its law flew 12 to 14 m/s, "
        "and drag's law reaches further");
    const auto refusal = [&](const std::string& law, const std::string& airspeed) {
        return rejected([&] { at(law, airspeed); }, folder);
    };
    EXPECT_EQ(
        refusal("law.toml", "18"),
        "m.toml:3:1: airspeed_m_per_s = 18 is beyond what the model's flights flew; the 3 flights of its law flew "
        "12 to 14 m/s; give an airspeed near these, or fit a model to flights that were flown so");
    EXPECT_NE(refusal("line.toml", "15").find("beyond what the model's flights flew"), std::string::npos);
    model = mechanical::read_mechanical_model(folder / "opterra.toml");
    model.physical = test::made_up_wing();
    model.physical->bins = 100;
    model.physical->bin_s = 30.0;
    write_text(folder / "wing.toml", mechanical::to_toml(model));
    EXPECT_NEAR(mean_w(at("wing.toml", "12")), 0.01 * 1728.0, 1e-9);
    EXPECT_NEAR(at("wing.toml", "12").cruise_level->sd_w.value(), 0.04 * 17.28, 1e-9);
    EXPECT_NE(refusal("opterra.toml", "13").find("does not know airspeed"), std::string::npos);
    EXPECT_NE(refusal("none", "13").find("no meaning"), std::string::npos);
    EXPECT_NE(refusal("law.toml", "13\nconditions = { height_m = 100 }").find("give one"), std::string::npos);
}

/// Of a model file that knows how its models predict: which one says the power.
TEST(ConditionsToml, NamesTheModelThatSaysThePowerAndItsError) {
    const auto folder = folder_with_opterra();
    auto model = mechanical::read_mechanical_model(folder / "opterra.toml");
    auto& cruise = model.phases[flight::Phase::cruise];
    cruise.airspeed_law = mechanical::CovariateRegression{
        mechanical::Covariate::airspeed_cubed, 3, 2197.0, 400.0, 1728.0, 2744.0, 27.0, 27.0 * 400.0 / 2197.0, 1.5};
    model.flights = {{"a", {}}, {"b", {}}};
    for (auto& flight : model.flights)
        flight.phases[flight::Phase::cruise] = mechanical::PhaseContribution{0.5, 600.0, 0.1, 500, 25.0};
    model.validation = {false, {{"constant_mean", 4, 18.6}, {"fourier", 4, 15.0}, {"physical", 3, 2.7}}};
    const auto read = [&](const std::string& lines) {
        write_text(folder / "model.toml", mechanical::to_toml(model));
        return scheduled(on_model("model.toml", lines), folder / "m.toml");
    };
    const auto cruise_w = [](const Mission& mission) {
        const auto& of = mission.mechanical->phases[flight::Phase::cruise];
        return energy_j(of.fourier, of.duration_s) / of.duration_s;
    };
    EXPECT_EQ(read("").power_model.value().model, "constant_mean");
    EXPECT_DOUBLE_EQ(cruise_w(read("")), 25.0);
    model.validation->prefers_curve = true;
    EXPECT_EQ(read("").power_model.value().mean_absolute_error_percent, 15.0);
    EXPECT_NE(cruise_w(read("")), 25.0);
    // The law of airspeed has no error there: its use is a warning.
    EXPECT_FALSE(read("airspeed_m_per_s = 13").power_model);
    EXPECT_NE(read("airspeed_m_per_s = 13").notes.front().find("is unproven"), std::string::npos);
    model.physical = test::made_up_wing();
    model.physical->bins = 100;
    model.physical->bin_s = 30.0;
    const auto physical = read("airspeed_m_per_s = 12");
    EXPECT_EQ(physical.power_model.value().model, "physical");
    EXPECT_NEAR(cruise_w(physical), 0.01 * 1728.0, 1e-9) << "the law of airspeed says another power";
    EXPECT_TRUE(physical.notes.empty());
    model.validation.reset();
    EXPECT_FALSE(read("airspeed_m_per_s = 12").power_model) << "nothing is known of its error";
    EXPECT_TRUE(read("airspeed_m_per_s = 12").notes.empty());
}

TEST(ConditionsToml, RefusesConditionsThatNothingSupports) {
    const auto folder = folder_with_law();
    const auto refusal = [&](const std::string& model, const std::string& conditions) {
        return rejected([&] { parse_mission(on_model(model, "conditions = " + conditions), folder / "m.toml"); });
    };
    EXPECT_NE(refusal("law.toml", "{ height_m = 150 }").find("beyond what the model's flights showed"),
              std::string::npos);
    EXPECT_NE(refusal("law.toml", "{ airspeed_m_per_s = 14 }").find("it follows height_m, from 90 to 110"),
              std::string::npos);
    EXPECT_NE(refusal("opterra.toml", "{ height_m = 100 }").find("follows no condition"), std::string::npos);
    EXPECT_NE(refusal("none", "{ height_m = 100 }").find("no meaning"), std::string::npos);
}

}  // namespace
}  // namespace flightwatt::mission
