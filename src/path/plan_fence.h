#pragma once

#include "path/path.h"

#include <string>
#include <vector>

namespace flightwatt::path {

/// The geofence of a plan, in parts with three corners or more.
struct PlanFence {
    std::vector<std::vector<GeodeticPosition>> excluded;
    std::vector<std::vector<GeodeticPosition>> included;  ///< it is to stay in one of them; none: anywhere
    bool is_understood = true;
};

/// Returns notes of the legs and circles of a path, as drawn, that cross an excluded part of a fence or are outside of
/// all parts to stay in; a fence that is not understood has a note.
std::vector<std::string> fence_notes(const PlanFence& fence, const FlightPath& path, const PathOrigin& origin);

}  // namespace flightwatt::path
