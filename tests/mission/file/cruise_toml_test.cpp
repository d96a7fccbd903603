
#include "mission/file/cruise_toml.h"

#include "helpers/path_missions.h"
#include "helpers/rejected.h"
#include "mission/mission_file.h"
#include "mission/mission_read_options.h"
#include "mission/planned_mission_toml.h"
#include "mission/simulation.h"

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
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A folder with a model that knows motion, and one that does not.
std::filesystem::path path_folder() {
    auto folder = scratch_dir();
    const auto model =
        mechanical::read_mechanical_model(test::source_dir() / "fits" / "mechanical" / "opterra-table1.toml");
    write_text(folder / "plain.toml", mechanical::to_toml(model));
    write_wing(model, folder / "wing.toml");
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
    const double legs_s = 900.0 / 9.0 + 900.0 / 17.0;
    EXPECT_GT(mission.setup.duration_s[Phase::cruise], legs_s);
    EXPECT_LT(mission.setup.duration_s[Phase::cruise], legs_s + 12.0);  // a turn of 180 degrees
    EXPECT_TRUE(mission.setup.duration_is_stated[Phase::cruise]);
    ASSERT_TRUE(mission.setup.cruise_path && mission.setup.cruise_level);
    const auto& pieces = *mission.setup.cruise_path->pieces;
    ASSERT_GE(pieces.time_s.size(), 3U);
    EXPECT_NEAR(pieces.energy_j[1] / pieces.time_s[1], 21.97, 1e-9);
    EXPECT_NEAR(mission.setup.cruise_level->mean_w, mean_power_w(*mission.setup.cruise_path), 1e-12);
    EXPECT_NEAR(*mission.setup.cruise_level->sd_w, 0.04 * mission.setup.cruise_level->mean_w, 0.02);
    EXPECT_TRUE(mission.setup.notes.empty());
    const auto flown = simulate(mission);
    const double takeoff_and_landing_wh =
        simulate(read(folder, "wing.toml", "duration_s = { cruise = 0 }\n")).summary.mechanical_energy_wh;
    EXPECT_NEAR(flown.summary.mechanical_energy_wh,
                takeoff_and_landing_wh + energy_j(*mission.setup.cruise_path) / 3600.0, 1e-9);
}

TEST(PathToml, AssumesTheMeanPowerInCalmAirWithoutAModelThatKnowsMotion) {
    const auto folder = path_folder();
    const auto calm = out_and_back.substr(0, out_and_back.find("[wind]"));
    const auto mission = read(folder, "plain.toml", calm);
    EXPECT_NEAR(mission.setup.duration_s[Phase::cruise], 1800.0 / 13.0 + 4.2, 0.3);  // with a turn of 180 degrees
    EXPECT_NEAR(mean_power_w(*mission.setup.cruise_path), cruise_w(mission), 1e-9);
    ASSERT_EQ(mission.setup.notes.size(), 1U);
    EXPECT_NE(mission.setup.notes.front().find("the flight in wind is unknown"), std::string::npos);
    EXPECT_EQ(
        rejected([&] { read(folder, "plain.toml", out_and_back); }, folder),
        "m.toml:14:1: the flight in wind is unknown: the mechanical model has no [physical] part, of flights that "
        "measured their airspeed; without wind the path is flown at the mean power of the model's flights");
}

