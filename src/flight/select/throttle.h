#pragma once

#include "flight/flight_data.h"

#include <optional>

namespace flightwatt::flight {

/// The throttle in percent: the first candidate that varies; commands to the motor where they come often or no power is
/// measured, thrust only without both. A throttle of unknown unit may be a fraction, as the power shows. Where it idles
/// while the motor is commanded (manual mode), the commands are used.
ChosenTrack select_throttle(const FlightSeries& series, const Track& power_w);

/// Effort of the motor by other data than the throttle, on its own clock.
struct MotorEvidence {
    const Track& percent;
    double running_percent;  ///< above it the motor runs,
    double mean_percent;     ///< and with at least this mean it is flown
    const Track& speed;      ///< over ground: only where the aircraft moves; empty: anywhere
};

/// Where evidence replaced a throttle.
struct ReplacedThrottle {
    double first_s;
    double together_s;    ///< in which the motor ran
    double mean_percent;  ///< of the evidence then
};

/// Replaces an idle throttle by the evidence, in runs in which the motor runs for half a minute in all (in manual mode
/// some autopilots report no throttle).
std::optional<ReplacedThrottle> replace_idle_throttle(Track& throttle, double idle_percent,
                                                      const MotorEvidence& evidence);

}  // namespace flightwatt::flight
