#pragma once

#include "telemetry/autopilot/row_collector.h"

#include <string_view>

namespace flightwatt::telemetry {

/// Returns whether the bytes begin with a DataFlash message, perhaps after a damaged page.
bool is_dataflash(std::string_view bytes);

/// Returns whether a log of DataFlash's form is PX4's sdlog2: one of its messages defines that clock.
bool is_sdlog2(std::string_view bytes);

/// Reads the messages that the collector requests from a DataFlash log, binary or as text (docs/formats.md).
void read_dataflash(std::string_view bytes, bool as_text, RowCollector& rows);

}  // namespace flightwatt::telemetry
