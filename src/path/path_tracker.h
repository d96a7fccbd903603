#pragma once

#include "flight/flight_data.h"
#include "path/remaining_path.h"

#include <optional>

namespace flightwatt::path {

/// The position of a flight on its path.
struct PathFix {
    std::optional<double> path_time_s = {};  ///< as planned time of the path; absent: no position is on it
    bool is_on_path = true;                  ///< false: the flight left the path at path_time_s
    std::optional<LocalPosition> at = {};    ///< where the aircraft is, from the start of the path
};

/// Finds the position of a flight on its path, which begins where the cruise does, from the positions of the cruise up
/// to a given time, by a forward filter over the path (docs/methods.md, Flight along a path). Later data are ignored.
/// std::nullopt without positions, and for a path that takes no time.
std::optional<PathFix> locate_on_path(const PathForecast& path, const flight::FlightData& data, double cruise_start_s,
                                      double until_s);

}  // namespace flightwatt::path
