#pragma once

#include "flight/checks/power_record.h"
#include "flight/flight_phases.h"
#include "flight/power_check.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// What the warnings of a power record are made from.
struct PowerCheckInput {
    const PowerRecord& record;
    const FlightPhases& phases;
    const SampleFindings& samples;
    const PowerReport& report;                      ///< closures and faults are known
    std::optional<IdleCurrent> at_rest;             ///< also where no throttle tells that the motor is off
    std::vector<std::optional<IdleCurrent>> rests;  ///< the same before the first sortie, after it, ... the last
};

/// What of a power record is doubtful (docs/methods.md has the thresholds and why): an offset at rest, energy away from
/// the counter in the whole or in a phase, energy in gaps that nothing confirms, single samples or a value that stands
/// still that carry much of the energy, negative power, throttle without power, a voltage of no usual pack, power too
/// little to fly on. Every doubt that could hide 5 % of the energy is told.
std::vector<std::string> find_power_warnings(const PowerCheckInput& evidence);

}  // namespace flightwatt::flight
