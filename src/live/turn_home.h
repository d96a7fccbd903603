#pragma once

#include "battery/landing_forecast.h"
#include "mission/path.h"
#include "mission/remaining_path.h"

#include <optional>
#include <vector>

namespace flightwatt::live {

/// A position relative to where the cruise began.
struct Displacement {
    double east_m = 0.0;
    double north_m = 0.0;

    friend bool operator==(const Displacement&, const Displacement&) = default;
};

/// Where a place of a path lies. A hold moves nothing, as the path goes on from where it was planned to, but where it
/// stands for a leg whose time was measured.
Displacement displacement_at(const mission::FlightPath& path, const mission::PathPosition& place);

/// Where a flight is on its path, by its positions.
struct PathFix {
    std::optional<double> path_time_s = {};  ///< in the path's planned time; none: they do not lie on the path
    bool is_on_path = true;                  ///< else it has left it, and was there last
    double distance_m = 0.0;                 ///< so far from there now
};

/// What a flight along a path has: its battery now, and the powers ahead.
struct ReturnFlightInput {
    battery::Battery battery;
    battery::BatteryState now;
    battery::LandingLimits limits;
    std::vector<battery::ConstantLoad> cruise_ahead;  ///< along the rest of the path
    std::optional<battery::ConstantLoad> landing;
    double power_factor = 1.0;  ///< of level flight home to what the plan's model says
};

struct ReturnDeadline {
    std::optional<double> latest_in_s;  ///< none: too late already
    bool path_can_be_flown = false;     ///< to its end, and home from there: `latest_in_s` is the end
};

/// The latest moment to leave a path and fly straight home, level, at the airspeed of the place and in the plan's wind,
/// so that landing there keeps the reserve. Looks every 10 s, or 40 times. `on_path_s`: since the cruise began.
ReturnDeadline latest_return(const mission::PathForecast& path, double on_path_s, const ReturnFlightInput& budget);

}  // namespace flightwatt::live
