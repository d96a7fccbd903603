#include "path/area.h"

#include "helpers/rejected.h"
#include "path/plan_files.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

using test::rejected;

/// About 400 m x 400 m.
constexpr const char* ring = "[[8.0,47.0],[8.00526,47.0],[8.00526,47.0036],[8.0,47.0036],[8.0,47.0]]";

std::string geojson(const std::string& rings) {
    return fmt::format(
        R"({{"type":"FeatureCollection","features":[{{"type":"Feature","geometry":{{"type":"Polygon","coordinates":[{}]}}}}]}})",
        rings);
}

double length_m(const PlanEntries& survey) {
    PathDefaults defaults;
    defaults.starts_at_first_place = survey.starts_at_first_place;
    const auto path = build_path(survey.entries, defaults);
    double length_m = length_of_legs_m(path);
    for (const auto& element : path.elements)
        if (const auto* turn = std::get_if<Circles>(&element.shape))
            length_m += 2.0 * std::numbers::pi * turn->radius_m * turn->turns;
    return length_m;
}

TEST(Areas, NameTheWidthThatNoLineCovers) {
    EXPECT_TRUE(parse_area(geojson(ring), "a.geojson", {0.0, {{50.0}}}).not_flown.empty());
    const auto wide = parse_area(geojson(ring), "a.geojson", {0.0, {{270.0}}});
    ASSERT_EQ(wide.not_flown.size(), 1U);
    EXPECT_EQ(
        wide.not_flown.front(),
        "130 of the area's 400 m of width are farther than half a spacing from a line: another spacing fits better");
}

TEST(Areas, NameAltitudesOfTheirPolygonsThatAreNotFlown) {
    const std::vector<std::string> corners{"8,47", "8.00526,47", "8.00526,47.0036", "8,47"};
    const auto notes = [&](const char* altitude, const std::string& properties, bool is_kml) {
        std::string places;
        for (const auto& corner : corners)
            places += is_kml ? fmt::format("{}{} ", corner, altitude)
                             : fmt::format("{}[{}{}]", places.empty() ? "" : ",", corner, altitude);
        const auto text =
            is_kml ? fmt::format(
                         "<kml><Polygon>{}<outerBoundaryIs><LinearRing><coordinates>{}</coordinates></LinearRing>"
                         "</outerBoundaryIs></Polygon></kml>",
                         properties, places)
                   : fmt::format(R"({{"type":"Feature","properties":{{{}}},"geometry":{{"type":"Polygon",)"
                                 R"("coordinates":[[{}]]}}}})",
                                 properties, places);
        return parse_area(text, "a", {0.0, {{50.0}}}).not_flown;
    };
    const std::vector<std::string> noted{
        "the altitudes of its polygons are not flown: altitude_m in [path] states that of the lines, ground_altitude_m "
        "that of home"};
    EXPECT_EQ(notes(",300", "", false), noted);
    EXPECT_EQ(notes("", R"("altitude_m":300)", false), noted);
    EXPECT_EQ(notes(",300", "<altitudeMode>relativeToGround</altitudeMode>", true), noted);
    EXPECT_EQ(notes(",300", "<altitudeMode>absolute</altitudeMode>", true), noted);
    EXPECT_TRUE(notes(",300", "", true).empty());  // clamped to the ground
    EXPECT_TRUE(notes(",0", "", false).empty());
    EXPECT_TRUE(notes("", "", false).empty());
}

TEST(Areas, AreCoveredByLines) {
    const auto area = parse_area(geojson(ring), "a.geojson", {0.0, {{50.0}}});
    EXPECT_NEAR(length_m(area), 8.0 * 400.0 + 7.0 * 78.54, 15.0);
    EXPECT_NEAR(length_m(parse_area(geojson(ring), "a.geojson", {90.0, {{50.0}}})), length_m(area), 15.0);
    EXPECT_TRUE(area.not_flown.empty());
    const auto kml = R"(<kml><Placemark><Polygon><outerBoundaryIs><LinearRing><coordinates>
8.0,47.0,0 8.00526,47.0,0 8.00526,47.0036,0 8.0,47.0036,0 8.0,47.0,0
</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></kml>)";
    EXPECT_NEAR(length_m(parse_area(kml, "a.kml", {0.0, {{50.0}}})), length_m(area), 1e-6);
}

