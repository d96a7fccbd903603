#pragma once

#include "mechanical/physical_model.h"

#include <string>

namespace flightwatt {
class TomlTable;
}

namespace flightwatt::mechanical {

/// The table [physical] of a model file. Throws InputError with its place for keys that are missing, unknown or
/// impossible, a term given twice, and a covariance that is none.
PhysicalModel read_physical(const TomlTable& table);
std::string physical_toml(const PhysicalModel& model);

}  // namespace flightwatt::mechanical
