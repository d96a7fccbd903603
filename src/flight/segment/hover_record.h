#pragma once

#include "flight/flight_data.h"
#include "flight/segment/flight_grid.h"
#include "flight/segment/phase_edges.h"

#include <vector>

namespace flightwatt::flight {

/// Finds the spans in which the motors of a rotorcraft carry it, from the first to the last point at which they give 70
/// % of their usual effort in flight, or of that of a lighter flight; empty for other aircraft, and without throttle
/// and power. A landing or disarming in between separates two of them; if the log states neither, idle motors do.
std::vector<IndexSpan> find_hovers(const FlightData& data, const ResampledFlight& grid);

/// Returns whether a state changes to a value after `from_s` and up to `to_s`.
bool changes_to(const Track& state, double value, double from_s, double to_s);

/// Returns the rests: the grid without the hovers.
std::vector<IndexSpan> rests_between(const std::vector<IndexSpan>& hovers, const ResampledFlight& grid);

/// Finds the edges of a rotorcraft's sortie by its motors, confirmed by the altitude (docs/methods.md): take-off ends
/// with the climb, hovering at any height is cruise, and landing begins with the final descent.
SortieEdges find_hover_edges(const ResampledFlight& grid, const Activity& activity, const Heights& heights);

/// Returns the time within 1.5 s of `edge_s` at which a land detector that reports all the time changes to `landed`;
/// else `edge_s`.
double confirmed_by_detector(const Track& detector, double edge_s, bool landed);

}  // namespace flightwatt::flight
