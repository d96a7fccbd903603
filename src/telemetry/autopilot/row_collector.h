#pragma once

#include "telemetry/message_dictionary.h"
#include "telemetry/telemetry_log.h"
#include "telemetry/text/skip_counter.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::telemetry {

/// The place, type and scale of a field in the bytes of a message.
struct LoggedField {
    std::string name;
    std::size_t offset = 0;
    WireType type = WireType::uint8;
    double factor = 1.0;

    /// Returns the field's value times its factor; NaN for text, and if the bytes end before it.
    double number(std::string_view bytes) const;
};

/// A message as a log defines it, and the columns into which its fields are read.
struct LoggedMessage {
    std::string name = {};
    std::size_t bytes = 0;  ///< size of the whole message
    std::vector<LoggedField> fields = {};
    std::optional<std::size_t> clock = {};  ///< index of the field with the time
    bool is_clock = false;                  ///< its times are used even if the message is not requested
    double ticks_per_s = 1e6;
    std::size_t count = 0;                                       ///< messages of this definition in the log
    std::optional<std::size_t> table = {};                       ///< index of its table, if it is requested
    std::vector<std::optional<std::size_t>> column_fields = {};  ///< the field of each column of the table

    /// Returns the index of a field; std::nullopt if the message has none of that name.
    std::optional<std::size_t> index_of(std::string_view field) const;
};

/// Collects the rows of the requested messages of a log that defines its own messages, in the order of the log. A jump
/// of the time is accepted only if the next row with a time confirms it; otherwise the row is damaged. Rows without a
/// time are spread evenly between the times around them, but not over a pause of the log.
class RowCollector {
  public:
    using ValueOf = std::function<double(std::size_t field)>;

    RowCollector(const std::filesystem::path& file, const std::vector<MessageRequest>& wanted);

    const std::filesystem::path& file() const { return file_; }
    /// Sets the table and the column fields of a message, if it is requested.
    void bind(LoggedMessage& message);
    /// Adds a row at `offset` (bytes, or line) if the message is requested. Its time is std::nullopt if the message has
    /// none, and NaN if it is damaged.
    void add(const LoggedMessage& message, std::optional<double> time_s, std::size_t offset, const ValueOf& value_of);
    /// Counts bytes (of text: lines) that are no message. Throws InputError if there are too many.
    void skip(std::size_t offset, std::size_t count);
    /// Returns the time of the last row; NaN before the first.
    double last_s() const { return last_s_; }
    /// Returns the tables with the rows added so far.
    std::vector<MessageTable>& tables() { return sender_.tables; }
    /// Ends the log: the last row is left out if its time is not confirmed, unless it is the only one.
    void end();
    /// Adds a message to the list of the log's messages, if the log has any of it.
    void list(const LoggedMessage& message);
    LogFacts& facts() { return result_.facts; }

    /// Returns the log, without tables that have no rows. Skipped input is counted in lines if `as_lines`, else in
    /// bytes. Throws InputError if no message has a time.
    AutopilotLog take(bool as_lines);

  private:
    struct Row {
        std::optional<std::size_t> table;
        double time_s;
        std::size_t offset;
        std::vector<double> values;
    };

    void append(const Row& row);
    void set_time(const Row& row);
    void drop_pending();
    void place_untimed(double next_s);
    void count_gap(double time_s);

    std::filesystem::path file_;
    AutopilotLog result_;
    SenderLog sender_;
    std::vector<std::vector<bool>> is_bound_;  ///< of each table's columns: some definition has it
    double last_s_ = std::numeric_limits<double>::quiet_NaN();
    std::vector<Row> untimed_;         ///< rows after the last row with a time
    std::optional<Row> pending_;       ///< row whose time is not confirmed yet
    std::vector<Row> behind_pending_;  ///< rows without a time after it
    double timed_s_ = 0.0;             ///< sum of the intervals between times, without pauses of the log
    double intervals_ = 0.0;           ///< number of intervals between rows in that time
    SkipCounter skips_;
    std::size_t gap_offset_ = 0;
    std::size_t gap_ = 0;  ///< bytes or lines skipped since the last row
    std::size_t skipped_ = 0;
    bool has_times_ = false;  ///< some message, requested or not, has a time
    std::size_t early_ = 0;   ///< rows before the first time
    std::size_t first_early_ = 0;
};

}  // namespace flightwatt::telemetry
