#pragma once

#include "flight/flight_data.h"

#include <string>
#include <vector>

namespace flightwatt::flight {

/// The track that shows whether the motor runs.
enum class MotorIndicator { throttle, power, motor_speed, unknown };

/// Power shows whether the motor runs if the running power (98th percentile of the log) exceeds the idle power (on the
/// ground) by this ratio and this difference.
inline constexpr double min_running_to_idle_ratio = 3.0;
inline constexpr double min_running_above_idle_w = 2.0;
/// Limits of the power, from idle (0) to running (100) [%]: maximum of an idling motor, minimum of the maximum in a
/// flight.
inline constexpr double idle_power_percent = 10.0;
inline constexpr double flight_power_percent = 25.0;

/// Minimum of the usual current of a hovering rotorcraft; electronics and idling motors draw less.
inline constexpr double min_lifting_a = 5.0;

/// Minimum of the full speed of a motor that can propel an aircraft.
inline constexpr double min_running_rpm = 500.0;

/// Interval between samples of a power that is too slow for lift-off and touchdown [s]: it lasts as long as a climb.
inline constexpr double slow_power_s = 2.0;

/// Motor effort: the throttle; without one the power from idle (0) to running (100), else the motor's speed in percent
/// of its full speed (the 98th percentile of the log). A VTOL has two kinds of motors: the larger of throttle and power.
struct MotorRecord {
    MotorIndicator indicator = MotorIndicator::unknown;
    Track percent;         ///< empty if unknown
    std::string evidence;  ///< "ENERGY.throttle", "power: idle 0.2 W, running 92 W", "ESC.rpm: full 9000 rpm"
    std::vector<std::string> warnings;  ///< removed and substituted data
};

/// Returns the usual effort, in the unit of the values, of motors that carry a rotorcraft: the median above half of the
/// 90th percentile.
double usual_effort(std::vector<double> values);

/// Derives the motor effort from throttle, power and motor speed; `altitude_m` (cleaned) identifies power on the
/// ground.
MotorRecord motor_record(const FlightData& data, const Track& altitude_m);

}  // namespace flightwatt::flight
