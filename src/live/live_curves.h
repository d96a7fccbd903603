#pragma once

#include "live/live_flight.h"

#include <vector>

namespace flightwatt::live {

/// A quantity over the telemetry's time.
struct TimeCurve {
    std::vector<double> time_s;
    std::vector<double> value;
};

/// The state of charge ahead as it is predicted, from now to the landing or to where the battery fails, in up to about
/// a hundred points; empty where there is no prediction with a battery.
TimeCurve soc_ahead(const LiveState& state, const PredictionInput& basis);

}  // namespace flightwatt::live
