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
    double from_deg = 0.0;  ///< where it blows from, clockwise from north
    double speed_sd_m_per_s = 0.0;
    double direction_sd_deg = 0.0;
};

/// Straight over ground.
struct Leg {
    double length_m = 0.0;
    double course_deg = 0.0;  ///< clockwise from north
};

/// Around a fixed point on the ground, in any wind.
struct Circles {
    double radius_m = 0.0;
    double turns = 0.0;             ///< need not be whole
    bool to_right = true;           ///< clockwise, seen from above
    double start_course_deg = 0.0;  ///< where the aircraft goes as it starts
};

/// For a time, straight and wherever it goes.
struct Hold {
    double time_s = 0.0;
    std::optional<Leg> over_ground = std::nullopt;  ///< of a leg whose time was measured
};

/// A part of a path, flown with one airspeed.
struct PathElement {
    std::variant<Leg, Circles, Hold> shape;
    double airspeed_m_per_s = 0.0;
    double altitude_change_m = 0.0;  ///< from its start to its end
    /// At which the change is flown, from the start of the element on, the rest level; more than 0, up as down. None:
    /// evenly over the whole element.
    std::optional<double> climb_rate_m_per_s = std::nullopt;
    bool is_return_leg = false;  ///< the leg from the end of the path to its start
    std::string name;            ///< "leg 3", as messages call it
    Location where;
};

struct FlightPath {
    std::vector<PathElement> elements;
};

/// At which heights are changed, both more than 0; none: evenly over a leg.
struct ClimbRates {
    std::optional<double> climb_m_per_s;
    std::optional<double> descent_m_per_s;
};

/// The path there and back: up to `return_after_m` along its legs, then the same legs backwards, without the circles
/// and holds in between. Elements that begin later are not flown, a leg in part has that part of its change of height.
/// The way back takes the rates of `back`, and evenly undoes on the leg before them what circles and holds changed.
FlightPath out_and_back(const FlightPath& path, double return_after_m, const ClimbRates& back);

/// Over the ground, of the legs alone, without the way home.
double length_of_legs_m(const FlightPath& path);

/// A position on a path: the completed fraction of an element's time.
struct PathPosition {
    std::size_t element = 0;
    double part = 0.0;  ///< 0 to 1
};

/// East and north [m], from an origin; or a difference of two of them, or a direction of length 1.
struct LocalPosition {
    double east_m = 0.0;
    double north_m = 0.0;

    friend bool operator==(const LocalPosition&, const LocalPosition&) = default;
    friend LocalPosition operator-(const LocalPosition& a, const LocalPosition& b) {
        return {a.east_m - b.east_m, a.north_m - b.north_m};
    }
};

/// A position moved straight over ground.
LocalPosition moved(const LocalPosition& from, double length_m, double course_deg);

/// The path between two positions. An element in part changes its height evenly.
FlightPath path_between(const FlightPath& path, const PathPosition& from, const PathPosition& to);

/// Location of a position, from the start of the path. Holds do not move it, except those of legs with a measured time.
LocalPosition local_position_at(const FlightPath& path, const PathPosition& place);

}  // namespace flightwatt::path
