#include "path/waypoint_files.h"

#include "base/atomic_file.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"
#include "path/plan_blocks.h"
#include "path/plan_files.h"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

using test::rejected;

TEST(WaypointFiles, AreCsvInEitherCoordinates) {
    const auto local = parse_waypoint_csv("east_m,north_m,altitude_m,hold_s\n0,0,100,\n300,400,,20\n", "w.csv");
    ASSERT_EQ(local.size(), 2U);
    EXPECT_EQ(local[0].altitude_m, std::optional(100.0));
    EXPECT_FALSE(local[0].hold_s || local[1].altitude_m);
    EXPECT_DOUBLE_EQ(local[1].place->north_m, 400.0);
    EXPECT_EQ(local[1].hold_s, std::optional(20.0));
    EXPECT_EQ(local[1].where.line, 3U);
    const auto geographic =
        parse_waypoint_csv("longitude_deg,latitude_deg,circles,radius_m,airspeed_m_per_s\n1.5,43.5,3,60,14\n", "w.csv");
    EXPECT_DOUBLE_EQ(geographic[0].geographic->latitude_deg, 43.5);
    EXPECT_EQ(geographic[0].circles, std::optional(3.0));
    EXPECT_EQ(geographic[0].airspeed_m_per_s, std::optional(14.0));
}

TEST(WaypointFiles, RefuseOtherCsv) {
    const auto refusal = [](std::string_view text) { return rejected([&] { parse_waypoint_csv(text, "w.csv"); }); };
    EXPECT_EQ(refusal("lat,lon\n1,2\n").substr(0, 31), "w.csv:1: unknown column 'lat'; ");
    EXPECT_EQ(refusal("altitude_m\n1\n"),
              "w.csv:1: has no places; expected the columns east_m and north_m, or latitude_deg and longitude_deg");
    EXPECT_NE(refusal("east_m,north_m\n1,x\n").find("w.csv:2:3: north_m is not a finite number: 'x'"),
              std::string::npos);
    EXPECT_NE(refusal("latitude_deg,longitude_deg\n91,2\n").find("w.csv:2: latitude_deg = 91"), std::string::npos);
    EXPECT_NE(refusal("east_m,north_m,airspeed_m_per_s\n1,1,-3\n").find("w.csv:2:5: airspeed_m_per_s = -3"),
              std::string::npos);
    EXPECT_EQ(refusal("east_m,north_m\n"), "w.csv: has no waypoints");
    EXPECT_EQ(refusal("time_s,power_w\n1,2\n"),
              "w.csv:1: has the times of a flight, and is no list of waypoints; `flightwatt LOG` answers for a log");
}

TEST(WaypointFiles, AreGeoJson) {
    const auto line =
        parse_geojson(R"({"type": "LineString", "coordinates": [[1.5, 43.5, 100], [1.6, 43.6, 120]]})", "a.geojson");
    ASSERT_EQ(line.size(), 2U);
    EXPECT_DOUBLE_EQ(line[1].geographic->latitude_deg, 43.6);
    EXPECT_DOUBLE_EQ(line[1].geographic->longitude_deg, 1.6);
    EXPECT_EQ(line[1].altitude_m, std::optional(120.0));
    const auto points = parse_geojson(R"({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"name": "home"}, "geometry": {"type": "Point", "coordinates": [1.5, 43.5]}},
        {"type": "Feature", "properties": {"hold_s": 30, "circles": null},
         "geometry": {"type": "Point", "coordinates": [1.6, 43.5]}}]})",
                                      "a.geojson");
    ASSERT_EQ(points.size(), 2U);
    EXPECT_EQ(points[1].hold_s, std::optional(30.0));
    EXPECT_FALSE(points[1].circles);
}

TEST(WaypointFiles, AreToldApartByTheirEndingInAnyCase) {
    const auto file = test::scratch_dir() / "FIELD.GEOJSON";
    std::ofstream(file) << R"({"type": "LineString", "coordinates": [[1.5, 43.5], [1.51, 43.5]]})";
    EXPECT_EQ(read_waypoints(file, {}).entries.size(), 2U);
}

