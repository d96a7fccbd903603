#pragma once

#include "flight/checks/power_record.h"

#include <string>
#include <vector>

namespace flightwatt::flight {

/// Applies the table of power_rules.cpp to a power record: impossible records (faults exclude a flight from fits) and
/// suspect ones (warnings). Thresholds and reasons: docs/methods.md.
void apply_power_rules(const PowerRecord& record, PowerReport& report);

// Rules of the table that compare more than samples: each returns its findings.
using Texts = std::vector<std::string>;

/// Median difference of power from voltage times current: above 10 % a fault, above 5 % a warning.
Texts power_contradicts_product(const PowerRecord& record);
Texts power_differs_from_product(const PowerRecord& record);
Texts counters_run_back(const PowerRecord& record);
/// Integral of power or current against its counter: above 10 % a fault, above 3 % a warning.
Texts counters_contradict(const PowerRecord& record);
Texts counters_differ(const PowerRecord& record);
Texts phases_differ_from_counter(const PowerRecord& record);
/// Current at rest before a sortie against that after it.
Texts current_at_rest_drifts(const PowerRecord& record);
/// Gaps of the altitude, which comes more often than power: no message came, or the clock jumped.
Texts altitude_has_gaps(const PowerRecord& record);
Texts power_has_gaps(const PowerRecord& record);
/// Lift-off and 10 m of height without power: it is logged late, or the aircraft was launched otherwise.
Texts climbs_without_power(const PowerRecord& record);

}  // namespace flightwatt::flight
