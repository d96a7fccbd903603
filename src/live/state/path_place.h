#pragma once

#include "flight/chosen_track.h"
#include "live/prediction.h"
#include "mission/remaining_path.h"

#include <optional>

namespace flightwatt::live {

/// Where a flight is on its path by the positions of its cruise, from its start until a moment: a forward filter over
/// places on the path (docs/methods.md, Flight along a path), which takes nothing later into account. The path begins where the cruise
/// does. std::nullopt
/// where no positions tell.
std::optional<PathSighting> sighted_on_path(const mission::PathForecast& path, const flight::FlightSeries& series,
                                            double cruise_start_s, double until_s);

}  // namespace flightwatt::live
