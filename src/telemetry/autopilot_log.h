#pragma once

#include "telemetry/telemetry_log.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::telemetry {

/// A log that defines its own messages (docs/formats.md, "Logs of other autopilots").
enum class AutopilotFormat {
    dataflash,       ///< ArduPilot, binary
    dataflash_text,  ///< the same as lines
    ulog,            ///< PX4
};

std::string_view to_string(AutopilotFormat format);

/// By the first bytes, for text by the lines of its formats; std::nullopt for anything else.
std::optional<AutopilotFormat> detect_autopilot_format(std::string_view bytes);

/// What a log states in addition to the columns of its messages.
struct LogFacts {
    std::map<std::string, std::string> information;  ///< ULog's, by key: "sys_uuid"
    std::map<std::string, double> parameters;
    std::vector<std::string> texts;  ///< messages to the user, at most a thousand
    std::size_t dropouts = 0;        ///< times at which ULog's logger lost data
    double dropout_s = 0.0;          ///< in all
};

/// A message, its number in the log, and its fields.
struct AutopilotMessage {
    std::string name;
    std::size_t count = 0;
    std::vector<std::string> fields;
};

struct AutopilotLog {
    TelemetryLog log = {};  ///< of one sender, with an empty id
    LogFacts facts = {};
    std::vector<AutopilotMessage> messages = {};  ///< all, the most frequent first
};

/// Reads the requested messages. A column has a quantity if the log states its unit; of ULog, the field "multi_id" is
/// the topic's instance and "control[3]" an element. A message of a damaged log counts if another one follows it; the
/// bytes between are counted as skipped. Throws InputError for a newer ULog and for damage of more than 64 MB.
AutopilotLog read_autopilot_log(std::string_view bytes, AutopilotFormat format, const std::filesystem::path& file,
                                const std::vector<MessageRequest>& wanted);

}  // namespace flightwatt::telemetry
