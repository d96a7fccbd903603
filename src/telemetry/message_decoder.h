#pragma once

#include "telemetry/telemetry_log.h"

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::telemetry {

/// Decodes single messages as they arrive into the same rows that parse_telemetry() reads from a whole log.
class MessageDecoder {
  public:
    using Skipped = std::map<std::string, std::size_t, std::less<>>;

    /// Decodes the requested messages by the definitions of a .log, else by the built-in ones.
    MessageDecoder(const std::optional<LogConfiguration>& configuration, const std::vector<MessageRequest>& wanted);
    ~MessageDecoder();
    MessageDecoder(const MessageDecoder&) = delete;
    MessageDecoder& operator=(const MessageDecoder&) = delete;

    /// Decodes a message such as "ENERGY 57 11.62 1.64". If `values` of the fields are given (NaN for text and arrays),
    /// only the name and arrays are read from the text. The table has one row and is valid until the next call; nullptr
    /// for a message that is not requested, or not usable (and counted).
    const MessageTable* decode(double time_s, std::string_view message, std::span<const double> values = {});
    /// Starts another log: without a .log its messages may have other built-in definitions.
    void restart();

    /// Returns the number of unusable messages and values, by reason.
    const Skipped& skipped() const { return skipped_; }
    const std::vector<AssumedDefinition>& assumed_definitions() const { return assumed_; }

  private:
    struct Message;

    std::vector<Message> messages_;
    std::vector<std::string_view> words_;  ///< of the last message; its memory is reused
    Skipped skipped_;
    std::vector<AssumedDefinition> assumed_;
};

}  // namespace flightwatt::telemetry
