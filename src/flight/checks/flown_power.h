#pragma once

#include "base/units.h"
#include "flight/checks/power_record.h"
#include "flight/checks/power_warnings.h"

#include <cmath>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// The record and its energy in flight [J].
struct InFlightPower {
    const PowerCheckInput& evidence;
    const PowerRecord& record;
    double energy_j = 0.0;
    double duration_s = 0.0;
};

template <typename Visit>
void for_each_in_flight(const PowerRecord& record, Visit&& visit) {
    for (const auto& [first, last] : record.in_flight)
        for (auto i = first; i < last; ++i) visit(i);
}

inline int percent_of_whole(double part) { return static_cast<int>(std::lround(part * units::percent_per_whole)); }

using Warnings = std::vector<std::string>;

/// Of one to five samples that rise above both neighbours or fall below them although the throttle does not: more than
/// 2 % of the energy. Where no throttle is known, of deep falls of one to three and of single high samples.
void warn_of_brief_changes(const InFlightPower& flown, Warnings& warnings);

/// Of power that is far from its median at the same throttle (steps of 5 %, above 30 %): more than 4 % of the energy.
void warn_of_power_beside_throttle(const InFlightPower& flown, Warnings& warnings);

/// Of a current at rest that is another one after a sortie than before: a sensor that drifts.
void warn_of_drift(const InFlightPower& flown, Warnings& warnings);

/// Of a lift-off and 10 m of height without power: it is logged late, or the aircraft was launched by something else.
void warn_of_powerless_climb(const InFlightPower& flown, Warnings& warnings);

}  // namespace flightwatt::flight
