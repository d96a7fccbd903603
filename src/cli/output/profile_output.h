#pragma once

#include "cli/screen_table.h"
#include "compute/profile_interpolation.h"
#include "compute/profile_outcome.h"
#include "compute/profile_tables.h"

#include <cstddef>
#include <string>
#include <vector>

/// What flightwatt profile prints.
namespace flightwatt::cli {

/// What was measured, as tables in the width of the screen. `above_idle`: power over the idle power instead of total
/// power.
std::string profile_text(const compute::ProfileOutcome& outcome, bool above_idle, const Screen& screen = {});

/// The same as JSON.
Json to_json(const compute::ProfileOutcome& outcome, bool above_idle);

Json to_json(const compute::LeaveOneOutErrors& error);

/// The errors of interpolating a profile as a table under its name.
std::string interpolation_text(const std::string& file, std::size_t nodes, const compute::LeaveOneOutErrors& error,
                               const Screen& screen = {});

}  // namespace flightwatt::cli