TEST(Areas, HaveHolesAndZonesThatAreNotFlownOver) {
    constexpr auto hole = "[[8.0015,47.001],[8.0035,47.001],[8.0035,47.0025],[8.0015,47.0025],[8.0015,47.001]]";
    const double with_hole_m = length_m(parse_area(geojson(fmt::format("{},{}", ring, hole)), "a", {0.0, {{20.0}}}));
    EXPECT_LT(with_hole_m, length_m(parse_area(geojson(ring), "a", {0.0, {{20.0}}})) - 500.0);
    const auto features = fmt::format(
        R"({{"type":"FeatureCollection","features":[
{{"type":"Feature","geometry":{{"type":"MultiPolygon","coordinates":[[{}]]}},"properties":{{"name":"field"}}}},
{{"type":"Feature","geometry":{{"type":"Polygon","coordinates":[{}]}},"properties":{{"no_fly":true}}}}]}})",
        ring, hole);
    EXPECT_NEAR(length_m(parse_area(features, "a", {0.0, {{20.0}}})), with_hole_m, 1e-6);
    const auto outline = [](const char* places) {
        return fmt::format("<LinearRing><coordinates>{}</coordinates></LinearRing>", places);
    };
    const auto field = outline("8.0,47.0 8.00526,47.0 8.00526,47.0036 8.0,47.0036 8.0,47.0");
    const auto house = outline("8.0015,47.001 8.0035,47.001 8.0035,47.0025 8.0015,47.0025 8.0015,47.001");
    EXPECT_NEAR(length_m(parse_area(fmt::format("<kml><Placemark><Polygon><outerBoundaryIs>{}</outerBoundaryIs>"
                                                "<innerBoundaryIs>{}</innerBoundaryIs></Polygon></Placemark></kml>",
                                                field, house),
                                    "a.kml", {0.0, {{20.0}}})),
                with_hole_m, 1e-6);
    EXPECT_NEAR(
        length_m(parse_area(fmt::format("<kml><Placemark><Polygon><outerBoundaryIs>{}</outerBoundaryIs></Polygon>"
                                        "</Placemark><Placemark><name>No-fly: school</name><Polygon>"
                                        "<outerBoundaryIs>{}</outerBoundaryIs></Polygon></Placemark></kml>",
                                        field, house),
                            "a.kml", {0.0, {{20.0}}})),
        with_hole_m, 1e-6);
}

/// Strips are of the width in the order of flight; a strip cut at the end of a line has the same lines.
/// Zones in a folder of that name were covered by lines, a second time, without a word.
TEST(Areas, OfFoldersNamedNoFlyAreZones) {
    const auto polygon = [](const char* name, const char* places) {
        return fmt::format(
            "<Placemark><name>{}</name><Polygon><outerBoundaryIs><LinearRing><coordinates>{}</coordinates>"
            "</LinearRing></outerBoundaryIs></Polygon></Placemark>",
            name, places);
    };
    const auto field = polygon("Volcano flyover", "8.0,47.0 8.00526,47.0 8.00526,47.0036 8.0,47.0036 8.0,47.0");
    const auto house = polygon("School", "8.0015,47.001 8.0035,47.001 8.0035,47.0025 8.0015,47.0025 8.0015,47.001");
    const auto read = [](const std::string& inner) {
        return parse_area("<kml>" + inner + "</kml>", "a", {0.0, {{20.0}}});
    };
    const auto zone = read(field + "<Folder><name>No-fly zones</name>" + house + "</Folder>");
    EXPECT_TRUE(zone.has_zones);
    EXPECT_TRUE(std::ranges::none_of(zone.not_flown, [](const auto& text) { return text.starts_with("polygons"); }));
    EXPECT_FALSE(read("<Folder><name>With no-fly zones</name>" + field + "</Folder>").has_zones);
    const auto both = read(field + house);
    EXPECT_FALSE(both.has_zones);
    EXPECT_EQ(both.not_flown, std::vector<std::string>{
                                  "polygons 1 and 2 overlap and both are flown: one that is not to be flown over needs "
                                  "\"no_fly\": true (GeoJSON) or \"no-fly\" in its name (KML)"});
}

/// Only the way back to the first corner was considered, wherever the flight starts.
TEST(Areas, AreReachedAroundZonesFromWhereTheFlightStarts) {
    constexpr auto wall = "[[7.996,46.999],[7.998,46.999],[7.998,47.005],[7.996,47.005],[7.996,46.999]]";
    const auto with_zone = [](const char* zone) {
        return fmt::format(
            R"({{"type":"FeatureCollection","features":[
{{"type":"Feature","geometry":{{"type":"Polygon","coordinates":[{}]}},"properties":{{}}}},
{{"type":"Feature","geometry":{{"type":"Polygon","coordinates":[{}]}},"properties":{{"no_fly":true}}}}]}})",
            ring, zone);
    };
    const GeodeticPosition home{47.002, 7.99};
    const auto behind = parse_area(with_zone(wall), "a", {0.0, {{20.0}}}, home);
    EXPECT_EQ(behind.not_flown, std::vector<std::string>{
                                    "the straight way back to the start crosses a zone that is not to be flown over"});
    EXPECT_LT(behind.entries.front().geographic->latitude_deg, 46.999) << "around the zone";
    EXPECT_TRUE(parse_area(with_zone(wall), "a", {0.0, {{20.0}}}).not_flown.empty());
    EXPECT_TRUE(behind.has_zones);
    // A zone over the first corner was refused as one that encloses a part of the area.
    constexpr auto corner = "[[7.999,46.999],[8.001,46.999],[8.001,47.001],[7.999,47.001],[7.999,46.999]]";
    EXPECT_EQ(parse_area(with_zone(corner), "a", {0.0, {{20.0}}}).line_to.size(), 20U);
    const auto inside = parse_area(with_zone(corner), "a", {0.0, {{20.0}}}, GeodeticPosition{47.0, 8.0});
    EXPECT_EQ(inside.not_flown.size(), 2U) << "the ways there and back";
}

