#pragma once

#include "compute/sensors/power_trace.h"

#include <optional>
#include <string>
#include <string_view>

namespace flightwatt::compute {

/// Whether a line is tegrastats': it has a rail with power now and on average, "VDD_IN 4936mW/4936mW" or,
/// from older boards, "POM_5V_IN 2545/2600".
bool is_tegrastats(const std::string& line);

/// Power over time from NVIDIA's tegrastats: the rail that carries everything, or the sum of those that add
/// up (rails_of_total). Times are those of its date column, "11-21-2022 13:41:31", from the first line on,
/// whole seconds; with `interval_s`, lines are that apart. Throws InputError for a line without its rails,
/// and for neither dates that rise nor an interval.
PowerTrace parse_tegrastats(std::string_view text, const std::string& file, std::optional<double> interval_s);

}  // namespace flightwatt::compute