TEST(WaypointFiles, RefuseOtherJson) {
    const auto refusal = [](std::string_view text) { return rejected([&] { parse_geojson(text, "a.json"); }); };
    EXPECT_EQ(refusal("{\n \"type\": }"), "a.json:2: is not JSON; expected GeoJSON: Points and LineStrings");
    EXPECT_NE(refusal("[1, 2]").find("is no object"), std::string::npos);
    EXPECT_NE(refusal(R"({"type": "Polygon", "coordinates": []})").find("is a Polygon, which is no path"),
              std::string::npos);
    EXPECT_NE(refusal(R"({"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": null}]})")
                  .find("a.json: feature 1 has no 'geometry'"),
              std::string::npos);
    EXPECT_NE(refusal(R"({"type": "Point", "coordinates": [1]})").find("is not [longitude, latitude]"),
              std::string::npos);
    EXPECT_NE(refusal(R"({"type": "Point", "coordinates": [1.5, 143.5]})").find("latitude_deg = 143.5"),
              std::string::npos);
    EXPECT_NE(refusal(R"({"type": "LineString", "coordinates": []})").find("has no waypoints"), std::string::npos);
    EXPECT_NE(refusal(R"({"type": "FeatureCollection", "crs": {"name": "EPSG:2154"}, "features": []})")
                  .find("another reference than WGS84"),
              std::string::npos);
}

TEST(WaypointFiles, OfAutopilotsAreRecognisedByTheirContent) {
    const auto folder = test::scratch_dir();
    std::ofstream(folder / "a.txt") << "QGC WPL 110\n0 1 0 16 0 0 0 0 47 8 100 1\n1 0 3 16 0 0 0 0 47.01 8 60 1\n";
    EXPECT_EQ(read_waypoints(folder / "a.txt", {}).entries.size(), 2U) << "from home";
    std::ofstream(folder / "a.plan") << R"({"fileType": "Plan", "version": 3})";
    EXPECT_EQ(rejected([&] { read_waypoints(folder / "a.plan", {}); }, folder),
              "a.plan: the plan has version 3; expected version 1");
    std::ofstream(folder / "a.xml") << "<flight_plan/>";
    EXPECT_NE(rejected([&] { read_waypoints(folder / "a.xml", {}); }).find("flight_plan with blocks"),
              std::string::npos);
}

TEST(WaypointFiles, AreThePathOfKmlElseItsPoints) {
    const auto kml = [](const std::string& inner) {
        return parse_kml("<kml><Document>" + inner + "</Document></kml>", "a.kml");
    };
    const std::string point = "<Placemark><Point><coordinates>9,48,0</coordinates></Point></Placemark>";
    const auto line = [](const char* coordinates) {
        return fmt::format("<LineString><coordinates>{}</coordinates></LineString>", coordinates);
    };
    const auto plan = kml(point + line("8.0,47.0,0 \n8.1,47.1 8.2,47.2,0"));
    ASSERT_EQ(plan.entries.size(), 3U);
    EXPECT_EQ(plan.entries[1].geographic->latitude_deg, 47.1);
    EXPECT_EQ(plan.entries[1].geographic->longitude_deg, 8.1);
    EXPECT_FALSE(plan.entries[1].altitude_m);
    EXPECT_EQ(plan.not_flown, std::vector<std::string>{"its points are not flown to: it has a path"});
    EXPECT_EQ(kml(point + point).entries.size(), 2U);
    EXPECT_EQ(rejected([&] { kml(line("8,97")); }),
              "a.kml: a place '8,97'; expected longitude,latitude in degrees and, if at all, an altitude in metres");
    EXPECT_NE(rejected([&] { kml(""); }).find("a.kml: has no waypoints; expected KML with a path"), std::string::npos);
    EXPECT_NE(rejected([&] { parse_kml("<kml>", "a.kml"); }).find("a.kml: is not XML"), std::string::npos);
}

