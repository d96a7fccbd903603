#pragma once

#include "compute/profile_outcome.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// Reads a recording of power:
///   - a CSV with a header that has time_s and power_w (other columns are passed over)
///   - what tegrastats printed: the board's total (VDD_IN, POM_5V_IN, ...) or, where it has none, the sum of
///     its rails; times from its date column, or `interval_s` apart
///   - a powprofiler layer 1 (flags 100, ...), `interval_s` apart
/// Throws InputError for a file that is none of these, times that do not rise, or a missing interval.
PowerTrace read_power_trace(const std::filesystem::path& path, std::optional<double> interval_s);

/// "time_s,power_w" and a row a sample, after `comments` ('#' before each).
std::string to_csv(const PowerTrace& trace, const std::vector<std::string>& comments);

}  // namespace flightwatt::compute
