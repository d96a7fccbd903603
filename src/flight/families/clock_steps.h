#pragma once

#include "telemetry/log_notes.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace flightwatt::flight {

/// Undoes steps of up to 10 s by which the clock of a recording was set back: the rows behind keep their order and
/// intervals. `time_s` are the times of rows in the order of the file, `lines` their places. Rows that are late, also
/// several in a row, are left. Returns a finding about the steps, by line; std::nullopt without any.
std::optional<telemetry::SkippedLines> undo_clock_steps(std::vector<double>& time_s,
                                                        const std::vector<std::size_t>& lines);

}  // namespace flightwatt::flight
