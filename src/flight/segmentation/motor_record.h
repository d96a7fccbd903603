#pragma once

#include "flight/flight_series.h"
#include "flight/selected_track.h"

#include <string>
#include <vector>

namespace flightwatt::flight {

/// What tells that the motor runs.
enum class MotorIndicator { throttle, power, motor_speed, unknown };

/// The ground's power is the idle one, the 98th percentile of the log's the running one; power tells when the motor
/// runs if the latter is so many times the former, and so many watts more.
inline constexpr double min_running_to_idle_ratio = 3.0;
inline constexpr double min_running_above_idle_w = 2.0;
/// Of the way from idle to running power: up to here the motor idles; what never gets there is no flight [%].
inline constexpr double idle_power_percent = 10.0;
inline constexpr double flight_power_percent = 25.0;

/// What never turns faster carries nothing.
inline constexpr double min_running_rpm = 500.0;

/// How hard the motor works: throttle; where the log has none power on its way from idle (0) to running (100), or else
/// the motor's speed in percent of its full one (the 98th percentile of the log).
struct MotorRecord {
    MotorIndicator sign = MotorIndicator::unknown;
    Track percent;         ///< empty if unknown
    std::string evidence;  ///< "ENERGY.throttle", "power: idle 0.2 W, running 92 W", "ESC.rpm: full 9000 rpm"
    std::vector<std::string> warnings;  ///< what was left out, and what is used instead of a throttle
};

/// From throttle, power and the motor's speed; `altitude_m` (cleaned, not empty) tells which power is that on the ground.
MotorRecord motor_record(const SelectedTracks& tracks, const Track& altitude_m);

}  // namespace flightwatt::flight
