#pragma once

#include "exchange/autopilot_parameters.h"

/// Settings of battery monitors: those of INAV, and of Paparazzi's ground station.
namespace flightwatt::exchange {

/// Returns INAV's settings for its CLI: battery, power in cruise and idle, cruise speed. Throws InputError without
/// battery and model, and for values outside INAV's ranges.
ParameterText to_inav(const EstimatorInput& input);

/// Returns the constants of Paparazzi's energy monitor (sw/ground_segment/python/energy_mon), as Python: power over
/// airspeed in level flight, energies of take-off and landing, the pack. Throws InputError without battery and physical
/// model.
ParameterText to_paparazzi(const EstimatorInput& input);

/// Returns the batterymodel.csv of Paparazzi's energy monitor: cell voltage from 4.20 to 2.50 V by 0.01 V, and the
/// charge drawn from a cell [mAh] at that voltage under 2, 4, 6, 8 and 10 A. Throws InputError without a battery, or
/// for one of constant voltage.
ParameterText to_paparazzi_map(const EstimatorInput& input);

}  // namespace flightwatt::exchange
