#pragma once

#include "answer/failsafe.h"
#include "exchange/autopilot_parameters.h"

/// Battery failsafes of autopilots, from a failsafe card. The files state in comments what the values rest on. A
/// parameter of an action that the card does not have is omitted, with a note. `input` has the pack and its cells.
namespace flightwatt::exchange {

/// Returns ArduPilot's BATT_CAPACITY, and per action the remaining charge and the voltage of the pack.
ParameterText to_failsafe_ardupilot(const EstimatorInput& input, const answer::FailsafeCard& card);

/// Returns PX4's thresholds as fractions of the charge, for COM_LOW_BAT_ACT 3: it returns at BAT_CRIT_THR and lands at
/// BAT_EMERGEN_THR; BAT_LOW_THR warns 5 points before. Values beyond the documented ranges are noted, not changed.
ParameterText to_failsafe_px4(const EstimatorInput& input, const answer::FailsafeCard& card);

/// Returns INAV's alarms for its CLI, in mAh and 0.01 V of a cell. Throws InputError for cells beyond INAV's ranges.
ParameterText to_failsafe_inav(const EstimatorInput& input, const answer::FailsafeCard& card);

/// Returns the voltages of the section BAT of Paparazzi's airframe, each early enough without a count of charge; the
/// catastrophic one, at which a motor is stopped, is that of the empty pack, rounded down. Throws InputError for a
/// battery of constant voltage.
ParameterText to_failsafe_paparazzi(const EstimatorInput& input, const answer::FailsafeCard& card);

}  // namespace flightwatt::exchange
