#pragma once

#include "path/path.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::path {

/// How an aircraft turns.
struct TurnLimits {
    bool is_rotorcraft = false;  ///< it brakes before corners, and flies narrow circles more slowly
    double max_bank_deg = 45.0;
    std::optional<double> radius_m = std::nullopt;  ///< of turns at corners, if that is more than the bank needs
};

/// A path with its turns.
struct TurnedPath {
    FlightPath path;
    std::vector<std::string> notes;  ///< elements at which a limit binds
};

/// Returns the radius [m] at which a turn in a wind needs the bank, downwind.
double turn_radius_m(double airspeed_m_per_s, double bank_deg, double wind_m_per_s = 0.0);

/// Returns the time [s] of a whole circle over ground in a wind: of a wing as wide as the bank needs, of a rotorcraft
/// as fast as it permits.
double circle_time_s(double radius_m, double airspeed_m_per_s, const Wind& wind, const TurnLimits& limits);

/// Adds the turns to a path that is drawn with corners (docs/methods.md, Turns). A wing cuts a corner by an arc within
/// half of its legs; where they are too short, or the corner is sharper than 120 degrees, it flies over the corner and
/// from there the shortest way of arcs and lines to the end of the next leg, or to the start of the leg behind one
/// that is shorter than two radii. Circles narrower than the bank permits become wider. Parts have the names of their
/// elements, arcs `is_turn`. A rotorcraft takes the time to brake and to accelerate at each corner.
TurnedPath fly_turns(const FlightPath& drawn, const Wind& wind, const TurnLimits& limits);

}  // namespace flightwatt::path
