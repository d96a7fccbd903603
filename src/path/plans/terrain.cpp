#include "path/plans/terrain.h"

#include "base/error.h"
#include "base/input_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

namespace flightwatt::path {
namespace {

constexpr double step_m = 30.0;       // between the heights of SRTM's finer tiles
constexpr double tolerance_m = 10.0;  // its relative error
constexpr std::size_t bytes_per_height = 2;

std::string tile_name(int latitude_deg, int longitude_deg) {
    return fmt::format("{}{:02}{}{:03}.hgt", latitude_deg < 0 ? 'S' : 'N', std::abs(latitude_deg),
                       longitude_deg < 0 ? 'W' : 'E', std::abs(longitude_deg));
}

/// From -180 on to less than 180 degrees, as tiles are named.
double east_of_date_line(double longitude_deg, double rounding_deg) {
    constexpr double circle_deg = 360.0;
    if (longitude_deg + rounding_deg >= 180.0) return longitude_deg - circle_deg;
    return longitude_deg + rounding_deg < -180.0 ? longitude_deg + circle_deg : longitude_deg;
}

/// A straight way between two entries, in places `step_m` apart.
struct Way {
    std::vector<GeodeticPosition> places;
    std::vector<double> ground_m;    ///< above that of home
    std::vector<double> altitude_m;  ///< above home
};

Way sampled_way(const GeodeticPosition& from, const GeodeticPosition& to, Terrain& terrain, double home_ground_m) {
    const auto end = to_local(to, from);
    const auto steps = static_cast<std::size_t>(std::max(1.0, std::ceil(std::hypot(end.east_m, end.north_m) / step_m)));
    Way way;
    for (std::size_t i = 0; i <= steps; ++i) {
        const double part = static_cast<double>(i) / static_cast<double>(steps);
        way.places.push_back(to_geodetic({part * end.east_m, part * end.north_m}, from));
        way.ground_m.push_back(terrain.ground_m(way.places.back()) - home_ground_m);
    }
    return way;
}

/// Sets the altitudes of a way: straight between those at its ends, or as high above the ground as they are.
void set_altitudes(Way& way, double from_m, double to_m, bool keeps_height) {
    const std::size_t last = way.places.size() - 1;
    if (keeps_height) {
        from_m -= way.ground_m.front();
        to_m -= way.ground_m.back();
    }
    for (std::size_t i = 0; i <= last; ++i) {
        const double straight_m = std::lerp(from_m, to_m, static_cast<double>(i) / static_cast<double>(last));
        way.altitude_m.push_back(straight_m + (keeps_height ? way.ground_m[i] : 0.0));
    }
}

/// Adds the places between two, in order, at which straight lines have to bend to keep to the altitudes (the way of
/// Ramer, Douglas and Peucker).
void add_bends(const std::vector<double>& altitude_m, std::size_t first, std::size_t last,
               std::vector<std::size_t>& bends) {
    double largest_m = tolerance_m;
    std::optional<std::size_t> bend;
    for (std::size_t i = first + 1; i < last; ++i) {
        const double part = static_cast<double>(i - first) / static_cast<double>(last - first);
        const double off_m = std::abs(altitude_m[i] - std::lerp(altitude_m[first], altitude_m[last], part));
        if (off_m <= largest_m) continue;
        largest_m = off_m;
        bend = i;
    }
    if (!bend) return;
    add_bends(altitude_m, first, *bend, bends);
    bends.push_back(*bend);
    add_bends(altitude_m, *bend, last, bends);
}

PathEntry bend_of(const PathEntry& entry, const Way& way, std::size_t i) {
    PathEntry bend;
    bend.name = entry.name + ", over the terrain";
    bend.where = entry.where;
    bend.airspeed_m_per_s = entry.airspeed_m_per_s;
    bend.rates = entry.rates;
    bend.geographic = way.places[i];
    bend.altitude_m = way.altitude_m[i];
    return bend;
}

std::optional<std::string> below_ground(const PathEntry& entry, const Way& way) {
    double lowest_m = 0.0;
    for (std::size_t i = 0; i < way.places.size(); ++i)
        lowest_m = std::min(lowest_m, way.altitude_m[i] - way.ground_m[i]);
    if (lowest_m > -0.5) return std::nullopt;
    return fmt::format("{}: the way there leads {:.0f} m below the ground", entry.name, -lowest_m);
}

}  // namespace

const Terrain::Tile& Terrain::tile_at(int latitude_deg, int longitude_deg) {
    const auto name = tile_name(latitude_deg, longitude_deg);
    if (const auto found = tiles_.find(name); found != tiles_.end()) return found->second;
    Tile tile{folder_ / name, "", 0};
    std::error_code none;
    if (!std::filesystem::exists(tile.file, none))
        throw InputError({folder_.string()}, fmt::format("has no tile {} of the terrain under the plan", name),
                         "expected tiles of SRTM with a height each 1 or 3 seconds of arc");
    tile.heights = read_file(tile.file);
    const std::size_t heights = tile.heights.size() / bytes_per_height;
    tile.rows = static_cast<std::size_t>(std::sqrt(static_cast<double>(heights)));
    if (tile.rows < 2 || tile.rows * tile.rows * bytes_per_height != tile.heights.size())
        throw InputError({tile.file.string()}, fmt::format("has {} bytes, which is no tile", tile.heights.size()),
                         "expected 2 bytes for each of 1201 x 1201 or 3601 x 3601 heights: is it cut, or packed?");
    return tiles_.emplace(name, std::move(tile)).first->second;
}

double Terrain::ground_m(const GeodeticPosition& place) {
    constexpr double rounding_deg = 1e-9;
    const double south_deg = std::floor(place.latitude_deg + rounding_deg);
    const double longitude_deg = east_of_date_line(place.longitude_deg, rounding_deg);
    const double west_deg = std::floor(longitude_deg + rounding_deg);
    const auto& tile = tile_at(static_cast<int>(south_deg), static_cast<int>(west_deg));
    const auto height_m = [&](std::size_t row, std::size_t column) {
        constexpr std::int16_t none = INT16_MIN;
        const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(tile.heights[at]); };
        const std::size_t at = bytes_per_height * (row * tile.rows + column);
        const auto metres = static_cast<std::int16_t>(byte(at) << 8U | byte(at + 1));
        if (metres == none)
            throw InputError({tile.file.string()},
                             fmt::format("has no height near latitude {:.4f}, longitude {:.4f}", place.latitude_deg,
                                         place.longitude_deg),
                             "expected a tile whose voids are filled");
        return static_cast<double>(metres);
    };
    const auto last = static_cast<double>(tile.rows - 1);
    const double row = std::max(0.0, south_deg + 1.0 - place.latitude_deg) * last;
    const double column = std::max(0.0, longitude_deg - west_deg) * last;
    const auto north = static_cast<std::size_t>(std::min(std::floor(row), last - 1.0));
    const auto west = static_cast<std::size_t>(std::min(std::floor(column), last - 1.0));
    const double to_south = row - static_cast<double>(north);
    const double to_east = column - static_cast<double>(west);
    return std::lerp(std::lerp(height_m(north, west), height_m(north, west + 1), to_east),
                     std::lerp(height_m(north + 1, west), height_m(north + 1, west + 1), to_east), to_south);
}

