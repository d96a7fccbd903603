
#include "helpers/path_missions.h"
#include "helpers/rejected.h"
#include "mission/file/mission_tables.h"
#include "mission/mission_file.h"
#include "mission/simulation.h"

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
    const auto& cruise = mission.setup.mechanical->phases[flight::Phase::cruise];
    EXPECT_NEAR(energy_j(cruise.fourier, cruise.duration_s) / cruise.duration_s, 28.0, 1e-9);
    ASSERT_TRUE(mission.setup.cruise_level);
    EXPECT_NEAR(mission.setup.cruise_level->mean_w, 28.0, 1e-12);
    EXPECT_NEAR(mission.setup.cruise_level->sd_w.value(), 1.5 * std::sqrt(1.25 + 0.25 / 4.0), 1e-12);
    // Without conditions: the average of the flights, as before.
    const auto plain = scheduled(on_model("law.toml", ""), folder / "m.toml");
    EXPECT_FALSE(plain.setup.cruise_level);
    EXPECT_EQ(plain.setup.mechanical->phases[flight::Phase::cruise].fourier.a0_w,
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
        const auto& cruise = mission.setup.mechanical->phases[flight::Phase::cruise];
        return energy_j(cruise.fourier, cruise.duration_s) / cruise.duration_s;
    };
    const auto mission = at("law.toml", "13.5");
    const double cubed = 13.5 * 13.5 * 13.5 / 2197.0;
    EXPECT_NEAR(mean_w(mission), 27.0 * cubed, 1e-9);
    EXPECT_NEAR(mission.setup.cruise_level->sd_w.value(), 1.5 * cubed * std::sqrt(4.0 / 3.0), 1e-9);
    EXPECT_NEAR(mission.setup.cruise_level->degrees_of_freedom, 2.0, 1e-12);
    EXPECT_TRUE(mission.setup.notes.empty());
    EXPECT_NEAR(mean_w(at("line.toml", "13.5")), 28.5, 1e-9);
    // Beyond what was flown drag's law is used and said, a line is not.
    EXPECT_EQ(
        at("law.toml", "15").setup.notes.front(),
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
    EXPECT_NEAR(at("wing.toml", "12").setup.cruise_level->sd_w.value(), 0.04 * 17.28, 1e-9);
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
        const auto& of = mission.setup.mechanical->phases[flight::Phase::cruise];
        return energy_j(of.fourier, of.duration_s) / of.duration_s;
    };
    EXPECT_EQ(read("").setup.power_model.value().model, "constant_mean");
    EXPECT_DOUBLE_EQ(cruise_w(read("")), 25.0);
    model.validation->prefers_curve = true;
    EXPECT_EQ(read("").setup.power_model.value().mean_absolute_error_percent, 15.0);
    EXPECT_NE(cruise_w(read("")), 25.0);
    // The law of airspeed has no error there: its use is a warning.
    EXPECT_FALSE(read("airspeed_m_per_s = 13").setup.power_model);
    EXPECT_NE(read("airspeed_m_per_s = 13").setup.notes.front().find("is unproven"), std::string::npos);
    model.physical = test::made_up_wing();
    model.physical->bins = 100;
    model.physical->bin_s = 30.0;
    const auto physical = read("airspeed_m_per_s = 12");
    EXPECT_EQ(physical.setup.power_model.value().model, "physical");
    EXPECT_NEAR(cruise_w(physical), 0.01 * 1728.0, 1e-9) << "the law of airspeed says another power";
    EXPECT_TRUE(physical.setup.notes.empty());
    model.validation.reset();
    EXPECT_FALSE(read("airspeed_m_per_s = 12").setup.power_model) << "nothing is known of its error";
    EXPECT_TRUE(read("airspeed_m_per_s = 12").setup.notes.empty());
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

using test::rejected;
using test::scratch_dir;
using test::write_text;

/// A folder with a model that knows motion, one that knows airspeed cubed from 10^3 to 14^3, and one that knows
/// neither.
std::filesystem::path path_folder() {
    auto folder = scratch_dir();
    auto model = mechanical::read_mechanical_model(test::source_dir() / "fits" / "mechanical" / "opterra-table1.toml");
    write_text(folder / "plain.toml", mechanical::to_toml(model));
    model.phases[flight::Phase::cruise].airspeed_law = mechanical::CovariateRegression{
        mechanical::Covariate::airspeed_cubed, 4, 1800.0, 700.0, 1000.0, 2744.0, 18.0, 7.0, 0.9};
    write_text(folder / "airspeed.toml", mechanical::to_toml(model));
    model.physical = test::made_up_wing();
    model.physical->bins = 100;
    model.physical->bin_s = 30.0;
    model.physical->correlation_s = 60.0;
    write_text(folder / "wing.toml", mechanical::to_toml(model));
    return folder;
}

