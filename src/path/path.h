#pragma once

#include "base/error.h"

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace flightwatt::path {

/// A steady wind along the whole path, and how it differs between flights.
struct Wind {
    double speed_m_per_s = 0.0;
    double from_deg = 0.0;  ///< direction from which it blows, clockwise from north
    double speed_sd_m_per_s = 0.0;
    double direction_sd_deg = 0.0;
};

/// A straight line over ground.
struct Leg {
    double length_m = 0.0;
    double course_deg = 0.0;  ///< clockwise from north
};

/// Circles around a fixed point on the ground, in any wind.
struct Circles {
    double radius_m = 0.0;
    double turns = 0.0;             ///< number of turns, also a fraction
    bool to_right = true;           ///< clockwise, seen from above
    double start_course_deg = 0.0;  ///< course at the start
};

/// A straight flight for a time, without a course over ground, or a hover.
struct Hold {
    double time_s = 0.0;
    std::optional<Leg> over_ground = std::nullopt;  ///< the leg, if its time was measured
    bool hovers = false;                            ///< it keeps its place: its airspeed is that of the wind
};

/// A part of a path, flown with one airspeed.
struct PathElement {
    std::variant<Leg, Circles, Hold> shape;
    double airspeed_m_per_s = 0.0;
    bool keeps_ground_speed = false;  ///< it is flown as a ground speed, in any wind, as by rotorcraft; not of holds
    double altitude_change_m = 0.0;   ///< altitude at its end less that at its start
    /// Rate of the change of altitude, which begins at the start of the element, the rest being level; more than 0 in
    /// climb and descent. Absent: the change is spread evenly over the element.
    std::optional<double> climb_rate_m_per_s = std::nullopt;
    bool is_return_leg = false;   ///< the leg from the end of the path to its start, or the change of height there
    bool is_turn = false;         ///< circles between lines, which are not repeated
    std::size_t drawn = 0;        ///< of a path with turns: the index of its element in the path without them
    std::size_t survey_line = 0;  ///< the line of a survey that it flies or leads to, from 1; 0: none
    std::string name;             ///< its name in messages: "leg 3"
    Location where;
};

/// A path over ground.
struct FlightPath {
    std::vector<PathElement> elements;
};

/// The rates at which altitude is changed, both more than 0; absent: evenly over a leg.
struct ClimbRates {
    std::optional<double> climb_m_per_s;
    std::optional<double> descent_m_per_s;
};

/// Returns the path out and back: up to `return_after_m` along its legs, then the same legs backwards without circles
/// and holds. Elements that begin later are not flown; a partial leg has that part of its change of altitude. The way
/// back has the rates of `back`; changes of altitude by circles and holds are undone evenly on the leg before them.
FlightPath out_and_back(const FlightPath& path, double return_after_m, const ClimbRates& back);

/// Returns the length over ground of the legs alone, without the leg back to the start.
double length_of_legs_m(const FlightPath& path);

/// A position on a path: the completed fraction of an element's time.
struct PathPosition {
    std::size_t element = 0;
    double part = 0.0;  ///< 0 to 1
};

/// A position east and north of an origin [m]; also the difference of two positions, or a direction of length 1.
struct LocalPosition {
    double east_m = 0.0;
    double north_m = 0.0;

    friend bool operator==(const LocalPosition&, const LocalPosition&) = default;
    friend LocalPosition operator+(const LocalPosition& a, const LocalPosition& b) {
        return {a.east_m + b.east_m, a.north_m + b.north_m};
    }
    friend LocalPosition operator-(const LocalPosition& a, const LocalPosition& b) {
        return {a.east_m - b.east_m, a.north_m - b.north_m};
    }
};

/// A position on the WGS84 ellipsoid.
struct GeodeticPosition {
    double latitude_deg = 0.0;
    double longitude_deg = 0.0;
};

/// Where a path is on the earth.
struct PathOrigin {
    GeodeticPosition place;                 ///< where the plane of the path touches the ellipsoid
    LocalPosition start = {};               ///< of the path, from there
    double ground_m = 0.0;                  ///< altitude of the ground above the sea; 0 where it is unknown
    std::optional<double> altitude_m = {};  ///< of the start above the ground
    bool is_above_sea = false;              ///< the altitude is above the sea, and that of the ground is unknown
};

/// Returns the distance between two places.
double distance_between_m(const LocalPosition& a, const LocalPosition& b);

/// Returns the course from one place to another, -180 to 180 degrees.
double course_between(const LocalPosition& from, const LocalPosition& to);

/// Returns the product of the lengths of two positions and the cosine of the angle between them, seen from the origin.
inline double scalar_product(const LocalPosition& a, const LocalPosition& b) {
    return a.east_m * b.east_m + a.north_m * b.north_m;
}

/// Returns a position moved straight over ground.
LocalPosition moved(const LocalPosition& from, double length_m, double course_deg);

/// Returns the path between two positions. A partial element changes its altitude evenly.
FlightPath path_between(const FlightPath& path, const PathPosition& from, const PathPosition& to);

/// Returns the place of a position, from the start of the path. Holds do not move it, except legs with a measured time.
LocalPosition local_position_at(const FlightPath& path, const PathPosition& place);

}  // namespace flightwatt::path
