#pragma once

#include "base/units.h"
#include "flight/checks/power_record.h"
#include "flight/flight_phases.h"
#include "flight/power_check.h"

#include <cmath>
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

inline int percent_of_whole(double part) { return static_cast<int>(std::lround(part * units::percent_per_whole)); }

using Warnings = std::vector<std::string>;

/// Of one to five samples that rise above both neighbours or fall below them although the throttle does not: more than
/// 2 % of the energy. Where no throttle is known, of deep falls of one to three and of single high samples.
void warn_of_brief_changes(const PowerCheckInput& input, Warnings& warnings);

/// Of power that is far from its median at the same throttle (steps of 5 %, above 30 %): more than 4 % of the energy.
void warn_of_power_beside_throttle(const PowerCheckInput& input, Warnings& warnings);

/// What of a power record is doubtful (docs/methods.md has the thresholds and why): an offset at rest, energy away from
/// the counter in the whole or in a phase, energy in gaps that nothing confirms, single samples or a value that stands
/// still that carry much of the energy, negative power, throttle without power, a voltage of no usual pack, power too
/// little to fly on. Every doubt that could hide 5 % of the energy is told.
Warnings find_power_warnings(const PowerCheckInput& input);

}  // namespace flightwatt::flight
