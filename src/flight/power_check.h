#pragma once

#include "flight/flight_data.h"
#include "flight/flight_phases.h"
#include "flight/power_report.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// Checks the power record of a flight by the rules of docs/methods.md. The closures are over the sorties, lift-off to
/// touchdown; the idle current is over the rests with the motor off.
PowerReport check_power_record(const FlightData& data, const FlightPhases& phases,
                               const SegmentationOptions& options = {});

/// Returns the gap of a report with an integral that is a fault by its counter, if a jump of the clock there explains
/// it; std::nullopt without one.
std::optional<SampleGap> clock_jump_fault(const FlightData& data, const FlightPhases& phases,
                                          const PowerReport& report);

/// Returns the faults as the reason why a flight is excluded, with how to override this.
std::string describe_power_faults(const std::vector<std::string>& power_faults);

/// Subtracts the idle current from current and power (times the voltage of the same time, measured or power over
/// current). Counters are unchanged. Does nothing without an idle current.
void correct_idle_offset(FlightSeries& series, const FlightData& data, const std::optional<IdleCurrent>& idle);

}  // namespace flightwatt::flight
