#pragma once

#include "path/path_entries.h"
#include "path/plans/json_text.h"

#include <string>
#include <vector>

namespace flightwatt::path {

/// Returns notes of the straight lines between the places of a plan of QGroundControl that cross an excluded part of its
/// geofence, or are outside of all parts to stay in; a fence that is not understood has a note.
std::vector<std::string> fence_notes(const Json& plan, const std::vector<PathEntry>& entries);

}  // namespace flightwatt::path
