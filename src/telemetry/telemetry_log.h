#pragma once

#include "base/units.h"
#include "telemetry/log_configuration.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::telemetry {

/// A message that is wanted, and which of its fields (those that the flight's definition has are read).
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

/// Lines or values that could not be used, by reason and time. A line that has no time counts to the next one
/// that has: what stands behind the last message of a log has an infinite time.
struct SkippedLines {
    struct AtTime {
        double time_s = 0.0;
        std::size_t count = 0;
        std::size_t first_line = 0;
        bool operator==(const AtTime&) const = default;
    };
    std::string reason;
    std::vector<AtTime> lines;  ///< by time, which rises strictly

    std::size_t count() const;
    std::size_t first_line() const;  ///< 0 without any
    bool operator==(const SkippedLines&) const = default;
};

/// "ENERGY: another number of fields than the .log defines: 3 lines, first at line 17".
std::string describe(const SkippedLines& skipped);

/// A message layout that was assumed, for want of a .log, and since when it was needed.
struct AssumedDefinition {
    std::string text;  ///< "ENERGY: 2018 (6 fields)"
    double since_s = 0.0;
    bool operator==(const AssumedDefinition&) const = default;
};

struct TelemetryLog {
    std::filesystem::path data_file;
    std::string flight;
    std::optional<LogConfiguration> configuration;  ///< absent without a .log
    std::vector<SenderLog> senders;                 ///< in the order of their first wanted line
    std::vector<SkippedLines> skipped;
    std::vector<AssumedDefinition> assumed_definitions;  ///< where there was no .log
    std::size_t lines = 0;
};

/// Reads the wanted messages of a Paparazzi .data file with its .log (found beside it). Only these messages
/// are parsed. Throws InputError for a file that cannot be read or holds no telemetry line.
TelemetryLog read_telemetry(const std::filesystem::path& data_file,
                            const std::vector<MessageRequest>& wanted);

/// The same for a file whose text is in memory.
TelemetryLog read_telemetry(std::string_view text, const std::filesystem::path& data_file,
                            std::optional<LogConfiguration> configuration,
                            const std::vector<MessageRequest>& wanted);

/// The same for any text, which need not hold telemetry; `configuration` as in TelemetryLog.
TelemetryLog parse_telemetry(std::string_view text, const std::filesystem::path& data_file,
                             std::optional<LogConfiguration> configuration,
                             const std::vector<MessageRequest>& wanted);

/// Names of the messages in a .data text, with their counts, most frequent first: for explaining what a log
/// holds when it lacks what is wanted.
std::vector<std::pair<std::string, std::size_t>> census_of_messages(std::string_view text);

}  // namespace flightwatt::telemetry
