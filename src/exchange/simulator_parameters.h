#pragma once

#include "exchange/autopilot_parameters.h"

/// Parameters of the batteries of simulators.
namespace flightwatt::exchange {

/// SIM_BATT_... and BATT_CAPACITY of ArduPilot's SITL, a line "NAME VALUE" each. What a simulator does not represent is
/// in comments and notes, here and below. Throws InputError without a battery.
ParameterText to_ardupilot_sitl(const EstimatorInput& input);

/// SDF's <plugin> of Gazebo's LinearBatteryPlugin, for a <model>. Throws InputError without battery and model.
ParameterText to_gazebo(const EstimatorInput& input);

}  // namespace flightwatt::exchange
