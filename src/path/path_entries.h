#pragma once

#include "base/toml_reader.h"
#include "path/path.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::path {

// Ranges of a path's numbers: beyond, the unit is wrong.
inline constexpr double max_m_per_s = 300.0;
inline constexpr double largest_circle_count = 1e4;
inline constexpr double min_radius_m = 1.0;
inline constexpr double max_radius_m = 1e5;
inline constexpr double max_leg_m = 1e6;

/// On the WGS84 ellipsoid.
struct GeodeticPosition {
    double latitude_deg = 0.0;
    double longitude_deg = 0.0;
};

/// The place in the plane that touches the ellipsoid at `origin`: exact to 1e-6 of distances within 10 km of it.
LocalPosition to_local(const GeodeticPosition& place, const GeodeticPosition& origin);

/// One entry of a path as written: where to fly, and what to do there. Values not given continue.
struct PathEntry {
    std::string name;  ///< "leg 3"
    Location where;
    std::optional<LocalPosition> place;
    std::optional<GeodeticPosition> geographic;
    std::optional<double> length_m;  ///< with course_deg, instead of a place
    std::optional<double> course_deg;
    std::optional<double> duration_s;  ///< the way there took so long: no wind triangle
    std::optional<double> altitude_m;  ///< at the end
    std::optional<double> airspeed_m_per_s;
    ClimbRates rates;
    std::optional<double> circles;  ///< around the place, or from where the aircraft is
    std::optional<double> radius_m;
    bool to_right = true;
    bool is_turn = false;  ///< circles that are a part of a pattern, and not flown more often
    std::optional<double> hold_s;
};

/// The numbers that waypoints and legs may have in addition to their place.
struct EntryValue {
    std::string_view name;  ///< as files call it
    std::optional<double> PathEntry::*value;
    NumberRange range;
};
inline constexpr std::array<EntryValue, 6> entry_values{{
    {"altitude_m", &PathEntry::altitude_m, between(-1e5, 1e5)},
    {"airspeed_m_per_s", &PathEntry::airspeed_m_per_s, more_than_up_to(0.0, max_m_per_s)},
    {"duration_s", &PathEntry::duration_s, more_than_up_to(0.0, 1e7)},
    {"hold_s", &PathEntry::hold_s, more_than_up_to(0.0, 1e7)},
    {"circles", &PathEntry::circles, more_than_up_to(0.0, largest_circle_count)},
    {"radius_m", &PathEntry::radius_m, between(min_radius_m, max_radius_m)},
}};

/// Defaults of a path, which an entry may override.
struct PathDefaults {
    double airspeed_m_per_s = 0.0;
    std::optional<double> altitude_m;  ///< at the start
    ClimbRates rates;
    std::optional<LocalPosition> start;  ///< none: the origin, or the first entry if that is geographic
    std::optional<GeodeticPosition> geographic_start;
    bool starts_at_first_place = false;  ///< without a start; at the edge of circles
    bool return_to_start = false;
    Location where;
};

/// The path that the entries make: to a place a leg; to circles around a place the leg to their edge; then circles,
/// then the hold. Throws InputError, placed at the entry, for a place in other coordinates than the path's, one that is
/// 300 km and more from the start, an altitude where the path has none at its start, and an entry that is nothing or
/// two things.
FlightPath build_path(const std::vector<PathEntry>& entries, const PathDefaults& defaults);

}  // namespace flightwatt::path
