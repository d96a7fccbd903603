#pragma once

#include "telemetry/autopilot/row_collector.h"

#include <string_view>

namespace flightwatt::telemetry {

/// Whether the bytes begin with a DataFlash message, perhaps behind a damaged page.
bool is_dataflash(std::string_view bytes);

/// Whether a message of DataFlash's form defines the clock of PX4's sdlog2.
bool is_sdlog2(std::string_view bytes);

/// Reads a DataFlash log, binary or as text, into the rows that the collector wants (docs/formats.md).
void read_dataflash(std::string_view bytes, bool as_text, RowCollector& rows);

}  // namespace flightwatt::telemetry
