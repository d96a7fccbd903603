#pragma once

#include "telemetry/telemetry_log.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::telemetry {

/// A log that defines its own messages (docs/formats.md, "Logs of other autopilots").
enum class AutopilotFormat {
    dataflash,       ///< ArduPilot, binary
    dataflash_text,  ///< the same as lines
    sdlog2,          ///< PX4 until 2017, of the same form as DataFlash
    ulog,            ///< PX4
    ulog_tables,     ///< the same as a table for each topic, by ulog2csv
};

std::string_view to_string(AutopilotFormat format);

/// By the first bytes, for text by the lines of its formats; std::nullopt for anything else.
std::optional<AutopilotFormat> detect_autopilot_format(std::string_view bytes);

/// Reads the requested messages. A column has a quantity if the log states its unit; of ULog, the field "multi_id" is
/// the topic's instance and "control[3]" an element. A message of a damaged log counts if another one follows it; the
/// bytes between are counted as skipped. Throws InputError for a newer ULog and for damage of more than 64 MB.
AutopilotLog read_autopilot_log(std::string_view bytes, AutopilotFormat format, const std::filesystem::path& file,
                                const std::vector<MessageRequest>& wanted);

/// The file that represents the log of a table by ulog2csv: of NAME_TOPIC_N.csv, that of the battery in its folder, else
/// of an altitude. std::nullopt for other files.
std::optional<std::filesystem::path> ulog_tables_of(const std::filesystem::path& file);

/// The tables of the requested topics of the log that a file represents, as one text for read_autopilot_log(). Throws
/// InputError for a table that cannot be read, and for more than `max_bytes`.
std::string join_ulog_tables(const std::filesystem::path& file, const std::vector<MessageRequest>& wanted,
                             std::size_t max_bytes);

}  // namespace flightwatt::telemetry
