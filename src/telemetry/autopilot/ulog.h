#pragma once

#include "telemetry/autopilot/row_collector.h"

#include <string_view>

namespace flightwatt::telemetry {

/// Returns whether the bytes begin as a ULog.
bool is_ulog(std::string_view bytes);

/// Reads the topics that the collector requests from a ULog (docs/formats.md). Throws InputError for a log with
/// features of a newer format.
void read_ulog(std::string_view bytes, RowCollector& rows);

}  // namespace flightwatt::telemetry
