#pragma once

#include "flight/flight_data.h"
#include "flight/segment/flight_grid.h"
#include "flight/segment/phase_edges.h"

#include <vector>

namespace flightwatt::flight {

/// The spans in which a rotorcraft is carried by its motors, from the first to the last point at which they give 70 % of
/// the usual effort in flight; empty for others, and without throttle and power. A landing or disarming in between
/// separates two of them; if the log states neither, idle motors do.
std::vector<IndexSpan> find_hovers(const FlightData& data, const ResampledFlight& grid);

/// Whether a state takes a value after `from_s` and up to `to_s`.
bool changes_to(const Track& state, double value, double from_s, double to_s);

/// The rests: all but the hovers.
std::vector<IndexSpan> rests_between(const std::vector<IndexSpan>& hovers, const ResampledFlight& grid);

/// The edges of a rotorcraft's sortie, which its motors decide and the altitude confirms (docs/methods.md): take-off
/// ends with the climb, hovering at any height is cruise, and landing begins with the final descent.
SortieEdges find_hover_edges(const ResampledFlight& grid, const Activity& activity, const Heights& heights);

/// The time within 1.5 s of `edge_s` at which a land detector that reports all the time turns to `landed`; else `edge_s`.
double confirmed_by_detector(const Track& detector, double edge_s, bool landed);

}  // namespace flightwatt::flight
