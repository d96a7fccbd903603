#pragma once

#include "exchange/autopilot_parameters.h"

/// Parameters of PX4 and of its simulation.
namespace flightwatt::exchange {

/// Returns PX4's BAT1_... and BAT_AVRG_CURRENT, as QGroundControl loads them; the latter requires a model. Throws
/// InputError without a battery, and for values outside PX4's ranges.
ParameterText to_px4(const EstimatorInput& input);

/// Returns SIM_BAT_... and the voltages of PX4's SITL, as QGroundControl loads them. Comments and notes list what the
/// simulator does not represent. Throws InputError without battery and model and beyond PX4's ranges, NoResultError if
/// a full battery cannot deliver the power of the cruise.
ParameterText to_px4_sitl(const EstimatorInput& input);

}  // namespace flightwatt::exchange
