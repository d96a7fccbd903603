#pragma once

#include "flight/flight_data.h"
#include "flight/flight_phases.h"

#include <string>

namespace flightwatt::flight {

/// Checks the fractions and the height; the other options have their limits where they are set. Throws UsageError for
/// thresholds outside of their range.
void validate(const SegmentationOptions& options);

/// Finds all sorties and their phases by altitude and throttle. A sortie is between two rests; lift-off is where the
/// aircraft last leaves the ground on its way up, touchdown where it first is back for good; take-off ends where the
/// held height is reached, landing begins where it is left; of a VTOL the take-off lasts until it flies on its wing, and
/// the landing begins where it last does. TAKEOFF, mode and block are recorded, but not used. Throws
/// InputError if the series has no altitude.
FlightPhases segment(const FlightData& data, const SegmentationOptions& options = {});

/// Throws InputError, naming `file` and the ground events, if there is no sortie.
void require_sortie(const FlightData& data, const FlightPhases& phases, const std::string& file);

}  // namespace flightwatt::flight
