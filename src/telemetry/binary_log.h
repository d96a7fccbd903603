#pragma once

#include "telemetry/link_decoder.h"
#include "telemetry/message_dictionary.h"
#include "telemetry/telemetry_log.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flightwatt::telemetry {

/// Detects the framing of a log's messages from its content; std::nullopt for text. A text begins with a line of
/// telemetry; a binary log has consecutive frames with valid checksums.
std::optional<Framing> detect_binary_framing(std::string_view bytes);

/// A binary log and its message definitions.
struct BinaryLog {
    std::string_view bytes;
    Framing framing = Framing::card;
    std::filesystem::path file;         ///< of the log, for errors
    std::filesystem::path definitions;  ///< file of the definitions, for errors
    const MessageDictionary* messages = nullptr;
};

/// Detects the version of the message headers. Throws InputError if no message matches the definitions.
LinkVersion link_version(const BinaryLog& log);

/// Reads the requested messages into columns; `configuration` is that of the definitions' file. A float becomes the
/// decimal number of its text, so that text and binary form of a log have the same values. Throws InputError if a
/// quarter of the messages or more have other lengths than defined (another build's definitions), and for a capture of
/// a link without times.
TelemetryLog read_binary_telemetry(const BinaryLog& log, LogConfiguration configuration,
                                   const std::vector<MessageRequest>& wanted);

/// Reads the requested messages as read_binary_telemetry(), without its two checks.
TelemetryLog parse_binary_telemetry(const BinaryLog& log, LogConfiguration configuration,
                                    const std::vector<MessageRequest>& wanted);

/// Throws InputError if a quarter of the counted messages or more have other lengths than defined.
void require_matching_lengths(const LinkCounts& counts, const BinaryLog& log);

/// Returns names and counts of the messages in a binary log, most frequent first.
std::vector<std::pair<std::string, std::size_t>> count_binary_messages(const BinaryLog& log);

}  // namespace flightwatt::telemetry
