#pragma once

#include "telemetry/autopilot/row_collector.h"

#include <string_view>

namespace flightwatt::telemetry {

/// Whether a text is that of join_ulog_tables().
bool are_ulog_tables(std::string_view text);

/// The rows of all tables, by time. Throws InputError for a table without timestamp, with file and line.
void read_ulog_tables(std::string_view text, RowCollector& rows);

}  // namespace flightwatt::telemetry
