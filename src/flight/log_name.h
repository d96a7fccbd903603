#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace flightwatt::flight {

/// When a log was begun, by the clock of the ground station that named it so: "20_07_05__10_26_44", wherever in the
/// name that stands. None where it does not, or is no time.
std::optional<std::chrono::sys_seconds> start_in_name(const std::string& name);

}  // namespace flightwatt::flight
