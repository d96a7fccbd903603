#include "path/plans/fence.h"

#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

/// Notes of a way of some 760 m to the east.
std::vector<std::string> notes_with(const char* fence) {
    std::vector<PathEntry> entries(2);
    entries[0].geographic = {47.0, 8.0};
    entries[1].geographic = {47.0, 8.01};
    entries[1].name = "item 2";
    return fence_notes(Json{{"geoFence", Json::parse(fence)}}, entries);
}

using Notes = std::vector<std::string>;
const Notes crossed{"item 2: the way there crosses an excluded fence"};
const Notes outside{"item 2: the way there is not within the fence"};

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

TEST(Fences, ThatAreNotUnderstoodAreNamed) {
    EXPECT_EQ(notes_with(R"({"polygons": [{"inclusion": false, "polygon": 3}]})").size(), 1U);
    EXPECT_EQ(notes_with(R"({"circles": [{}]})").size(), 1U);
    EXPECT_EQ(notes_with(R"({"version": 2, "circles": [], "polygons": []})"), Notes{});
}

}  // namespace
}  // namespace flightwatt::path