const std::string battery = "battery = { voltage_v = 11.1, resistance_ohm = 0.05, capacity_ah = 3 }\n";

Mission read(const std::filesystem::path& folder, const std::string& model, const std::string& keys,
             const MissionReadOptions& reading = {}) {
    return std::get<Mission>(
        parse_mission("mechanical = \"" + model + "\"\n" + battery + keys, folder / "m.toml", reading));
}

const std::string out_and_back = R"([path]
airspeed_m_per_s = 13
altitude_m = 100
[[path.leg]]
length_m = 900
course_deg = 0
[[path.leg]]
length_m = 900
course_deg = 180
altitude_m = 130
[wind]
speed_m_per_s = 4
from_deg = 0
)";

TEST(PathToml, DurationAndPowerFollowFromThePath) {
    const auto folder = path_folder();
    const auto mission = read(folder, "wing.toml", out_and_back);
    const double climb = 30.0 / (900.0 / 17.0);  // nearly: the climb takes a little of the airspeed
    EXPECT_NEAR(mission.setup.duration_s[Phase::cruise], 900.0 / 9.0 + 900.0 / 17.0, 0.05);
    EXPECT_TRUE(mission.setup.duration_is_stated[Phase::cruise]);
    ASSERT_TRUE(mission.setup.cruise_path && mission.setup.cruise_level);
    const auto& pieces = *mission.setup.cruise_path->pieces;
    ASSERT_EQ(pieces.size(), 2U);
    EXPECT_NEAR(pieces[0].power_w, 21.97, 1e-9);
    EXPECT_NEAR(pieces[1].power_w, 21.97 + 8.0 * climb, 0.01);
    EXPECT_NEAR(mission.setup.cruise_level->mean_w, mean_power_w(*mission.setup.cruise_path), 1e-12);
    EXPECT_NEAR(*mission.setup.cruise_level->sd_w, 0.04 * mission.setup.cruise_level->mean_w, 0.02);
    EXPECT_TRUE(mission.setup.notes.empty());
    const auto flown = simulate(mission);
    const double takeoff_and_landing_wh =
        simulate(read(folder, "wing.toml", "duration_s = { cruise = 0 }\n")).summary.mechanical_energy_wh;
    EXPECT_NEAR(flown.summary.mechanical_energy_wh,
                takeoff_and_landing_wh + energy_j(*mission.setup.cruise_path) / 3600.0, 1e-9);
}

TEST(PathToml, FliesByTheLawOfAirspeedWhereThePathIsLevel) {
    const auto folder = path_folder();
    const std::string level = "[path]\nairspeed_m_per_s = 12\nleg = [{ length_m = 1200, course_deg = 0 }]\n";
    const auto mission = read(folder, "airspeed.toml", level);
    EXPECT_NEAR(mean_power_w(*mission.setup.cruise_path), 0.01 * 1728.0, 1e-9);
    EXPECT_NEAR(mission.setup.duration_s[Phase::cruise], 100.0, 1e-9);
    EXPECT_NE(rejected([&] { read(folder, "airspeed.toml", out_and_back); }).find("knows airspeed and not climb"),
              std::string::npos);
    EXPECT_EQ(
        rejected([&] { read(folder, "plain.toml", level); }, folder),
        "m.toml:3:1: the mechanical model 'opterra-table1' does not know what motion takes: it has no [physical]; "
        "fit one: flightwatt fit --model physical FLIGHT... -o MODEL.toml, of flights that measured their airspeed");
}

TEST(PathToml, ReadsWaypointsFromFiles) {
    const auto folder = path_folder();
    write_text(folder / "w.csv", "east_m,north_m,altitude_m\n0,0,100\n1300,0,100\n1300,1300,\n");
    write_text(folder / "w.geojson", R"({"type": "LineString", "coordinates": [[5.0, 45.0], [5.0, 45.01]]})");
    write_text(folder / "plan.xml", R"(<flight_plan lat0="43" lon0="1" alt="200"><waypoints>
        <waypoint name="A" x="500" y="0"/><waypoint name="B" x="500" y="650"/></waypoints></flight_plan>)");
    const std::string path = "[path]\nairspeed_m_per_s = 13\n";
    EXPECT_NEAR(read(folder, "wing.toml", path + "waypoints = \"w.csv\"\n").setup.duration_s[Phase::cruise], 200.0,
                1e-9);
    EXPECT_NEAR(read(folder, "wing.toml", path + "waypoints = \"w.geojson\"\n").setup.duration_s[Phase::cruise],
                1111.32 / 13.0, 0.01);
    const std::string plan = "altitude_m = 200\nflight_plan = \"plan.xml\"\nwaypoint_order = [\"A\", \"B\"]\n";
    EXPECT_NEAR(read(folder, "wing.toml", path + plan).setup.duration_s[Phase::cruise], 1150.0 / 13.0, 1e-9);
    EXPECT_NE(rejected([&] {
                  read(folder, "wing.toml", path + "flight_plan = \"plan.xml\"\n");
              }).find("flight_plan and waypoint_order belong together"),
              std::string::npos);
    EXPECT_NE(rejected([&] {
                  read(folder, "wing.toml", path + "waypoints = \"none.csv\"\n");
              }).find("m.toml:5:1: waypoints: there is no file"),
              std::string::npos);
}