TEST(PathToml, ReadsWaypointsFromFiles) {
    const auto folder = path_folder();
    write_text(folder / "w.csv", "east_m,north_m,altitude_m\n0,0,100\n1300,0,100\n1300,1300,\n");
    write_text(folder / "w.geojson", R"({"type": "LineString", "coordinates": [[5.0, 45.0], [5.0, 45.01]]})");
    write_text(folder / "plan.xml", R"(<flight_plan lat0="43" lon0="1" alt="200"><waypoints>
        <waypoint name="A" x="500" y="0"/><waypoint name="B" x="500" y="650"/></waypoints></flight_plan>)");
    const std::string path = "[path]\nairspeed_m_per_s = 13\n";
    const double corner_s = 13.0 / 9.80665 * (2.0 - 3.14159265358979 / 2.0);  // that its arc saves
    EXPECT_NEAR(read(folder, "wing.toml", path + "waypoints = \"w.csv\"\n").setup.duration_s[Phase::cruise],
                200.0 - corner_s, 1e-6);
    EXPECT_NEAR(read(folder, "wing.toml", path + "waypoints = \"w.geojson\"\n").setup.duration_s[Phase::cruise],
                1111.32 / 13.0, 0.01);
    const std::string plan = "altitude_m = 200\nflight_plan = \"plan.xml\"\nwaypoint_order = [\"A\", \"B\"]\n";
    EXPECT_NEAR(read(folder, "wing.toml", path + plan).setup.duration_s[Phase::cruise], 1150.0 / 13.0 - corner_s, 1e-6);
    EXPECT_NE(rejected([&] {
                  read(folder, "wing.toml", path + "waypoints = \"none.csv\"\n");
              }).find("m.toml:5:1: waypoints: there is no file"),
              std::string::npos);
}

TEST(PathToml, FliesPlansFromTheirFirstPlaceAndAltitude) {
    const auto folder = path_folder();
    write_text(folder / "plan.xml", R"(<flight_plan lat0="43" lon0="1" alt="200"><waypoints>
        <waypoint name="A" x="500" y="0"/><waypoint name="B" x="500" y="650" alt="230"/></waypoints><blocks>
        <block name="There"><go wp="A"/><go wp="B"/><exception cond="x" deroute="Home"/></block>
        <block name="Round"><circle wp="A" radius="nav_radius" until="NavCircleCount() > 2"/></block>
        </blocks></flight_plan>)");
    write_text(folder / "field.geojson", R"({"type": "Polygon", "coordinates":
        [[[8.0, 47.0], [8.00526, 47.0], [8.00526, 47.0036], [8.0, 47.0036], [8.0, 47.0]]]})");
    const std::string path = "[path]\nairspeed_m_per_s = 13\n";
    const auto length_m = [&](const std::string& keys) {
        return 13.0 * read(folder, "wing.toml", path + keys).setup.duration_s[Phase::cruise];
    };
    const std::string plan = "flight_plan = \"plan.xml\"\nblocks = ";
    EXPECT_NEAR(length_m(plan + "[\"There\"]\n"), 650.0, 1.0);
    const double around_m = length_m(plan + "[\"Round\", \"There\"]\nradius_m = 60\n");
    EXPECT_GT(around_m, 4.0 * 3.14159 * 60.0 + 60.0 + 650.0);  // and the turns towards the centre and the leg
    EXPECT_LT(around_m, 4.0 * 3.14159 * 60.0 + 60.0 + 650.0 + 2.0 * 3.14159 * 17.3);
    EXPECT_EQ(read(folder, "wing.toml", path + plan + "[\"There\"]\n").setup.notes,
              std::vector<std::string>{"path: block 'There': not followed: exceptions to 'Home'"});
    const std::string area = "area = \"field.geojson\"\nspacing_m = 50\nheading_deg = 0\n";
    EXPECT_NEAR(length_m(area), 8.0 * 400.0 + 7.0 * 78.54, 15.0);
    const auto refusal = [&](const std::string& keys) {
        return rejected([&] { read(folder, "wing.toml", path + keys); }, folder);
    };
    EXPECT_EQ(refusal(plan + "[\"there\"]\n"),
              "plan.xml: there is no block 'there'; did you mean 'There'? the plan "
              "has There, Round");
    EXPECT_NE(refusal("flight_plan = \"plan.xml\"\n").find("flight_plan needs blocks, or waypoint_order"),
              std::string::npos);
    EXPECT_NE(refusal(plan + "[\"There\"]\n" + area).find("flight_plan and area are two paths"), std::string::npos);
    EXPECT_NE(refusal(area + "radius_m = 50\n").find("radius_m belongs to"), std::string::npos);
    const double once_s = read(folder, "wing.toml", path + area).setup.duration_s[Phase::cruise];
    EXPECT_NEAR(read(folder, "wing.toml", path + area, {.path_times = 0.3}).setup.duration_s[Phase::cruise],
                0.3 * once_s, 1e-6 * once_s);
}

