#pragma once

#include "compute/profile_outcome.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// Reads a recording of power:
///   - CSV with columns time_s and power_w
///   - powprofiler layer 1 (flags 100, ...), in steps of `interval_s`
/// Throws InputError for another format, times that do not rise, or a missing interval.
PowerTrace read_power_trace(const std::filesystem::path& path, std::optional<double> interval_s);

/// CSV of time_s and power_w, after `comments`.
std::string to_csv(const PowerTrace& trace, const std::vector<std::string>& comments);

}  // namespace flightwatt::compute
