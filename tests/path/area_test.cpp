#include "path/area.h"

#include "helpers/rejected.h"
#include "path/plan_files.h"

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

TEST(Areas, AreCoveredByLines) {
    const auto area = parse_area(geojson(ring), "a.geojson", 50.0, 0.0);
    EXPECT_NEAR(length_m(area), 8.0 * 400.0 + 7.0 * 78.54, 15.0);
    EXPECT_NEAR(length_m(parse_area(geojson(ring), "a.geojson", 50.0, 90.0)), length_m(area), 15.0);
    EXPECT_TRUE(area.not_flown.empty());
    const auto kml = R"(<kml><Placemark><Polygon><outerBoundaryIs><LinearRing><coordinates>
8.0,47.0,0 8.00526,47.0,0 8.00526,47.0036,0 8.0,47.0036,0 8.0,47.0,0
</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></kml>)";
    EXPECT_NEAR(length_m(parse_area(kml, "a.kml", 50.0, 0.0)), length_m(area), 1e-6);
}

TEST(Areas, HaveHolesAndZonesThatAreNotFlownOver) {
    constexpr auto hole = "[[8.0015,47.001],[8.0035,47.001],[8.0035,47.0025],[8.0015,47.0025],[8.0015,47.001]]";
    const double with_hole_m = length_m(parse_area(geojson(fmt::format("{},{}", ring, hole)), "a", 20.0, 0.0));
    EXPECT_LT(with_hole_m, length_m(parse_area(geojson(ring), "a", 20.0, 0.0)) - 500.0);
    const auto features = fmt::format(
        R"({{"type":"FeatureCollection","features":[
{{"type":"Feature","geometry":{{"type":"MultiPolygon","coordinates":[[{}]]}},"properties":{{"name":"field"}}}},
{{"type":"Feature","geometry":{{"type":"Polygon","coordinates":[{}]}},"properties":{{"no_fly":true}}}}]}})",
        ring, hole);
    EXPECT_NEAR(length_m(parse_area(features, "a", 20.0, 0.0)), with_hole_m, 1e-6);
    const auto outline = [](const char* places) {
        return fmt::format("<LinearRing><coordinates>{}</coordinates></LinearRing>", places);
    };
    const auto field = outline("8.0,47.0 8.00526,47.0 8.00526,47.0036 8.0,47.0036 8.0,47.0");
    const auto house = outline("8.0015,47.001 8.0035,47.001 8.0035,47.0025 8.0015,47.0025 8.0015,47.001");
    EXPECT_NEAR(length_m(parse_area(fmt::format("<kml><Placemark><Polygon><outerBoundaryIs>{}</outerBoundaryIs>"
                                                "<innerBoundaryIs>{}</innerBoundaryIs></Polygon></Placemark></kml>",
                                                field, house),
                                    "a.kml", 20.0, 0.0)),
                with_hole_m, 1e-6);
    EXPECT_NEAR(
        length_m(parse_area(fmt::format("<kml><Placemark><Polygon><outerBoundaryIs>{}</outerBoundaryIs></Polygon>"
                                        "</Placemark><Placemark><name>No-fly: school</name><Polygon>"
                                        "<outerBoundaryIs>{}</outerBoundaryIs></Polygon></Placemark></kml>",
                                        field, house),
                            "a.kml", 20.0, 0.0)),
        with_hole_m, 1e-6);
}

TEST(Areas, ArePolygons) {
    const auto refusal = [](const std::string& text, double spacing_m = 50.0) {
        return rejected([&] { parse_area(text, "a", spacing_m, 0.0); });
    };
    EXPECT_EQ(refusal(R"({"type":"Point","coordinates":[1,2]})"),
              "a: is a Point, which is no area; expected GeoJSON: Polygons, alone, as features or in a "
              "FeatureCollection");
    EXPECT_EQ(refusal(geojson("")).substr(0, 32), "a: feature 1 has no outer ring; ");
    EXPECT_EQ(refusal(geojson("[[8,47],[8.1,47]]")).substr(0, 29), "a: a polygon has 2 corners; e");
    EXPECT_EQ(refusal("<kml/>"), "a: has no polygon to fly over; expected polygons, in GeoJSON or KML");
    EXPECT_EQ(refusal("<kml><Polygon><outerBoundaryIs><LinearRing><coordinates>8,x</coordinates></LinearRing>"
                      "</outerBoundaryIs></Polygon></kml>"),
              "a: a place '8,x'; expected longitude,latitude in degrees");
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
