#include "path/plan_fence.h"

#include "path/path_entries.h"
#include "path/plans/fence.h"

#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

/// Notes of a path from latitude 47, longitude 8 to these places.
std::vector<std::string> notes_of(const char* fence, const std::vector<PathEntry>& entries, bool returns = false) {
    PathDefaults defaults;
    defaults.airspeed_m_per_s = 10.0;
    defaults.geographic_start = {47.0, 8.0};
    defaults.return_to_start = returns;
    return fence_notes(read_fence(Json{{"geoFence", Json::parse(fence)}}), build_path(entries, defaults),
                       *path_origin(entries, defaults));
}

PathEntry entry_to(double latitude_deg, double longitude_deg, const char* name = "item 2") {
    PathEntry entry;
    entry.geographic = {latitude_deg, longitude_deg};
    entry.name = name;
    return entry;
}

/// Notes of a way of some 760 m to the east.
std::vector<std::string> notes_with(const char* fence) { return notes_of(fence, {entry_to(47.0, 8.01)}); }

using Notes = std::vector<std::string>;
const Notes crossed{"item 2: the way crosses an excluded fence"};
const Notes outside{"item 2: the way is not within the fence"};

TEST(Fences, AreCrossedWhereTheyExclude) {
    EXPECT_EQ(notes_with(R"({"polygons": [{"inclusion": false,
        "polygon": [[46.999, 8.004], [47.001, 8.004], [47.001, 8.006], [46.999, 8.006]]}]})"),
              crossed);
    EXPECT_EQ(
        notes_with(R"({"circles": [{"inclusion": false, "circle": {"center": [47.0005, 8.005], "radius": 60}}]})"),
        crossed);
    EXPECT_EQ(
        notes_with(R"({"circles": [{"inclusion": false, "circle": {"center": [47.0005, 8.005], "radius": 50}}]})"),
        Notes{});
}

TEST(Fences, AreLeftWhereTheyInclude) {
    EXPECT_EQ(notes_with(R"({"circles": [{"inclusion": true, "circle": {"center": [47, 8], "radius": 700}}]})"),
              outside);
    EXPECT_EQ(notes_with(R"({"circles": [{"inclusion": true, "circle": {"center": [47, 8], "radius": 800}}]})"),
              Notes{});
}

TEST(Fences, AreCrossedByTheReturnToTheStart) {
    const auto* zone = R"({"circles": [{"inclusion": false, "circle": {"center": [47.005, 8.005], "radius": 60}}]})";
    const std::vector<PathEntry> corner{entry_to(47.01, 8.0, "item 2"), entry_to(47.01, 8.01, "item 3")};
    EXPECT_EQ(notes_of(zone, corner), Notes{});
    EXPECT_EQ(notes_of(zone, corner, true), Notes{"return to start: the way crosses an excluded fence"});
}

TEST(Fences, AreCrossedAndLeftByCircles) {
    auto circles = entry_to(47.005, 8.0);
    circles.circles = 5.0;
    circles.radius_m = 300.0;
    EXPECT_EQ(notes_of(R"({"circles": [{"inclusion": false, "circle": {"center": [47.005, 8.004], "radius": 40}}]})",
                       {circles}),
              crossed);
    EXPECT_EQ(notes_of(R"({"circles": [{"inclusion": false, "circle": {"center": [47.005, 8.0], "radius": 200}}]})",
                       {circles}),
              Notes{})
        << "within them";
    EXPECT_EQ(notes_of(R"({"circles": [{"inclusion": true, "circle": {"center": [47.003, 8.0], "radius": 500}}]})",
                       {circles}),
              outside);
    EXPECT_EQ(notes_of(R"({"circles": [{"inclusion": true, "circle": {"center": [47.003, 8.0], "radius": 700}}]})",
                       {circles}),
              Notes{});
}

TEST(Fences, ThatAreNotUnderstoodAreNamed) {
    EXPECT_EQ(notes_with(R"({"polygons": [{"inclusion": false, "polygon": 3}]})").size(), 1U);
    EXPECT_EQ(notes_with(R"({"circles": [{}]})").size(), 1U);
    EXPECT_EQ(notes_with(R"({"version": 2, "circles": [], "polygons": []})"), Notes{});
}

}  // namespace
}  // namespace flightwatt::path
