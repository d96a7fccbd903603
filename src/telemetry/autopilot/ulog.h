#pragma once

#include "telemetry/autopilot/row_collector.h"

#include <string_view>

namespace flightwatt::telemetry {

bool is_ulog(std::string_view bytes);

/// Reads a ULog into the rows that the collector wants (docs/formats.md). Throws InputError for a log with features of
/// a newer format.
void read_ulog(std::string_view bytes, RowCollector& rows);

}  // namespace flightwatt::telemetry
