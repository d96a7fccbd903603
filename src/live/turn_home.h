#pragma once

#include "battery/landing_forecast.h"
#include "live/prediction.h"
#include "path/remaining_path.h"

#include <optional>
#include <vector>

namespace flightwatt::live {

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
ReturnDeadline latest_return(const path::PathForecast& path, double on_path_s, const ReturnFlightInput& budget);

/// A quantity over the telemetry's time.
struct TimeCurve {
    std::vector<double> time_s;
    std::vector<double> value;
};

/// The state of charge ahead as it is predicted, from `now_s` to the landing or to where the battery fails, in up to
/// about a hundred points. The basis has a battery.
TimeCurve soc_ahead(const PredictionInput& basis, const Prediction& prediction, battery::BatteryState now,
                    double now_s);

}  // namespace flightwatt::live
