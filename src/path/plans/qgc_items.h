#pragma once

#include "path/plans/json_text.h"
#include "path/plans/mission_items.h"

#include <string>

namespace flightwatt::path {

/// Reads the items of a plan of QGroundControl, with those of its surveys and landing patterns, and what it states of its
/// vehicle; without a kind of vehicle its speed is that of a rotorcraft if `is_rotorcraft`. Throws InputError, placed in
/// the file.
MissionItems read_qgc_items(const Json& plan, const std::string& file, bool is_rotorcraft);

}  // namespace flightwatt::path
