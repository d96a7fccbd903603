#pragma once

#include "flight/segmentation/flight_grid.h"
#include "flight/selected_track.h"

#include <vector>

namespace flightwatt::flight {

/// The spans in which a rotorcraft is carried by its motors, from the first to the last point at which they give 70 % of
/// the usual effort in flight: for a rotorcraft whose autopilot states that it is armed or landed; empty for others. A
/// landing or disarming in between separates two of them.
std::vector<IndexSpan> find_hovers(const SelectedTracks& tracks, const ResampledFlight& grid);

/// The rests: all but the hovers.
std::vector<IndexSpan> rests_between(const std::vector<IndexSpan>& hovers, const ResampledFlight& grid);

/// The time within 1.5 s of `edge_s` at which a land detector that reports all the time turns to `landed`; else `edge_s`.
double confirmed_by_detector(const Track& detector, double edge_s, bool landed);

}  // namespace flightwatt::flight