TEST(PathToml, FliesOtherExtents) {
    const auto folder = path_folder();
    const std::string circles = "[path]\nairspeed_m_per_s = 13\nleg = [{ circles = 2, radius_m = 65 }]\n";
    const double one_s = read(folder, "wing.toml", circles).setup.duration_s[Phase::cruise] / 2.0;
    EXPECT_NEAR(read(folder, "wing.toml", circles, {.circles = 7.0}).setup.duration_s[Phase::cruise], 7.0 * one_s,
                1e-9);
    const std::string home =
        "[path]\nairspeed_m_per_s = 13\nreturn_to_start = true\nleg = [{ length_m = 1300, course_deg = 0 }]\n";
    EXPECT_NEAR(read(folder, "wing.toml", home).setup.duration_s[Phase::cruise], 200.0, 1e-9);
    EXPECT_NEAR(read(folder, "wing.toml", home, {.return_after_m = 650.0}).setup.duration_s[Phase::cruise], 100.0,
                1e-9);
    EXPECT_THROW(read(folder, "wing.toml", home, {.cruise_s = 100.0}), NoResultError);
}

TEST(PathToml, RefusesWhatContradictsThePath) {
    const auto folder = path_folder();
    const auto refusal = [&](const std::string& before, const std::string& path) {
        return rejected([&] { read(folder, "wing.toml", before + path); }, folder);
    };
    EXPECT_EQ(refusal("duration_s = { cruise = 600 }\n", out_and_back),
              "m.toml:3:16: the duration of the cruise follows from [path]; leave it out, or the path");
    EXPECT_NE(refusal("airspeed_m_per_s = 12\n", out_and_back).find("both say how the cruise is flown"),
              std::string::npos);
    EXPECT_NE(
        refusal("uncertainty = { duration_sd_s = { cruise = 5 } }\n", out_and_back).find("state how the wind differs"),
        std::string::npos);
    EXPECT_NE(refusal("[wind]\nspeed_m_per_s = 3\nfrom_deg = 10\n", "").find("[wind] belongs to a [path]"),
              std::string::npos);
    EXPECT_NE(refusal("[path]\nairspeed_m_per_s = 13\n", "").find("the path has no legs"), std::string::npos);
    EXPECT_NE(refusal("[path]\nairspeed_m_per_s = 13\nleg = [{ length = 3 }]\n", "").find("unknown key 'length'"),
              std::string::npos);
    EXPECT_NE(refusal("[path]\nairspeed_m_per_s = 3\nleg = [{ length_m = 30, course_deg = 1 }]\n",
                      "[wind]\n"
                      "speed_m_per_s = 9\nfrom_deg = 1\n")
                  .find("m.toml:5:8: leg 1: the wind of 9 m/s from 1 degrees forbids"),
              std::string::npos);
    EXPECT_NE(refusal("[path]\nairspeed_m_per_s = 3\nleg = [{ circles = 1, radius_m = 9, turn = \"up\" }]\n", "")
                  .find("there is no turn 'up'"),
              std::string::npos);
}

TEST(PathToml, SaysWhatIsExtrapolated) {
    const auto mission = read(path_folder(), "wing.toml",
                              "[path]\nairspeed_m_per_s = 19\nleg = [{ length_m = 1200, course_deg = 0 }]\n");
    ASSERT_EQ(mission.setup.notes.size(), 1U);
    EXPECT_NE(mission.setup.notes.front().find("beyond what the model's flights flew"), std::string::npos);
}

TEST(PathToml, APlannedMissionFindsItsWaypoints) {
    const auto folder = path_folder();
    write_text(folder / "w.csv", "east_m,north_m\n900,0\n");
    const auto text =
        "mechanical = \"wing.toml\"\n" + battery + "[path]\nairspeed_m_per_s = 13\nwaypoints = \"w.csv\"\n";
    const auto mission = std::get<Mission>(parse_mission(text, folder / "m.toml"));
    std::filesystem::create_directories(folder / "below");
    const auto planned =
        planned_mission_toml(text, folder / "m.toml", mission.setup.compute, mission.schedule, folder / "below").text;
    EXPECT_NE(planned.find("../w.csv"), std::string::npos) << planned;
    const auto again = std::get<Mission>(parse_mission(planned, folder / "below" / "p.toml"));
    EXPECT_EQ(again.setup.duration_s[Phase::cruise], mission.setup.duration_s[Phase::cruise]);
}

}  // namespace
}  // namespace flightwatt::mission
