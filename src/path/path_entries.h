#pragma once

#include "base/toml_reader.h"
#include "path/path.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::path {

// Limits of the numbers of a path; a number beyond them has the wrong unit.
inline constexpr double max_m_per_s = 300.0;
inline constexpr double largest_circle_count = 1e4;
inline constexpr double min_radius_m = 1.0;
inline constexpr double max_radius_m = 1e5;
inline constexpr double max_leg_m = 1e6;

/// Returns the place in the plane that touches the ellipsoid at `origin`: exact to 1e-6 of distances within 10 km of
/// it.
LocalPosition to_local(const GeodeticPosition& place, const GeodeticPosition& origin);

/// Returns the place of a position in that plane.
GeodeticPosition to_geodetic(const LocalPosition& position, const GeodeticPosition& origin);

/// One entry of a path as written: a place to fly to, and the manoeuvre there. Absent values are those of the entry
/// before.
struct PathEntry {
    std::string name;  ///< "leg 3"
    Location where;
    std::optional<LocalPosition> place;
    std::optional<GeodeticPosition> geographic;
    std::optional<double> length_m;  ///< length of a leg with course_deg, instead of a place
    std::optional<double> course_deg;
    std::optional<double> duration_s;  ///< measured time of the way there, which replaces the wind triangle
    std::optional<double> altitude_m;  ///< altitude at the end
    bool is_above_terrain = false;     ///< the plan states it above the ground below
    bool waits_for_altitude = false;   ///< what the way there is too short for at the rates on the spot changes there
    std::optional<double> airspeed_m_per_s;
    ClimbRates rates;
    std::optional<double> circles;  ///< number of circles around the place, else from the aircraft's position
    std::optional<double> radius_m;
    bool to_right = true;
    bool is_turn = false;  ///< the circles are part of a pattern, and are not repeated
    std::optional<double> hold_s;
    std::size_t survey_line = 0;  ///< the line of a survey that it flies or leads to, from 1; 0: none
};

/// A number that waypoints and legs may have in addition to their place.
struct EntryValue {
    std::string_view name;  ///< key or column in files
    std::optional<double> PathEntry::*value;
    NumberRange range;
};
/// All such numbers.
inline constexpr std::array<EntryValue, 6> entry_values{{
    {"altitude_m", &PathEntry::altitude_m, between(-1e5, 1e5)},
    {"airspeed_m_per_s", &PathEntry::airspeed_m_per_s, more_than_up_to(0.0, max_m_per_s)},
    {"duration_s", &PathEntry::duration_s, more_than_up_to(0.0, 1e7)},
    {"hold_s", &PathEntry::hold_s, more_than_up_to(0.0, 1e7)},
    {"circles", &PathEntry::circles, more_than_up_to(0.0, largest_circle_count)},
    {"radius_m", &PathEntry::radius_m, between(min_radius_m, max_radius_m)},
}};

/// The start of a path, and defaults that an entry may override.
struct PathDefaults {
    double airspeed_m_per_s = 0.0;
    std::optional<double> altitude_m;  ///< at the start
    ClimbRates rates;
    ClimbRates rates_on_spot;            ///< of changes above one place, where nothing else states the rate or time
    std::optional<LocalPosition> start;  ///< absent: the origin, or the first entry if that is geographic
    std::optional<GeodeticPosition> geographic_start;
    std::optional<GeodeticPosition> local_origin;  ///< of places in metres, if it is known
    double ground_m = 0.0;                         ///< above the sea, where the altitudes are above the sea
    bool is_above_ground = false;                  ///< what the altitudes are above is known
    bool is_above_sea = false;                     ///< altitudes are above the sea, and ground_m is unknown
    bool starts_at_first_place = false;            ///< the path starts at the first place; for circles at their edge
    bool return_to_start = false;
    Location where;
};

/// Builds the path of the entries: a leg to a place, or to the edge of circles around it; then the circles; then the
/// hold. Throws InputError, placed at the entry, for a place in other coordinates than the path's or 300 km or more
/// from the start, for an altitude if the path has none at its start, and for an entry that is no manoeuvre or two.
FlightPath build_path(const std::vector<PathEntry>& entries, const PathDefaults& defaults);

/// Returns where the path of the entries is; std::nullopt for one in metres from an unknown place.
std::optional<PathOrigin> path_origin(const std::vector<PathEntry>& entries, const PathDefaults& defaults);

/// Returns the height [m] of the path's start above the ground of home; std::nullopt if it is not known.
std::optional<double> start_above_ground_m(const std::vector<PathEntry>& entries, const PathDefaults& defaults);

}  // namespace flightwatt::path
