#pragma once

#include "telemetry/telemetry_log.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Readers of the text of a Paparazzi .data file.
namespace flightwatt::telemetry {

/// Reads the requested messages of a Paparazzi .data text. `data_file` is named in errors, `configuration` is that of
/// the .log. Throws InputError for a text without a telemetry line, and for more than 300 senders.
TelemetryLog read_telemetry(std::string_view text, const std::filesystem::path& data_file,
                            std::optional<LogConfiguration> configuration, const std::vector<MessageRequest>& wanted);

/// Reads the requested messages as read_telemetry(), from a text that may have no telemetry. Throws InputError only for
/// more than 300 senders.
TelemetryLog parse_telemetry(std::string_view text, const std::filesystem::path& data_file,
                             std::optional<LogConfiguration> configuration, const std::vector<MessageRequest>& wanted);

/// Returns names and counts of the messages in a .data text, most frequent first; at most the first thousand names.
std::vector<std::pair<std::string, std::size_t>> count_messages(std::string_view text);

}  // namespace flightwatt::telemetry