/// Packs flew home over zones that the lines avoid, without a word.
TEST(PathToml, WarnsOfTheWaysOfPacksOverZones) {
    const auto folder = path_folder();
    write_text(folder / "hole.geojson", R"({"type": "Polygon", "coordinates":
        [[[8.0, 47.0], [8.00526, 47.0], [8.00526, 47.0036], [8.0, 47.0036], [8.0, 47.0]],
         [[8.002, 47.001], [8.003, 47.001], [8.003, 47.002], [8.002, 47.002], [8.002, 47.001]]]})");
    const std::string path =
        "[path]\nairspeed_m_per_s = 13\narea = \"hole.geojson\"\nspacing_m = 50\nheading_deg = 0\n";
    const auto warns = [](const MissionSetup& setup) {
        return std::ranges::any_of(setup.notes,
                                   [](const auto& note) { return note.starts_with("packs: the ways home"); });
    };
    EXPECT_FALSE(warns(read(folder, "wing.toml", path).setup));
    EXPECT_TRUE(warns(read(folder, "wing.toml", path + "[packs]\ncount = 3\nchange_s = 60\n").setup));
}

TEST(PathToml, FliesTurnsWithinTheBankAndRadiusThatItStates) {
    const auto folder = path_folder();
    const std::string corner =
        "[path]\nairspeed_m_per_s = 13\nleg = [{ length_m = 650, course_deg = 0 }, { length_m = 650, course_deg = 90 "
        "}]\n";
    const auto cruise_s = [&](const std::string& keys) {
        auto path = corner;
        return read(folder, "wing.toml", path.insert(path.find("leg"), keys)).setup.duration_s[Phase::cruise];
    };
    const auto cut_s = [](double radius_m) { return (1300.0 - radius_m * (2.0 - 3.14159265 / 2.0)) / 13.0; };
    EXPECT_NEAR(cruise_s(""), cut_s(169.0 / 9.80665), 1e-6);
    EXPECT_NEAR(cruise_s("max_bank_deg = 20\n"), cut_s(169.0 / 9.80665 / std::tan(20.0 * 3.14159265 / 180.0)), 1e-6);
    EXPECT_NEAR(cruise_s("turn_radius_m = 80\n"), cut_s(80.0), 1e-6);
    EXPECT_NEAR(cruise_s("turn_radius_m = 8\n"), cruise_s(""), 1e-9);
    const auto narrow =
        read(folder, "wing.toml", "[path]\nairspeed_m_per_s = 13\nleg = [{ circles = 2, radius_m = 9 }]\n");
    ASSERT_FALSE(narrow.setup.notes.empty());
    EXPECT_NE(narrow.setup.notes.front().find("leg 1: circles of 9 m need a bank of more than 45 degrees"),
              std::string::npos);
    EXPECT_TRUE(narrow.setup.uncertain.empty());
}

TEST(PathToml, FliesThePlansSpeedWhereItStatesNone) {
    const auto folder = path_folder();
    write_text(folder / "q.plan", R"({"fileType": "Plan", "version": 1, "mission": {"version": 2, "vehicleType": 1,
"cruiseSpeed": 12, "plannedHomePosition": [47.0, 8.0, 100], "items": [
{"type": "SimpleItem", "command": 16, "frame": 3, "params": [0, 0, 0, null, 47.001, 8.0, 60]}]}})");
    write_text(folder / "w.csv", "east_m,north_m\n0,0\n130,0\n");
    const auto setup = read(folder, "wing.toml", "[path]\nwaypoints = \"q.plan\"\n").setup;
    EXPECT_DOUBLE_EQ(setup.cruise_path->plan->path.elements.front().airspeed_m_per_s, 12.0);
    EXPECT_EQ(setup.notes.front(), "path: airspeed_m_per_s is not stated: 12 m/s, the plan's cruiseSpeed");
    const auto stated = read(folder, "wing.toml", "[path]\nairspeed_m_per_s = 13\nwaypoints = \"q.plan\"\n").setup;
    EXPECT_DOUBLE_EQ(stated.cruise_path->plan->path.elements.front().airspeed_m_per_s, 13.0);
    EXPECT_NE(rejected([&] { read(folder, "wing.toml", "[path]\nwaypoints = \"w.csv\"\n"); }, folder)
                  .find("airspeed_m_per_s"),
              std::string::npos);
}

