#pragma once

#include "path/path_entries.h"

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace flightwatt::path {

/// Heights of the ground above the sea, from a folder of tiles of SRTM: N47E008.hgt holds those of the degree from 47 N
/// and 8 E on, in rows from the north, as 16-bit numbers in metres whose high byte is first.
class Terrain {
  public:
    explicit Terrain(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Returns the height [m], linear between the four heights around the place. Throws InputError where the tile is
    /// missing, is no square, or has no height there.
    double ground_m(const GeodeticPosition& place);

  private:
    /// A tile, which has as many columns as rows.
    struct Tile {
        std::filesystem::path file;
        std::string heights;
        std::size_t rows = 0;
    };

    const Tile& tile_at(int latitude_deg, int longitude_deg);

    std::filesystem::path folder_;
    std::map<std::string, Tile> tiles_;  ///< read so far, by name
};

/// A path over terrain.
struct TerrainPath {
    std::vector<PathEntry> entries;
    std::vector<std::string> below_ground;  ///< "item 5: the way there leads 12 m below the ground"
};

/// Returns the entries, whose altitudes are above home, with further ones on each way that keeps its height above the
/// terrain: where the ground differs by more than 10 m from a straight line, which is the error of SRTM over such
/// distances. With `returns_home` a straight way home to the first altitude, which is no entry, follows the last one.
/// Throws as Terrain::ground_m().
TerrainPath along_terrain(const std::vector<PathEntry>& entries, Terrain& terrain, const GeodeticPosition& home,
                          bool returns_home);

}  // namespace flightwatt::path