/// Altitudes of KML were not flown: a climb of 900 m cost nothing.
TEST(WaypointFiles, OfKmlAreNotThePointsBesideATrack) {
    const auto kml = [](const std::string& inner) { return parse_kml("<kml>" + inner + "</kml>", "a.kml"); };
    const std::string points =
        "<Point><coordinates>8,47</coordinates></Point><Point><coordinates>8.1,47</coordinates></Point>";
    const std::string line = "<LineString><coordinates>8,47 8.1,47</coordinates></LineString>";
    for (const std::string track : {"<gx:Track><gx:coord>8 47 100</gx:coord><gx:coord>8.2 47 100</gx:coord></gx:Track>",
                                    "<LinearRing><coordinates>8,47 8.1,47 8,47</coordinates></LinearRing>"}) {
        EXPECT_EQ(
            rejected([&] { kml(points + track); }),
            "a.kml: has tracks or rings (gx:Track, LinearRing), and no path (LineString); save the way that is to "
            "be flown as a path");
        EXPECT_EQ(kml(line + track).missing,
                  std::vector<std::string>{"its tracks and rings (gx:Track, LinearRing) are not flown: it has a path"});
    }
    EXPECT_TRUE(kml(line + "<Polygon><outerBoundaryIs><LinearRing/></outerBoundaryIs></Polygon>").missing.empty());
}

TEST(WaypointFiles, OfKmlHaveTheAltitudesOfItsMode) {
    const auto kml = [](const std::string& mode, const char* coordinates) {
        return parse_kml(fmt::format("<kml><LineString><altitudeMode>{}</altitudeMode><coordinates>{}</coordinates>"
                                     "</LineString></kml>",
                                     mode, coordinates),
                         "a.kml");
    };
    const auto rises = "8,47,430 8.1,47,1330 8.2,47";
    const auto above_sea = kml("absolute", rises);
    EXPECT_EQ(above_sea.entries[1].altitude_m, 1330.0);
    EXPECT_FALSE(above_sea.entries[2].altitude_m);
    EXPECT_FALSE(above_sea.is_above_home);
    EXPECT_TRUE(above_sea.is_above_sea);
    EXPECT_TRUE(above_sea.missing.empty());
    const auto above_ground = kml("relativeToGround", rises);
    EXPECT_EQ(above_ground.entries[1].altitude_m, 1330.0);
    EXPECT_TRUE(above_ground.is_above_home);
    EXPECT_FALSE(above_ground.is_above_sea);
    const std::vector<std::string> ground{"altitudes above the ground are flown as above that of its start"};
    EXPECT_EQ(above_ground.missing, ground);
    const std::vector<std::string> clamped{"altitudes that its altitudeMode clamps to the ground are not flown"};
    for (const auto* mode : {"clampToGround", ""}) {
        EXPECT_EQ(kml(mode, rises).missing, clamped) << mode;
        EXPECT_FALSE(kml(mode, rises).entries[1].altitude_m);
        const auto level = kml(mode, "8,47,30 8.1,47.1,30");
        EXPECT_EQ(level.not_flown, clamped);
        EXPECT_TRUE(level.missing.empty());
        EXPECT_TRUE(kml(mode, "8,47,0 8.1,47.1").not_flown.empty());
    }
    EXPECT_NE(rejected([&] { kml("absolute", "8,47,2e9"); }).find("altitude_m"), std::string::npos);
    EXPECT_NE(rejected([&] {
                  parse_kml(
                      "<kml><Point><altitudeMode>absolute</altitudeMode><coordinates>8,47,9</coordinates></Point>"
                      "<Point><altitudeMode>relativeToGround</altitudeMode><coordinates>8,47,9</coordinates>"
                      "</Point></kml>",
                      "a.kml");
              }).find("give one altitudeMode"),
              std::string::npos);
}

