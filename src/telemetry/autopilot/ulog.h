#pragma once

#include "telemetry/autopilot/row_collector.h"

#include <string_view>
#include <vector>

namespace flightwatt::telemetry {

bool is_ulog(std::string_view bytes);

/// Reads a ULog into the rows that the collector wants (docs/formats.md). Returns all topics that the log defines.
/// Throws InputError for a log with features of a newer format.
std::vector<AutopilotMessage> read_ulog(std::string_view bytes, RowCollector& rows);

}  // namespace flightwatt::telemetry
