#pragma once

#include "base/units.h"
#include "telemetry/log_configuration.h"
#include "telemetry/log_notes.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::telemetry {

/// A message that is wanted, and which of its fields (those that the flight's definition has are read). "values[0]" is
/// the first element of an array, as a number without a unit.
struct MessageRequest {
    std::string message;
    std::vector<std::string> fields;
};

/// One field over time, in the base unit of its quantity. A value that was no finite number is NaN here (and
/// counted), so that its row's other fields stay usable.
struct Column {
    std::string field;
    std::optional<units::Quantity> quantity;
    std::vector<double> values;
};

/// The rows of one message of one sender, in the order of the file.
struct MessageTable {
    std::string message;
    std::vector<double> time_s;
    std::vector<Column> columns;

    bool empty() const { return time_s.empty(); }
    /// The column of `field`; nullptr if the flight's definition has none.
    const Column* column(std::string_view field) const;
};

/// Everything that was asked for of one sender.
struct SenderLog {
    std::string id;
    std::vector<MessageTable> tables;

    /// The table of `message`; nullptr if the sender sent none.
    const MessageTable* table(std::string_view message) const;
};

struct TelemetryLog {
    std::filesystem::path data_file;
    std::string flight;
    std::optional<LogConfiguration> configuration;  ///< absent without a .log
    std::vector<SenderLog> senders;                 ///< in the order of their first wanted line
    std::vector<SkippedLines> skipped;
    std::vector<AssumedDefinition> assumed_definitions;  ///< for want of a .log, or of its units
    std::size_t lines = 0;
};

/// Reads the wanted messages of a Paparazzi .data text; only these are parsed. `data_file` is named in errors,
/// `configuration` is what its .log says. Throws InputError for a text that holds no telemetry line, and for more
/// than 300 senders.
TelemetryLog read_telemetry(std::string_view text, const std::filesystem::path& data_file,
                            std::optional<LogConfiguration> configuration, const std::vector<MessageRequest>& wanted);

/// The same for any text, which need not hold telemetry. Throws InputError for more than 300 senders alone. A long text
/// is cut at line ends and read on all cores; `parts` says in how many pieces (0: as suits it): the result is the same.
TelemetryLog parse_telemetry(std::string_view text, const std::filesystem::path& data_file,
                             std::optional<LogConfiguration> configuration, const std::vector<MessageRequest>& wanted,
                             std::size_t parts = 0);

/// Single messages to rows of a log's tables, as they come in: the same values that reading a whole log gives.
class MessageDecoder {
  public:
    using Skipped = std::map<std::string, std::size_t, std::less<>>;

    MessageDecoder(const std::optional<LogConfiguration>& configuration, const std::vector<MessageRequest>& wanted);
    ~MessageDecoder();
    MessageDecoder(const MessageDecoder&) = delete;
    MessageDecoder& operator=(const MessageDecoder&) = delete;

    /// Takes "ENERGY 57 11.62 1.64". Where `values` of its fields are given (NaN for what is no single number), of the
    /// text only the name and arrays count. The table has one row and is valid until the next call; nullptr for a
    /// message that is not wanted, or is not usable and counted.
    const MessageTable* decode(double time_s, std::string_view message, std::span<const double> values = {});
    /// Another log begins: without a .log its messages may have other built-in definitions.
    void restart();

    /// Messages and values that could not be used, by reason.
    const Skipped& skipped() const { return skipped_; }
    const std::vector<AssumedDefinition>& assumed_definitions() const { return assumed_; }

  private:
    struct Message;

    std::vector<Message> messages_;
    std::vector<std::string_view> words_;  ///< of the last message: its memory is used again
    Skipped skipped_;
    std::vector<AssumedDefinition> assumed_;
};

/// Names of the messages in a .data text, with their counts, most frequent first: for explaining what a log
/// holds when it lacks what is wanted. Of more than a thousand names, the first thousand.
std::vector<std::pair<std::string, std::size_t>> count_messages(std::string_view text);

}  // namespace flightwatt::telemetry