TEST(Areas, AreCoveredByStrips) {
    for (const double heading_deg : {0.0, 180.0, 90.0}) {
        const auto whole = parse_area(geojson(ring), "a", {heading_deg, {{50.0}}});
        ASSERT_EQ(whole.line_to.size(), 8U) << heading_deg;
        EXPECT_EQ(whole.line_to.back(), 1.0);
        EXPECT_NEAR(whole.strips.front().area_m2, 400.0 * 400.0, 800.0);
        EXPECT_NEAR(whole.strips.front().lines_m, 8.0 * 400.0, 10.0);
        const auto cut = parse_area(geojson(ring), "a", {heading_deg, {{50.0, whole.line_to[2]}, {100.0, 1.0, 14.0}}});
        ASSERT_EQ(cut.strips.size(), 2U);
        EXPECT_NEAR(cut.strips[0].lines_m, 3.0 * 400.0, 5.0);
        EXPECT_NEAR(cut.strips[1].area_m2, 5.0 / 8.0 * 400.0 * 400.0, 500.0);
        EXPECT_DOUBLE_EQ(cut.line_to[2], whole.line_to[2]);
        for (std::size_t i = 0; i < cut.entries.size(); ++i) {
            const auto line = cut.entries[i].survey_line;
            EXPECT_EQ(cut.entries[i].airspeed_m_per_s.has_value(), line > 3);
            if (line > 3 || !cut.entries[i].geographic) continue;
            EXPECT_NEAR(cut.entries[i].geographic->latitude_deg, whole.entries[i].geographic->latitude_deg, 1e-10);
            EXPECT_NEAR(cut.entries[i].geographic->longitude_deg, whole.entries[i].geographic->longitude_deg, 1e-10);
        }
    }
}

TEST(Areas, ThatAreDividedHaveOneSpacing) {
    constexpr auto hole = "[[8.0015,47.001],[8.0035,47.001],[8.0035,47.0025],[8.0015,47.0025],[8.0015,47.001]]";
    const auto text = geojson(fmt::format("{},{}", ring, hole));
    const auto area = parse_area(text, "a", {0.0, {{20.0}}});
    EXPECT_TRUE(area.is_divided);
    EXPECT_FALSE(parse_area(geojson(ring), "a", {0.0, {{20.0}}}).is_divided);
    EXPECT_EQ(area.line_to.back(), 1.0);
    EXPECT_NEAR(area.strips.front().area_m2, 400.0 * 400.0 - 152.0 * 167.0, 800.0);
    EXPECT_NE(rejected([&] {
                  parse_area(text, "a", {0.0, {{20.0, 0.5}, {40.0}}});
              }).find("of several spacings"),
              std::string::npos);
}

TEST(Areas, ArePolygons) {
    const auto refusal = [](const std::string& text, double spacing_m = 50.0) {
        return rejected([&] { parse_area(text, "a", {0.0, {{spacing_m}}}); });
    };
    EXPECT_EQ(refusal(R"({"type":"Point","coordinates":[1,2]})"),
              "a: is a Point, which is no area; expected GeoJSON: Polygons, alone, as features or in a "
              "FeatureCollection");
    EXPECT_EQ(refusal(geojson("")).substr(0, 32), "a: feature 1 has no outer ring; ");
    EXPECT_EQ(refusal(geojson("[[8,47],[8.1,47]]")).substr(0, 29), "a: a polygon has 2 corners; e");
    EXPECT_EQ(refusal("<kml/>"), "a: has no polygon to fly over; expected polygons, in GeoJSON or KML");
    EXPECT_EQ(refusal("<kml><Polygon><outerBoundaryIs><LinearRing><coordinates>8,x</coordinates></LinearRing>"
                      "</outerBoundaryIs></Polygon></kml>"),
              "a: a place '8,x'; expected longitude,latitude in degrees and, if at all, an altitude in metres");
    std::string corners;
    for (int i = 0; i < 301; ++i) corners += fmt::format("{}[8.002{:03},47.001]", i == 0 ? "" : ",", i);
    EXPECT_NE(
        refusal(geojson(fmt::format("{},[{}]", ring, corners))).find("have 301 corners; draw them with at most 300"),
        std::string::npos);
    EXPECT_NE(refusal(geojson(ring), 5000.0).find("no lines 5000 m apart"), std::string::npos);
    EXPECT_NE(refusal(geojson(ring), 1e-9).find("or more than 5000"), std::string::npos);
}

}  // namespace
}  // namespace flightwatt::path
