#pragma once

#include "telemetry/binary/frame_scanner.h"

#include <string>
#include <vector>

namespace flightwatt::telemetry {

/// Appends a message that fits its definition as a line of a .data without time and break: sender, name, fields; arrays
/// joined by commas, char[] in quotes (a quote or control character in it becomes '?'), floats in as few digits as give
/// them back, with a point or an exponent.
void append_message_text(const FoundFrame& found, std::string& text);

/// The values of its fields; NaN for what is no single finite number.
void read_message_values(const FoundFrame& found, std::vector<double>& values);

}  // namespace flightwatt::telemetry
