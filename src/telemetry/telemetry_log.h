#pragma once

#include "base/units.h"
#include "telemetry/log_configuration.h"
#include "telemetry/log_notes.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::telemetry {

/// A requested message and its fields; those that the log's definition has are read. "values[0]" is the first element
/// of an array, as a number without a unit.
struct MessageRequest {
    std::string message;
    std::vector<std::string> fields;
};

/// One field over time, in the base unit of its quantity. A value that is not a finite number is NaN (and counted), so
/// that the other fields of its row stay usable.
struct Column {
    std::string field;
    std::optional<units::Quantity> quantity;
    std::vector<double> values;
    bool is_integer = false;  ///< the log stores whole numbers; set for logs of other autopilots only
};

/// The rows of one message of one sender, in the order of the file.
struct MessageTable {
    std::string message;
    std::vector<double> time_s;
    std::vector<Column> columns;
    std::vector<std::size_t> places = {};  ///< line or byte of each row in the file, from 1, rising; may be empty

    bool empty() const { return time_s.empty(); }
    /// Returns the column of `field`; nullptr if the log's definition has none.
    const Column* column(std::string_view field) const;
};

/// The requested messages of one sender.
struct SenderLog {
    std::string id;
    std::vector<MessageTable> tables;

    /// Returns the table of `message`; nullptr if the sender sent none.
    const MessageTable* table(std::string_view message) const;
};

/// The requested messages of a log, in columns.
struct TelemetryLog {
    std::filesystem::path data_file;
    std::string flight;
    std::optional<LogConfiguration> configuration;  ///< absent without a .log
    std::vector<SenderLog> senders;                 ///< in the order of their first requested line
    std::vector<SkippedLines> skipped;
    std::vector<AssumedDefinition> assumed_definitions;  ///< assumptions as the .log or its units are missing
    std::size_t lines = 0;                               ///< number of lines in the file
};

/// Information in the log of another autopilot in addition to its messages.
struct LogFacts {
    std::map<std::string, std::string> information;  ///< ULog's, by key: "sys_uuid"
    std::map<std::string, double> parameters;
    std::vector<std::string> texts;       ///< messages to the user, at most a thousand
    std::size_t dropouts = 0;             ///< times at which ULog's logger lost data
    double dropout_s = 0.0;               ///< their total duration
    std::vector<std::string> notes = {};  ///< of the reader, for the user
};

/// A message of a log: its name, its number in the log, and its fields.
struct AutopilotMessage {
    std::string name;
    std::size_t count = 0;
    std::vector<std::string> fields;
};

/// The log of another autopilot.
struct AutopilotLog {
    TelemetryLog log = {};  ///< of one sender, with an empty id
    LogFacts facts = {};
    std::vector<AutopilotMessage> messages = {};  ///< all messages, the most frequent first
};

}  // namespace flightwatt::telemetry
