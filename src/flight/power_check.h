#pragma once

#include "flight/flight_data.h"
#include "flight/flight_phases.h"
#include "flight/power_report.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// Checks a power record by the rules of docs/methods.md. The closure is over the sorties, lift-off to touchdown; the
/// idle current over the rests with the motor off.
PowerReport check_power_record(const FlightData& data, const FlightPhases& phases,
                               const SegmentationOptions& options = {});

/// The faults as the reason why a flight is excluded, and how to override this.
std::string describe_power_faults(const std::vector<std::string>& power_faults);

/// Subtracts the idle current from current and power (times the voltage of the same time, measured or power over
/// current). Counters are unchanged. Does nothing without an idle current.
void correct_idle_offset(FlightSeries& series, const FlightData& data, const std::optional<IdleCurrent>& idle);

}  // namespace flightwatt::flight
