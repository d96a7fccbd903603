#pragma once

#include "live/live_flight.h"

#include <optional>
#include <vector>

namespace flightwatt::live {

/// [V] of a pack, measured below the battery's model for a minute: a cell at 3.7 V has fallen to 3.4, nearly empty.
inline constexpr double failing_cell_v = 0.3;

/// What somebody should look at now, in words: the reserve in danger (it is not kept at the high end of the energy's
/// interval), power so far outside of the 95 % interval that the model gave it beforehand, a silent link, a voltage
/// below the battery's model.
std::vector<Alarm> alarms_of(const LiveState& state, const std::optional<PredictionInput>& basis, double silence_s);

}  // namespace flightwatt::live
