#pragma once

#include "telemetry/autopilot/row_collector.h"

#include <string_view>

namespace flightwatt::telemetry {

/// Returns whether a text was written by join_ulog_tables().
bool are_ulog_tables(std::string_view text);

/// Reads the rows of all tables, merged by time. Throws InputError for a table without timestamp, with file and line.
void read_ulog_tables(std::string_view text, RowCollector& rows);

}  // namespace flightwatt::telemetry
