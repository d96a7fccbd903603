#pragma once

#include "flight/checks/power_record.h"
#include "flight/power_report.h"

namespace flightwatt::flight {

/// Applies the table of power_rules.cpp to a power record: impossible records (faults exclude a flight from fits) and
/// suspect ones (warnings; docs/methods.md).
void apply_power_rules(const PowerRecord& record, PowerReport& report);

}  // namespace flightwatt::flight
