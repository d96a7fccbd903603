#pragma once

#include "flight/checks/power_record.h"

#include <string>
#include <vector>

namespace flightwatt::flight {

/// Applies the table of power_rules.cpp to a power record: what cannot be (faults exclude a flight from fits), and what
/// can but is doubtful. docs/methods.md has the thresholds and why.
void apply_power_rules(const PowerRecord& record, PowerReport& report);

// The unusual rules, which the table names: each returns what it finds.
using Texts = std::vector<std::string>;

Texts power_is_no_product(const PowerRecord& record);
Texts counters_run_back(const PowerRecord& record);
/// By more than 10 %, which is a fault; counters_differ() by less.
Texts counters_contradict(const PowerRecord& record);
Texts counters_differ(const PowerRecord& record);

Texts phases_differ_from_counter(const PowerRecord& record);
/// Of a sensor whose gain changes while the whole still agrees with the counter: by quarters of a sortie.
Texts gain_drifts(const PowerRecord& record);
/// Of a current at rest that is another one after a sortie than before.
Texts current_at_rest_drifts(const PowerRecord& record);
/// Of devices that report a power of their own beside voltage and current.
Texts devices_contradict_themselves(const PowerRecord& record);
/// Of gaps of the altitude, which comes more often than power: no message came, or the clock jumped.
Texts altitude_pauses(const PowerRecord& record);
Texts power_pauses(const PowerRecord& record);
/// Of one to five samples that rise above both neighbours or fall below them although the throttle does not: more than
/// 2 % of the energy. Where no throttle is known, of deep falls of one to three and of single high samples.
Texts power_changes_briefly(const PowerRecord& record);
/// Of a lift-off and 10 m of height without power: it is logged late, or the aircraft was launched by something else.
Texts climbs_without_power(const PowerRecord& record);

}  // namespace flightwatt::flight
