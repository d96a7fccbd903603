#pragma once

#include "flight/checks/power_record.h"

#include <optional>
#include <string>
#include <vector>

/// Rules of the table of power_rules.cpp that compare more than samples.
namespace flightwatt::flight {

/// A finding of a rule, and the value that the table compares with its limits.
struct Finding {
    double value;
    std::string text;
};

using Findings = std::vector<Finding>;

/// Finds the median relative difference of power from voltage times current.
Findings product_difference(const PowerRecord& record);

/// Finds the part of the flight in which the voltage stays at one value while the current varies, if it stays nowhere
/// else for a fifth as long, as it would by a coarse resolution.
Findings stuck_voltage(const PowerRecord& record);

/// Finds, for each counter, the sum of its falls in flight over that of its rises.
Findings counter_return(const PowerRecord& record);

/// A gap in flight whose excess of the integral over a counter explains why these differ.
struct ClockJump {
    SampleGap gap;
    double closure_percent = 0.0;  ///< integral over counter without the excess, less 100 %
};

/// Returns the jump of the clock that explains why an integral is more than its counter, by more than usual gaps do;
/// std::nullopt without one.
std::optional<ClockJump> find_clock_jump(const PowerRecord& record, const OnBoardCounter& counter);

/// Finds the difference of each integral in flight from its counter, beyond rounding [%].
Findings counter_difference(const PowerRecord& record);

/// Finds phases whose energy differs from the counter by 2 % of that of the flight, relative to their limit.
Findings phase_difference(const PowerRecord& record);

/// Finds the standard deviation of each phase's energy between the samples of a slow power, relative to the energy.
Findings slow_samples(const PowerRecord& record);

/// Finds the difference of the currents at rest before and after each sortie, over the mean in flight.
Findings rest_current_drift(const PowerRecord& record);

/// Finds the energy in gaps of the altitude, which is sent more often than power: no message came, or the clock jumped.
Findings altitude_gaps(const PowerRecord& record);

/// Finds the energy in gaps of the power, relative to its limit.
Findings power_gaps(const PowerRecord& record);

/// Finds the height of a climb from lift-off without power [m]: power is logged late, or the aircraft was launched
/// otherwise.
Findings powerless_climb(const PowerRecord& record);

}  // namespace flightwatt::flight
