#pragma once

#include "flight/flight_phases.h"
#include "flight/flight_series.h"
#include "flight/selected_track.h"

#include <string>

namespace flightwatt::flight {

/// Throws UsageError for thresholds that make no sense.
void validate(const SegmentationOptions& options);

/// Finds every sortie of the series, and its phases, by altitude and throttle. An aircraft flies between two rests;
/// lift-off is where it last leaves the ground on its way up, touchdown where it first is back for good; take-off ends
/// where it reaches, and landing begins where it leaves, the height that it holds after and before. TAKEOFF, mode and
/// block are noted as witnesses and decide nothing. Throws InputError where the series has no altitude.
FlightPhases segment(const SelectedTracks& tracks, const SegmentationOptions& options = {});

/// Throws InputError saying what the log shows instead, if there is no sortie. `file` is named in it.
void require_sortie(const FlightSeries& series, const FlightPhases& phases, const std::string& file);

}  // namespace flightwatt::flight
