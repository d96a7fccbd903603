#pragma once

#include "exchange/autopilot_parameters.h"

/// Parameters of the batteries of simulators.
namespace flightwatt::exchange {

/// Returns SIM_BATT_... and BATT_CAPACITY of ArduPilot's SITL, a line "NAME VALUE" each. Comments and notes list what
/// the simulator does not represent. Throws InputError without a battery.
ParameterText to_ardupilot_sitl(const EstimatorInput& input);

/// Returns the SDF <plugin> of Gazebo's LinearBatteryPlugin, for a <model>. Comments and notes list what the simulator
/// does not represent. Throws InputError without battery and model.
ParameterText to_gazebo(const EstimatorInput& input);

}  // namespace flightwatt::exchange
