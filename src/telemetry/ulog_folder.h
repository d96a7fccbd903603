#pragma once

#include "telemetry/telemetry_log.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// The tables that ulog2csv writes of one log into a folder, as one text.
namespace flightwatt::telemetry {

/// Returns the file that represents the log to which a table of ulog2csv, NAME_TOPIC_N.csv, belongs: the table of the
/// battery in its folder, else of an altitude. std::nullopt for other files.
std::optional<std::filesystem::path> find_ulog_tables(const std::filesystem::path& file);

/// Joins the tables of the requested topics of the log that a file represents into one text for read_autopilot_logs().
/// Throws InputError for a table that cannot be read, and for more than `max_bytes`.
std::string join_ulog_tables(const std::filesystem::path& file, const std::vector<MessageRequest>& wanted,
                             std::size_t max_bytes);

}  // namespace flightwatt::telemetry