/// A plan that flies north at this altitude above home and descends there to another.
std::string plan_at(double altitude_m, double last_m) {
    return fmt::format(R"({{"fileType": "Plan", "version": 1, "mission": {{"version": 2, "vehicleType": 1,
"cruiseSpeed": 13, "plannedHomePosition": [47.0, 8.0, 100], "items": [
{{"type": "SimpleItem", "command": 22, "frame": 3, "params": [0, 0, 0, 0, 0, 0, {0}]}},
{{"type": "SimpleItem", "command": 16, "frame": 3, "params": [0, 0, 0, 0, 47.02, 8.0, {0}]}},
{{"type": "SimpleItem", "command": 31, "frame": 3, "params": [0, 0, 0, 0, 47.02, 8.0, {1}]}}]}}}})",
                       altitude_m, last_m);
}

/// Take-offs climbed to 40 to 60 m, and further height at 4 m/s; landings at 2 m/s.
std::filesystem::path folder_with_heights() {
    auto folder = path_folder();
    auto model = mechanical::read_mechanical_model(folder / "wing.toml");
    model.phases[Phase::takeoff].heights = mechanical::PhaseHeights{50.0, 40.0, 60.0, 4.0};
    model.phases[Phase::landing].heights = mechanical::PhaseHeights{50.0, 40.0, 60.0, 2.0};
    write_wing(model, folder / "heights.toml");
    return folder;
}

TEST(PathToml, IsUncertainWhereItsHeightIsUnknownOrBelowHome) {
    const auto folder = folder_with_heights();
    const auto uncertain = [&](const std::string& keys) {
        return read(folder, "heights.toml", "[path]\nairspeed_m_per_s = 13\n" + keys).setup.uncertain;
    };
    const std::string leg = "leg = [{ length_m = 2600, course_deg = 0 }]\n";
    EXPECT_TRUE(uncertain("altitude_m = 60\n" + leg).empty());
    EXPECT_THAT(
        uncertain("altitude_m = 500\n" + leg),
        ElementsAre("whether the 500 m at its start are above the ground is not stated: take-off and landing are "
                    "those of the model's flights, of up to 60 m"));
    write_text(folder / "q.plan", plan_at(-380.0, -380.0));
    EXPECT_THAT(uncertain("waypoints = \"q.plan\"\n"),
                ElementsAre("take-off: the path begins 380 m below home", "landing: the path ends 380 m below home"));
}

/// The altitudes of an absolute KML were of an unknown reference in the warning.
TEST(PathToml, WarnsThatAltitudesOfAKmlAreAboveTheSea) {
    const auto folder = folder_with_heights();
    write_text(folder / "a.kml",
               "<kml><LineString><altitudeMode>absolute</altitudeMode><coordinates>8,47,285 8,47.02,285</coordinates>"
               "</LineString></kml>");
    const auto setup = [&](bool is_written) {
        return read(folder, "heights.toml", "[path]\nairspeed_m_per_s = 13\nwaypoints = \"a.kml\"\n",
                    {.counts_written_heights = is_written})
            .setup;
    };
    EXPECT_THAT(
        setup(false).uncertain,
        ElementsAre("the 285 m at its start are above the sea, and the height of home is not stated: take-off and "
                    "landing are those of the model's flights, of up to 60 m"));
    const auto written = setup(true);
    EXPECT_TRUE(written.cruise_path->plan->origin->is_above_sea);
    EXPECT_THAT(written.notes, Contains(HasSubstr("the files of the packs have them above the sea")));
    EXPECT_NEAR(written.duration_s[Phase::takeoff] - setup(false).duration_s[Phase::takeoff], 235.0 / 4.0, 1e-9);
}

