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

/// How the messages of a log are framed, told by its content; nothing for text. Text is what begins with a line of
/// telemetry; binary is where frames with right checksums follow each other.
std::optional<Framing> detect_binary_framing(std::string_view bytes);

/// A log that is known to be binary, and what its definitions are.
struct BinaryLog {
    std::string_view bytes;
    Framing framing = Framing::card;
    std::filesystem::path file;         ///< named in errors
    std::filesystem::path definitions;  ///< the same
    const MessageDictionary* messages = nullptr;
};

/// The header of its messages. Throws InputError where none fits the definitions.
LinkVersion link_version(const BinaryLog& log);

/// Reads the wanted messages, from bytes to columns; `configuration` is what the file of the definitions says. A float
/// becomes the decimal number that its text would be, so that text and binary of a log are read alike. Throws
/// InputError where a quarter of the messages or more have other lengths than the definitions say, which then are
/// another aircraft's, and for a capture of a link that tells no times.
TelemetryLog read_binary_telemetry(const BinaryLog& log, LogConfiguration configuration,
                                   const std::vector<MessageRequest>& wanted);

/// The same without asking that it can be used: what fits is read.
TelemetryLog parse_binary_telemetry(const BinaryLog& log, LogConfiguration configuration,
                                    const std::vector<MessageRequest>& wanted);

/// Throws InputError as read_binary_telemetry does, by what a decoder counted.
void require_fitting(const LinkCounts& counts, const BinaryLog& log);

/// Names of the messages with their counts, most frequent first, as count_messages does for text.
std::vector<std::pair<std::string, std::size_t>> census_of_binary_messages(const BinaryLog& log);

}  // namespace flightwatt::telemetry
