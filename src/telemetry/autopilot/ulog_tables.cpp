#include "telemetry/autopilot/ulog_tables.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "telemetry/autopilot/ulog_table_name.h"
#include "telemetry/text/lines.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::telemetry {
namespace {

/// One table: the fields that are read, of each row.
struct UlogTable {
    LoggedMessage message = {};
    std::vector<double> time_us = {};
    std::vector<std::size_t> lines = {};
    std::vector<std::vector<double>> values = {};  ///< of those of message.column_fields that it has
    std::size_t next = 0;
};

UlogTable read_table(std::string_view text, const std::string& topic, double instance, const std::string& file,
                     RowCollector& rows) {
    UlogTable table;
    auto& message = table.message;
    message.name = topic;
    message.fields.push_back({"multi_id", 0, WireType::float64});
    const auto read = [&](const CsvRowView& row) {
        if (!message.clock) {
            for (const auto& cell : row.cells) message.fields.push_back({std::string(cell.text), 0, WireType::float64});
            message.clock = message.index_of("timestamp");
            if (!message.clock) throw InputError({file, row.line}, "has no column 'timestamp'", "is it by ulog2csv?");
            return rows.bind(message);
        }
        ++message.count;
        const double time_us = number_or_nan(row.cells[*message.clock - 1].text);
        if (std::isnan(time_us)) return rows.skip(row.line - 1, 1);
        if (time_us == 0.0) return;  // never published
        table.time_us.push_back(time_us);
        table.lines.push_back(row.line);
        auto& values = table.values.emplace_back();
        for (const auto& field : message.column_fields)
            if (field) values.push_back(*field == 0 ? instance : number_or_nan(row.cells[*field - 1].text));
    };
    const auto dialect = find_csv_header(text, file, {"timestamp"}).dialect;
    for_each_csv_row(text, file, read, with_decimals(dialect, text, file));
    return table;
}

}  // namespace

bool are_ulog_tables(std::string_view text) { return text.starts_with(ulog_table_marker); }

void read_ulog_tables(std::string_view text, RowCollector& rows) {
    std::vector<UlogTable> tables;
    std::map<std::string, LoggedMessage> listed;
    while (are_ulog_tables(text)) {
        auto head = text.substr(ulog_table_marker.size(), text.find('\n') - ulog_table_marker.size());
        text.remove_prefix(ulog_table_marker.size() + head.size() + 1);
        const auto next = text.find(fmt::format("\n{}", ulog_table_marker));
        const auto end = are_ulog_tables(text) ? 0 : next == std::string_view::npos ? text.size() : next + 1;
        const auto topic = std::string(take_word(head));
        const auto instance = number_or_nan(take_word(head));
        tables.push_back(read_table(text.substr(0, end), topic, instance, std::string(head), rows));
        text.remove_prefix(end);
        const auto [known, is_new] = listed.try_emplace(topic, tables.back().message);
        if (!is_new) known->second.count += tables.back().message.count;
    }
    const auto is_left = [](const UlogTable& table) { return table.next < table.time_us.size(); };
    std::vector<UlogTable*> left;
    for (auto& table : tables)
        if (is_left(table)) left.push_back(&table);
    while (!left.empty()) {
        const auto first =
            std::ranges::min_element(left, {}, [](const auto* table) { return table->time_us[table->next]; });
        auto& table = **first;
        const auto row = table.next++;
        std::size_t column = 0;
        rows.add(table.message, table.time_us[row] / table.message.ticks_per_s, table.lines[row],
                 [&](std::size_t) { return table.values[row][column++]; });
        if (!is_left(table)) left.erase(first);
    }
    for (const auto& [topic, message] : listed) rows.list(message);
}

}  // namespace flightwatt::telemetry