TEST(PathToml, IsUncertainWithThePlanOfAnotherKindOfVehicle) {
    const auto folder = path_folder();
    auto text = plan_at(50.0, 50.0);
    write_text(folder / "q.plan", text.replace(text.find("\"vehicleType\": 1"), 16, "\"vehicleType\": 2"));
    EXPECT_THAT(read(folder, "wing.toml", "[path]\nairspeed_m_per_s = 13\nwaypoints = \"q.plan\"\n").setup.uncertain,
                Contains("the plan is for a multirotor, and the model of a wing"));
}

TEST(PathToml, ClimbsToThePlansAltitudeAndDescendsFromIt) {
    const auto folder = folder_with_heights();
    const std::string path = "[path]\nwaypoints = \"q.plan\"\n";
    const auto at = [&](double altitude_m, double last_m, const std::string& keys = "",
                        const std::string& model = "heights.toml") {
        write_text(folder / "q.plan", plan_at(altitude_m, last_m));
        return read(folder, model, keys + path).setup;
    };
    const auto flown = at(50.0, 50.0);
    const auto& model = *flown.mechanical;
    EXPECT_DOUBLE_EQ(flown.duration_s[Phase::takeoff], model.phases[Phase::takeoff].duration_s);
    EXPECT_DOUBLE_EQ(flown.duration_s[Phase::landing], model.phases[Phase::landing].duration_s);
    EXPECT_THAT(flown.notes, Not(Contains(HasSubstr("take-off: "))));
    const auto high = at(110.0, 80.0);
    EXPECT_NEAR(high.duration_s[Phase::takeoff] - flown.duration_s[Phase::takeoff], 60.0 / 4.0, 1e-9);
    EXPECT_NEAR(high.duration_s[Phase::landing] - flown.duration_s[Phase::landing], 30.0 / 2.0, 1e-9);
    EXPECT_THAT(high.notes, Contains(HasSubstr("take-off: 43 s to 110 m; the model's flights climbed to 40 to 60 m")));
    EXPECT_THAT(high.notes, Contains(HasSubstr("landing: ")));
    EXPECT_NEAR(flown.duration_s[Phase::takeoff] - at(10.0, 10.0).duration_s[Phase::takeoff], 10.0 / 4.0, 1e-9)
        << "no lower than flown";
    const auto stated = at(110.0, 80.0, "duration_s = { takeoff = 20 }\n");
    EXPECT_EQ(stated.duration_s[Phase::takeoff], 20.0);
    EXPECT_DOUBLE_EQ(stated.duration_s[Phase::landing], high.duration_s[Phase::landing]);
    EXPECT_TRUE(flown.uncertain.empty());
    EXPECT_THAT(at(1000.0, 1000.0).uncertain, ElementsAre(HasSubstr("higher than the model's flights flew")));
    EXPECT_THAT(at(1000.0, 1000.0, "", "wing.toml").uncertain, ElementsAre(HasSubstr("fit it again")));
    EXPECT_THAT(at(50.0, 50.0, "", "wing.toml").notes, Contains(HasSubstr("120 m are assumed")));
}

TEST(PathToml, TakesOffFromTheStatedGround) {
    const auto folder = folder_with_heights();
    const auto setup = [&](const std::string& keys) {
        return read(folder, "heights.toml", "[path]\nairspeed_m_per_s = 13\n" + keys).setup;
    };
    const std::string leg = "altitude_m = 510\nleg = [{ length_m = 2600, course_deg = 0 }]\n";
    const auto unknown = setup(leg);
    const auto stated = setup("ground_altitude_m = 400\n" + leg);
    EXPECT_NEAR(stated.duration_s[Phase::takeoff] - unknown.duration_s[Phase::takeoff], 60.0 / 4.0, 1e-9);
    EXPECT_NEAR(stated.duration_s[Phase::landing] - unknown.duration_s[Phase::landing], 60.0 / 2.0, 1e-9);
    EXPECT_THAT(stated.uncertain, Not(Contains(HasSubstr("is not stated"))));
    write_text(folder / "a.kml",
               "<kml><LineString><altitudeMode>absolute</altitudeMode><coordinates>8,47,285 8,47.02,285</coordinates>"
               "</LineString></kml>");
    const auto kml = setup("ground_altitude_m = 185\nwaypoints = \"a.kml\"\n");
    EXPECT_NEAR(kml.duration_s[Phase::takeoff] - unknown.duration_s[Phase::takeoff], 50.0 / 4.0, 1e-9);
    EXPECT_FALSE(kml.cruise_path->plan->origin->is_above_sea);
    EXPECT_EQ(kml.cruise_path->plan->origin->altitude_m, std::optional(100.0));
    write_text(folder / "q.plan", plan_at(50.0, 50.0));
    EXPECT_NE(rejected([&] { setup("ground_altitude_m = 400\nwaypoints = \"q.plan\"\n"); }, folder)
                  .find("the plan states how high its altitudes are above home"),
              std::string::npos);
}