TerrainPath along_terrain(const std::vector<PathEntry>& entries, Terrain& terrain, const GeodeticPosition& home,
                          bool returns_home) {
    const double home_ground_m = terrain.ground_m(home);
    TerrainPath path;
    const PathEntry* from = nullptr;
    std::optional<double> from_m;
    for (const auto& entry : entries) {
        const auto to_m = entry.altitude_m ? entry.altitude_m : from_m;
        if (entry.geographic && from != nullptr && from_m) {
            auto way = sampled_way(*from->geographic, *entry.geographic, terrain, home_ground_m);
            const bool keeps_height = from->is_above_terrain && entry.is_above_terrain;
            set_altitudes(way, *from_m, *to_m, keeps_height);
            std::vector<std::size_t> bends;
            if (keeps_height) add_bends(way.altitude_m, 0, way.places.size() - 1, bends);
            for (const auto bend : bends) path.entries.push_back(bend_of(entry, way, bend));
            if (auto text = below_ground(entry, way)) path.below_ground.push_back(std::move(*text));
        }
        path.entries.push_back(entry);
        from_m = to_m;
        if (entry.geographic) from = &entry;
    }
    if (!returns_home || from == nullptr || !from_m) return path;
    PathEntry back;
    back.name = "return to start";
    auto way = sampled_way(*from->geographic, home, terrain, home_ground_m);
    const auto first = std::ranges::find_if(entries, [](const auto& entry) { return !!entry.altitude_m; });
    set_altitudes(way, *from_m, *first->altitude_m, false);
    if (auto text = below_ground(back, way)) path.below_ground.push_back(std::move(*text));
    return path;
}

}  // namespace flightwatt::path
