#pragma once

#include "base/error.h"
#include "mechanical/physical_model.h"

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace flightwatt::mission {

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

/// Around a fixed place on the ground, whatever the wind.
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

/// A part of a flight with one motion through the air.
struct TrajectorySegment {
    double time_s = 0.0;  ///< how long it lasts
    /// Its load factor is the root of the mean square, which makes the mean of a power that follows the square exact.
    mechanical::FlightState motion;
    std::size_t element = 0;
};

/// A path as it is flown in a wind.
struct PathTrajectory {
    std::vector<TrajectorySegment> pieces;          ///< in order, none shorter than 0 s
    std::vector<double> element_s;                  ///< how long each element takes
    double duration_s = 0.0;                        ///< of all
    std::optional<std::size_t> infeasible_element;  ///< the first element that the wind forbids, if that was asked for
};

/// What to do where the wind forbids an element.
enum class InfeasibleLegPolicy {
    refuse,  ///< throw InputError
    crawl  ///< note it in `infeasible_element`, and fly the element with 2 % of the airspeed over ground, which is as good as none
};

/// Flies a path in a steady wind: airspeed is held, the course over ground kept by a drift angle (docs/methods.md,
/// Eqs. 43 and 44). Around circles ground speed and bank change, which is integrated. Throws InputError, placed at the
/// element, for one that the wind forbids, that is too short or too steep for its climb, or for a path of more than
/// 1e7 s.
PathTrajectory compute_trajectory(const FlightPath& path, const Wind& wind,
                                  InfeasibleLegPolicy forbidden = InfeasibleLegPolicy::refuse);

/// Ground speed [m/s] in a wind, of level flight with a course over ground; none where the drift angle that it takes
/// does not exist, or the aircraft would be blown back.
std::optional<double> ground_speed_m_per_s(double airspeed_m_per_s, double course_deg, const Wind& wind);

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

}  // namespace flightwatt::mission
