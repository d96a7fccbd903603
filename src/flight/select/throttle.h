#pragma once

#include "flight/flight_data.h"

#include <optional>

namespace flightwatt::flight {

/// Selects the throttle in percent: the first candidate that varies; commands to the motor if they are frequent or no
/// power is measured, thrust only without both. A throttle of unknown unit may be a fraction, as the power shows. While
/// it idles although the motor is commanded (manual mode), the commands are used.
ChosenTrack select_throttle(const FlightSeries& series, const Track& power_w);

/// The effort of the motor by other data than the throttle, on its own clock.
struct MotorEvidence {
    const Track& percent;
    double running_percent;  ///< the motor runs above this,
    double mean_percent;     ///< and flies the aircraft with at least this mean
    const Track& speed;      ///< ground speed: the throttle is replaced only while the aircraft moves; empty: always
};

/// The intervals in which evidence replaced a throttle.
struct ReplacedThrottle {
    double first_s;
    double together_s;    ///< time in which the motor ran
    double mean_percent;  ///< mean of the evidence in that time
};

/// Replaces an idle throttle by the evidence, in runs in which the motor runs for half a minute in all (in manual mode
/// some autopilots report no throttle). Returns std::nullopt if nothing was replaced.
std::optional<ReplacedThrottle> replace_idle_throttle(Track& throttle, double idle_percent,
                                                      const MotorEvidence& evidence);

}  // namespace flightwatt::flight
