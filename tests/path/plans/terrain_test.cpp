#include "path/plans/terrain.h"

#include "base/atomic_file.h"
#include "helpers/rejected.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

using test::rejected;

constexpr std::size_t rows = 121;  // 30 seconds of arc apart

/// A folder with a tile from 47 N, 8 E on, of the height of each place in it.
template <typename Height>
std::filesystem::path folder_of(const std::string& name, Height height_m, const char* tile = "N47E008.hgt") {
    auto folder = std::filesystem::path(testing::TempDir()) / name;
    std::filesystem::create_directories(folder);
    std::string bytes;
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t column = 0; column < rows; ++column) {
            const auto metres = static_cast<std::int16_t>(
                std::lround(height_m(1.0 - static_cast<double>(row) / 120.0, static_cast<double>(column) / 120.0)));
            bytes += {static_cast<char>(metres >> 8), static_cast<char>(metres & 0xFF)};
        }
    write_file_atomically(folder / tile, bytes);
    return folder;
}

double slope_m(double north_deg, double east_deg) { return 1200.0 * north_deg + 240.0 * east_deg - 100.0; }

PathEntry entry(double latitude_deg, double longitude_deg, double altitude_m, bool is_above_terrain) {
    PathEntry entry;
    entry.name = fmt::format("item {}", latitude_deg);
    entry.geographic = GeodeticPosition{latitude_deg, longitude_deg};
    entry.altitude_m = altitude_m;
    entry.is_above_terrain = is_above_terrain;
    return entry;
}

TEST(Terrain, IsLinearBetweenTheHeightsOfATile) {
    Terrain terrain(folder_of("slope", slope_m));
    EXPECT_DOUBLE_EQ(terrain.ground_m({47.0, 8.0}), -100.0);
    EXPECT_NEAR(terrain.ground_m({47.53, 8.21}), slope_m(0.53, 0.21), 1e-9);
    EXPECT_NEAR(terrain.ground_m({47.999, 8.999}), slope_m(0.999, 0.999), 1e-9);
    Terrain south(folder_of("south", slope_m, "S34W071.hgt"));
    EXPECT_NEAR(south.ground_m({-33.75, -70.5}), slope_m(0.25, 0.5), 1e-9);
}

TEST(Terrain, NamesTheTileThatIsMissingCutOrVoid) {
    const auto folder = folder_of("void", [](double, double) { return INT16_MIN; });
    Terrain terrain(folder);
    EXPECT_EQ(rejected([&] {
                  terrain.ground_m({48.5, 8.5});
              }),
              fmt::format("{}: has no tile N48E008.hgt of the terrain under the plan; expected tiles of SRTM with a "
                          "height each 1 or 3 seconds of arc",
                          folder.string()));
    EXPECT_EQ(
        rejected(
            [&] {
                terrain.ground_m({47.5, 8.25});
            },
            folder),
        "N47E008.hgt: has no height near latitude 47.5000, longitude 8.2500; expected a tile whose voids are filled");
    write_file_atomically(folder / "N47E008.hgt", std::string(std::size_t{2} * 121 * 120, '\0'));
    Terrain cut(folder);
    EXPECT_EQ(rejected(
                  [&] {
                      cut.ground_m({47.5, 8.25});
                  },
                  folder),
              "N47E008.hgt: has 29040 bytes, which is no tile; expected 2 bytes for each of 1201 x 1201 or 3601 x 3601 "
              "heights: is it cut, or packed?");
}

/// A hill 200 m high, 0.05 degrees around latitude 47.5.
double hill_m(double north_deg, double) { return 200.0 * std::max(0.0, 1.0 - std::abs(north_deg - 0.5) / 0.05); }

TEST(Terrain, IsFollowedBetweenPlacesAboveIt) {
    Terrain terrain(folder_of("hill", hill_m));
    const auto path =
        along_terrain({entry(47.4, 8.5, 60.0, true), entry(47.6, 8.5, 60.0, true)}, terrain, {47.4, 8.5}, false);
    ASSERT_EQ(path.entries.size(), 5U);  // the foot, the top, the foot
    const double foot_m = path.entries[1].altitude_m.value();
    EXPECT_NEAR(foot_m, 60.0, 10.0);
    EXPECT_NEAR(path.entries[2].altitude_m.value(), 260.0, 1.5);
    EXPECT_NEAR(path.entries[2].geographic->latitude_deg, 47.5, 1e-3);
    EXPECT_EQ(path.entries[2].name, "item 47.6, over the terrain");
    EXPECT_TRUE(path.below_ground.empty());
}

TEST(Terrain, IsNamedWhereThePlanLeadsBelowIt) {
    Terrain terrain(folder_of("hill", hill_m));
    const auto path =
        along_terrain({entry(47.4, 8.5, 60.0, false), entry(47.6, 8.5, 60.0, false)}, terrain, {47.4, 8.5}, false);
    ASSERT_EQ(path.entries.size(), 2U);
    ASSERT_EQ(path.below_ground.size(), 1U);
    EXPECT_EQ(path.below_ground.front(), "item 47.6: the way there leads 140 m below the ground");
}

/// The way back that is added to a plan led through a hill without a word.
TEST(Terrain, IsNamedWhereTheReturnLeadsBelowIt) {
    Terrain terrain(folder_of("hill", hill_m));
    const std::vector<PathEntry> over{entry(47.4, 8.5, 60.0, true), entry(47.6, 8.5, 60.0, true)};
    EXPECT_EQ(along_terrain(over, terrain, {47.4, 8.5}, true).below_ground,
              std::vector<std::string>{"return to start: the way there leads 140 m below the ground"});
    EXPECT_TRUE(along_terrain(over, terrain, {47.7, 8.5}, true).below_ground.empty());
}

/// Tiles were asked for that are named E180.
TEST(Terrain, ContinuesBeyondTheDateLine) {
    Terrain terrain(folder_of("date_line", slope_m, "N10W180.hgt"));
    EXPECT_NEAR(terrain.ground_m({10.5, 180.0}), slope_m(0.5, 0.0), 1e-9);
    EXPECT_NEAR(terrain.ground_m({10.5, 180.25}), slope_m(0.5, 0.25), 1e-9);
    EXPECT_NEAR(terrain.ground_m({10.5, -180.0}), slope_m(0.5, 0.0), 1e-9);
}

}  // namespace
}  // namespace flightwatt::path