/// Files of packs state altitudes above home where the mission does not state it: they climbed higher than was planned.
TEST(PathToml, CountsTheHeightsThatTheFilesOfPacksState) {
    const auto folder = folder_with_heights();
    const auto as_written = [&](const std::string& keys, bool is_written = true) {
        return read(folder, "heights.toml",
                    "[path]\nairspeed_m_per_s = 13\nstart = { latitude_deg = 47, longitude_deg = 8 }\n" + keys,
                    {.counts_written_heights = is_written})
            .setup;
    };
    const std::string high =
        "altitude_m = 90\nleg = [{ length_m = 2600, course_deg = 0 }, { length_m = 2600, "
        "course_deg = 180, altitude_m = 70 }]\n";
    const auto unknown = as_written(high, false);
    const auto written = as_written(high);
    EXPECT_NEAR(written.duration_s[Phase::takeoff] - unknown.duration_s[Phase::takeoff], 40.0 / 4.0, 1e-9);
    EXPECT_NEAR(written.duration_s[Phase::landing] - unknown.duration_s[Phase::landing], 20.0 / 2.0, 1e-9);
    EXPECT_THAT(written.notes, Contains(HasSubstr("what its altitudes are above is not stated")));
    EXPECT_THAT(unknown.uncertain, Contains(HasSubstr("above the ground is not stated")));
    EXPECT_THAT(written.uncertain, Not(Contains(HasSubstr("is not stated"))));
    const auto without = as_written("leg = [{ length_m = 2600, course_deg = 0 }]\n");
    EXPECT_EQ(without.cruise_path->plan->origin->altitude_m, std::optional(50.0));
    EXPECT_THAT(without.notes, Contains("path: no altitude is stated: 50 m above the ground"));
}

/// Plans of packs had home at 0 m.
TEST(PathToml, KeepsTheAltitudeOfAPlansHome) {
    const auto folder = folder_with_heights();
    write_text(folder / "q.plan", plan_at(50.0, 40.0));
    const auto setup = read(folder, "heights.toml", "[path]\nwaypoints = \"q.plan\"\n").setup;
    EXPECT_EQ(setup.cruise_path->plan->origin->ground_m, 100.0);
    EXPECT_EQ(setup.cruise_path->plan->origin->altitude_m, std::optional(50.0));
}

TEST(PathToml, ChangesItsHeightAboveOnePlaceAtTheModelsRates) {
    const auto folder = folder_with_heights();
    const auto circling = [&](double last_m) {
        write_text(folder / "q.plan", plan_at(90.0, last_m));
        return read(folder, "heights.toml", "[path]\nwaypoints = \"q.plan\"\n").setup;
    };
    const auto down = circling(40.0);
    EXPECT_NEAR(down.duration_s[Phase::cruise] - circling(90.0).duration_s[Phase::cruise], 50.0 / 2.0, 1e-6);
    EXPECT_THAT(down.notes, Contains("path: item 3: 50 m of height above one place are flown at 2 m/s, as the model's "
                                     "flights did"));
    EXPECT_THAT(circling(90.0).notes, Not(Contains(HasSubstr("above one place"))));
}

