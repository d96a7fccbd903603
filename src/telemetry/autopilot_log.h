#pragma once

#include "telemetry/telemetry_log.h"

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace flightwatt::telemetry {

/// Formats of logs that define their own messages (docs/formats.md, "Logs of other autopilots").
enum class AutopilotFormat {
    dataflash,       ///< ArduPilot, binary
    dataflash_text,  ///< ArduPilot, converted to text lines
    sdlog2,          ///< PX4 until 2017, of the same form as DataFlash
    ulog,            ///< PX4
    ulog_tables,     ///< PX4, a CSV table for each topic, by ulog2csv
    tlog,            ///< any autopilot's MAVLink, recorded by a ground station
};

/// Returns the name of a format for messages.
std::string_view to_string(AutopilotFormat format);

/// Detects the format by the first bytes, in text by the form of its lines; std::nullopt for anything else.
std::optional<AutopilotFormat> detect_autopilot_format(std::string_view bytes);

/// Reads the requested messages of each aircraft in a log: of one, or of a .tlog those of each vehicle, whose sender has
/// its system number as id. A column has a quantity if the log states its unit; of ULog, the field "multi_id" is the
/// topic's instance and "control[3]" an element. A message of a damaged log counts if another one follows it; the bytes
/// between are counted as skipped. Throws InputError for a newer ULog and for damage of more than 64 MB.
std::vector<AutopilotLog> read_autopilot_logs(std::string_view bytes, AutopilotFormat format,
                                              const std::filesystem::path& file,
                                              const std::vector<MessageRequest>& wanted);

}  // namespace flightwatt::telemetry
