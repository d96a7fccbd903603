#pragma once

#include "live/live_flight.h"

#include <optional>
#include <vector>

namespace flightwatt::live {

/// The alarms of a state, most severe first: silent link, probability of missing the reserve, voltage below the
/// battery's model, power outside the model's 95 % interval. `before`: of the last state. A grade that was reached ends
/// at half of its threshold, so that an alarm near it does not come and go.
std::vector<Alarm> alarms_of(const LiveState& state, const std::optional<PredictionInput>& input,
                             const std::vector<Alarm>& before);

}  // namespace flightwatt::live