TEST(PathToml, FliesWaypointsOfALogWithWhateverElseThePathStates) {
    const auto folder = path_folder();
    write_text(folder / "w.csv",
               "east_m,north_m,altitude_m,airspeed_m_per_s,duration_s\n0,0,280,,\n"
               "130,0,284,13,10\n260,0,281,13,10\n");
    for (const auto* keys :
         {"", "altitude_m = 100\n", "climb_m_per_s = 0.1\n", "altitude_m = 90\ndescent_m_per_s = 0.1\n"})
        EXPECT_NEAR(
            read(folder, "wing.toml", std::string("[path]\nairspeed_m_per_s = 13\nwaypoints = \"w.csv\"\n") + keys)
                .setup.duration_s[Phase::cruise],
            20.0, 1e-9)
            << keys;
}

TEST(PathToml, FliesOtherExtents) {
    const auto folder = path_folder();
    const std::string circles = "[path]\nairspeed_m_per_s = 13\nleg = [{ circles = 2, radius_m = 65 }]\n";
    const double one_s = read(folder, "wing.toml", circles).setup.duration_s[Phase::cruise] / 2.0;
    EXPECT_NEAR(read(folder, "wing.toml", circles, {.circles = 7.0}).setup.duration_s[Phase::cruise], 7.0 * one_s,
                1e-9);
    const std::string home =
        "[path]\nairspeed_m_per_s = 13\nreturn_to_start = true\nleg = [{ length_m = 1300, course_deg = 0 }]\n";
    constexpr double turn_s = 4.2;  // of 180 degrees
    EXPECT_NEAR(read(folder, "wing.toml", home).setup.duration_s[Phase::cruise], 200.0 + turn_s, 0.1);
    EXPECT_NEAR(read(folder, "wing.toml", home, {.return_after_m = 650.0}).setup.duration_s[Phase::cruise],
                100.0 + turn_s, 0.1);
    EXPECT_THROW(read(folder, "wing.toml", home, {.cruise_s = 100.0}), NoResultError);
}

TEST(PathToml, WinsOverDurationAndAirspeedWithNotes) {
    const auto folder = path_folder();
    const auto alone = read(folder, "wing.toml", out_and_back).setup;
    const auto both =
        read(folder, "wing.toml", "duration_s = { cruise = 25 }\nairspeed_m_per_s = 12\n" + std::string(out_and_back))
            .setup;
    EXPECT_EQ(both.duration_s[Phase::cruise], alone.duration_s[Phase::cruise]);
    EXPECT_EQ(both.cruise_level->mean_w, alone.cruise_level->mean_w);
    ASSERT_EQ(both.notes.size(), alone.notes.size() + 2);
    EXPECT_NE(both.notes[0].find("duration_s.cruise is not used"), std::string::npos);
    EXPECT_NE(both.notes[1].find("airspeed_m_per_s is not used"), std::string::npos);
}

TEST(PathToml, RefusesWhatContradictsThePath) {
    const auto folder = path_folder();
    const auto refusal = [&](const std::string& before, const std::string& path) {
        return rejected([&] { read(folder, "wing.toml", before + path); }, folder);
    };
    EXPECT_NE(
        refusal("uncertainty = { duration_sd_s = { cruise = 5 } }\n", out_and_back).find("state how the wind differs"),
        std::string::npos);
    EXPECT_NE(refusal("[wind]\nspeed_m_per_s = 3\nfrom_deg = 10\n", "").find("[wind] belongs to a [path]"),
              std::string::npos);
    EXPECT_NE(refusal("[path]\nairspeed_m_per_s = 13\n", "").find("the path has no legs"), std::string::npos);
    EXPECT_NE(refusal("[path]\nairspeed_m_per_s = 13\nleg = [{ length = 3 }]\n", "").find("unknown key 'length'"),
              std::string::npos);
    EXPECT_NE(refusal("[path]\nairspeed_m_per_s = 11\nleg = [{ length_m = 30, course_deg = 1 }]\n",
                      "[wind]\n"
                      "speed_m_per_s = 12\nfrom_deg = 1\n")
                  .find("m.toml:5:8: leg 1: "),
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