TEST(WaypointFiles, OfKmlWaitForTheirAltitudesIfARotorcraftFliesThem) {
    const auto waits = [](bool is_rotorcraft) {
        return parse_kml("<kml><LineString><coordinates>8,47,0 8.1,47,0</coordinates></LineString></kml>", "a.kml",
                         {.radius_m = {}, .is_rotorcraft = is_rotorcraft})
            .entries.back()
            .waits_for_altitude;
    };
    EXPECT_TRUE(waits(true));
    EXPECT_FALSE(waits(false));
}

/// Such a plan with tiles of the terrain was refused.
TEST(WaypointFiles, OfKmlFollowTheTerrain) {
    const auto folder = std::filesystem::path(testing::TempDir()) / "kml-terrain";
    std::filesystem::create_directories(folder);
    constexpr int rows = 121;
    std::string bytes;  // 1 m of height each 30 seconds of arc to the east
    for (int i = 0; i < rows * rows; ++i) bytes += {'\0', static_cast<char>(i % rows)};
    write_file_atomically(folder / "N47E008.hgt", bytes);
    const auto kml = [&](const char* mode) {
        return parse_kml(fmt::format("<kml><LineString><altitudeMode>{}</altitudeMode><coordinates>8.25,47.5,50 "
                                     "8.5,47.5,60</coordinates></LineString></kml>",
                                     mode),
                         "a.kml", {.radius_m = {}, .terrain = folder});
    };
    const auto plan = kml("relativeToGround");
    EXPECT_EQ(plan.entries.front().altitude_m, std::optional(50.0));
    EXPECT_NEAR(*plan.entries.back().altitude_m, 90.0, 1e-6);
    EXPECT_TRUE(plan.missing.empty());
    EXPECT_EQ(rejected([&] { kml("absolute"); }),
              "a.kml: has no altitudes above the terrain; leave terrain (--terrain) out");
}

constexpr std::string_view flight_plan = R"(<!DOCTYPE flight_plan SYSTEM "flight_plan.dtd">
<flight_plan alt="260" ground_alt="185" lat0="43.46223" lon0="1.27289" name="test">
  <waypoints>
    <waypoint name="HOME" x="0" y="0"/>
    <waypoint name="1" x="100.5" y="-20" height="50"/>
    <waypoint name="2" lat="43.46323" lon="1.27289" alt="300"/>
    <waypoint name="bad" x="a" y="0"/>
  </waypoints>
  <blocks/>
</flight_plan>
)";

TEST(WaypointFiles, AreFlightPlansWithNamesInOrder) {
    const auto entries = parse_flight_plan(flight_plan, "p.xml", {"1", "2", "HOME"});
    ASSERT_EQ(entries.size(), 3U);
    EXPECT_DOUBLE_EQ(entries[0].place->east_m, 100.5);
    EXPECT_EQ(entries[0].altitude_m, std::optional(235.0));
    EXPECT_NEAR(entries[1].place->north_m, 111.1, 0.05);
    EXPECT_EQ(entries[1].altitude_m, std::optional(300.0));
    EXPECT_EQ(entries[2].altitude_m, std::optional(260.0));
    EXPECT_EQ(entries[2].where.line, 4U);
    const auto refusal = [](std::string_view text, const std::string& name) {
        return rejected([&] { parse_flight_plan(text, "p.xml", {name}); });
    };
    EXPECT_EQ(refusal(flight_plan, "3"), "p.xml: there is no waypoint '3'; the plan has HOME, 1, 2, bad");
    EXPECT_EQ(refusal(flight_plan, "bad"), "p.xml:7: x of <waypoint> is no number: 'a'; expected metres");
    EXPECT_NE(refusal("<flight_plan>", "1").find("p.xml:1: is not XML"), std::string::npos);
    EXPECT_NE(refusal("<plan/>", "1").find("has no <flight_plan>"), std::string::npos);
}

}  // namespace
}  // namespace flightwatt::path
