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

/// A field in the bytes of a message.
struct LoggedField {
    std::string name;
    std::size_t offset = 0;
    WireType type = WireType::uint8;
    double factor = 1.0;

    /// NaN for text, and where the bytes end before it.
    double number(std::string_view bytes) const;
};

/// A message as a log defines it, and where its fields go.
struct LoggedMessage {
    std::string name = {};
    std::size_t bytes = 0;  ///< of the whole message
    std::vector<LoggedField> fields = {};
    std::optional<std::size_t> clock = {};  ///< field of the time
    bool is_clock = false;                  ///< its times count although it is not requested
    double ticks_per_s = 1e6;
    std::size_t count = 0;
    std::optional<std::size_t> table = {};                       ///< of a requested message
    std::vector<std::optional<std::size_t>> column_fields = {};  ///< of each of its columns

    std::optional<std::size_t> index_of(std::string_view field) const;
};

/// The rows of the requested messages of a log that defines them, one after the other. A row whose time leaves the
/// clock of the rows around it is damaged: a jump counts only if the next row with a time confirms it. Rows without a
/// time are spread between the times around them, but not over a pause of the log.
class RowCollector {
  public:
    using ValueOf = std::function<double(std::size_t field)>;

    RowCollector(const std::filesystem::path& file, const std::vector<MessageRequest>& wanted);

    const std::filesystem::path& file() const { return file_; }
    /// Finds the table of a message, if it is requested.
    void bind(LoggedMessage& message);
    /// Adds a row at `offset` (bytes, or line) if the message is requested. Its time is std::nullopt if the message has
    /// none, and NaN if it is damaged.
    void add(const LoggedMessage& message, std::optional<double> time_s, std::size_t offset, const ValueOf& value_of);
    /// Counts bytes (of text: lines) that are no message. Throws InputError if there are too many.
    void skip(std::size_t offset, std::size_t count);
    /// The time of the last row; NaN before the first.
    double last_s() const { return last_s_; }
    /// The tables of the rows up to now.
    std::vector<MessageTable>& tables() { return sender_.tables; }
    /// Ends the last rows: one whose time nothing confirms is left out, unless it is the only one.
    void end();
    /// Lists a message, if the log has any.
    void list(const LoggedMessage& message);
    LogFacts& facts() { return result_.facts; }

    /// The log; tables without rows are removed. `as_lines`: the unit of what was skipped. Throws InputError if no
    /// message has a time.
    AutopilotLog take(bool as_lines);

  private:
    struct Row {
        std::optional<std::size_t> table;
        double time_s;
        std::size_t offset;
        std::vector<double> values;
    };

    void append(const Row& row);
    void set_time(Row row);
    void drop_pending();
    void place_untimed(double next_s);
    void count_gap(double time_s);

    std::filesystem::path file_;
    AutopilotLog result_;
    SenderLog sender_;
    std::vector<std::vector<bool>> is_bound_;  ///< of each table's columns: some definition has it
    double last_s_ = std::numeric_limits<double>::quiet_NaN();
    std::vector<Row> untimed_;         ///< behind the last time
    std::optional<Row> pending_;       ///< its time is not confirmed
    std::vector<Row> behind_pending_;  ///< without a time
    double timed_s_ = 0.0;             ///< between times of a log that does not pause
    double intervals_ = 0.0;           ///< of all rows in that time
    SkipCounter skips_;
    std::size_t gap_offset_ = 0;
    std::size_t gap_ = 0;  ///< skipped since the last row
    std::size_t skipped_ = 0;
    bool has_times_ = false;  ///< some message has, requested or not
    std::size_t early_ = 0;   ///< rows before the first time
    std::size_t first_early_ = 0;
};

}  // namespace flightwatt::telemetry
