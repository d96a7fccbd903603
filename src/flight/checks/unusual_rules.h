#pragma once

#include "flight/checks/power_record.h"

#include <string>
#include <vector>

/// Rules of the table of power_rules.cpp that compare more than samples.
namespace flightwatt::flight {

/// A finding, and the value that the table compares with its limits.
struct Finding {
    double value;
    std::string text;
};

using Findings = std::vector<Finding>;

/// Median relative difference of power from voltage times current.
Findings product_difference(const PowerRecord& record);

/// Sum of each counter's falls in flight over that of its rises.
Findings counter_return(const PowerRecord& record);

/// Difference of each integral in flight from its counter, beyond rounding [%].
Findings counter_difference(const PowerRecord& record);

/// Phases that differ from the energy counter by 2 % of the flight, over their limit.
Findings phase_difference(const PowerRecord& record);

/// Difference of the currents at rest before and after each sortie, over the mean in flight.
Findings rest_current_drift(const PowerRecord& record);

/// Energy in gaps of the altitude, which comes more often than power: no message came, or the clock jumped.
Findings altitude_gaps(const PowerRecord& record);

/// Energy in gaps of the power, over its limit.
Findings power_gaps(const PowerRecord& record);

/// Height of a climb from lift-off without power [m]: it is logged late, or the aircraft was launched otherwise.
Findings powerless_climb(const PowerRecord& record);

}  // namespace flightwatt::flight
