#pragma once

#include "telemetry/telemetry_log.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace flightwatt::telemetry {

/// Maximum number of recordings in one file; a clock that restarts more often is damaged.
inline constexpr std::size_t max_recordings = 64;

/// Returns whether rows of a sender show another recording (a clock that restarts), and not only lines out of order.
using ShowsRestart = std::function<bool(const SenderLog& rows)>;

/// Splits a log into its recordings in the order of the file, each with its rows, skipped lines and assumptions. One
/// begins at a row whose time falls by more than 2 s, if ten rows or more follow before the time is back where it was,
/// without a jump back there, and the rows before the next fall show a restart. Rows without places are not split, nor
/// is a log of more than max_recordings.
std::vector<TelemetryLog> split_recordings(TelemetryLog log, const ShowsRestart& shows_restart);

}  // namespace flightwatt::telemetry
