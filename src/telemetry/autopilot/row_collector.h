#pragma once

#include "telemetry/autopilot_data.h"
#include "telemetry/text/skip_counter.h"

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::telemetry {

/// Where a layout of a message has the columns of its table.
template <typename Source>
struct RowBinding {
    std::size_t table = 0;
    std::vector<std::optional<Source>> columns;
};

/// The rows of the wanted messages of a log that defines them, one after the other. A row whose time leaves the clock of
/// the rows around it is damaged: a jump counts only if the next row confirms it.
class RowCollector {
  public:
    RowCollector(const std::filesystem::path& file, const std::vector<MessageRequest>& wanted);

    bool wants(std::string_view message) const { return request_of(message) != nullptr; }
    const std::filesystem::path& file() const { return file_; }

    /// Binds a layout: find(field) is its Source, if the layout has it. std::nullopt if the message is not wanted.
    template <typename Source, typename Find>
    std::optional<RowBinding<Source>> bind(std::string_view message, const Find& find) {
        const auto* request = request_of(message);
        if (request == nullptr) return std::nullopt;
        RowBinding<Source> binding{table_of(message), {}};
        for (const auto& field : request->fields)
            if (find(field)) add_column(binding.table, field);
        for (const auto& column : sender_.tables[binding.table].columns) binding.columns.push_back(find(column.field));
        return binding;
    }

    /// Adds a row at `offset` (bytes, or line); value_of(source) is a number or NaN.
    template <typename Source, typename ValueOf>
    void add(const RowBinding<Source>& binding, double time_s, std::size_t offset, const ValueOf& value_of) {
        Row row{binding.table, time_s, offset, {}};
        row.values.reserve(binding.columns.size());
        for (const auto& source : binding.columns)
            row.values.push_back(source ? value_of(*source) : std::numeric_limits<double>::quiet_NaN());
        add(std::move(row));
    }

    /// Counts bytes (of text: lines) that are no message. Throws InputError if there are too many.
    void skip(std::size_t offset, std::size_t count);
    /// The time of the last row; NaN before the first.
    double last_s() const { return last_s_; }

    /// The tables after the last row; a row whose time nothing confirms is left out, unless it is the only one.
    std::vector<MessageTable>& end();
    LogFacts facts;

    /// The log; tables without rows are removed. `as_lines`: the unit of what was skipped.
    AutopilotLog take(bool as_lines);

  private:
    struct Row {
        std::size_t table;
        double time_s;
        std::size_t offset;
        std::vector<double> values;
    };

    const MessageRequest* request_of(std::string_view message) const;
    std::size_t table_of(std::string_view message);
    void add_column(std::size_t table, const std::string& field);
    void add(Row row);
    void append(const Row& row);
    void drop(const std::optional<Row>& row);
    void count_gap(double time_s);

    std::filesystem::path file_;
    std::vector<MessageRequest> wanted_;
    SenderLog sender_;
    double last_s_ = std::numeric_limits<double>::quiet_NaN();
    std::optional<Row> pending_;  ///< its time is not confirmed
    SkipCounter skips_;
    std::size_t gap_offset_ = 0;
    std::size_t gap_ = 0;  ///< skipped since the last row
    std::size_t skipped_ = 0;
    std::size_t untimed_ = 0;  ///< rows before the first time
};

}  // namespace flightwatt::telemetry
