#include "telemetry/autopilot/ulog_tables.h"

#include "base/csv_dialect.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/number.h"
#include "telemetry/autopilot/ulog_table_name.h"
#include "telemetry/autopilot_log.h"
#include "telemetry/data_file.h"
#include "telemetry/text/lines.h"

#include <algorithm>
#include <limits>
#include <map>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::telemetry {
namespace {

constexpr std::string_view table_marker = "# ulog2csv ";  // and topic, instance, file
constexpr std::size_t max_instances = 16;

std::string table_name(std::string_view log, std::string_view topic, std::size_t instance) {
    return fmt::format("{}_{}_{}", log, topic, instance);
}

/// The table that represents a log; std::nullopt if there is none.
std::optional<std::filesystem::path> representative_of(const std::filesystem::path& folder, std::string_view log) {
    for (const auto* topic : representative_topics) {
        for (std::size_t i = 0; i < max_instances; ++i) {
            auto file = folder / (table_name(log, topic, i) + ".csv");
            std::error_code none;
            if (std::filesystem::is_regular_file(file, none)) return file;
        }
    }
    return std::nullopt;
}

/// One table: the fields that are read, of each row.
struct UlogTable {
    LoggedMessage message = {};
    std::vector<double> time_us = {};
    std::vector<std::size_t> lines = {};
    std::vector<std::vector<double>> values = {};  ///< of message.column_fields
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
        if (time_us == 0.0) return;  // never published
        table.time_us.push_back(time_us);
        table.lines.push_back(row.line);
        auto& values = table.values.emplace_back();
        for (const auto& field : message.column_fields)
            values.push_back(!field        ? std::numeric_limits<double>::quiet_NaN()
                             : *field == 0 ? instance
                                           : number_or_nan(row.cells[*field - 1].text));
    };
    for_each_csv_row(text, file, read, find_csv_header(text, file, {"timestamp"}).dialect);
    return table;
}

}  // namespace

bool are_ulog_tables(std::string_view text) { return text.starts_with(table_marker); }

void read_ulog_tables(std::string_view text, RowCollector& rows) {
    std::vector<UlogTable> tables;
    std::map<std::string, LoggedMessage> listed;
    while (are_ulog_tables(text)) {
        auto head = text.substr(table_marker.size(), text.find('\n') - table_marker.size());
        text.remove_prefix(table_marker.size() + head.size() + 1);
        const auto end = std::min(text.find(fmt::format("\n{}", table_marker)), text.size() - 1) + 1;
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
        // Its fields are the requested ones, in their order.
        std::size_t column = 0;
        rows.add(table.message, table.time_us[row] / table.message.ticks_per_s, table.lines[row],
                 [&](std::size_t) { return table.values[row][column++]; });
        if (!is_left(table)) left.erase(first);
    }
    for (const auto& [topic, message] : listed) rows.list(message);
}

std::optional<std::filesystem::path> ulog_tables_of(const std::filesystem::path& file) {
    const auto name = file.stem().string();
    const auto mark = instance_mark(name);
    if (file.extension() != ".csv" || mark == std::string::npos || mark == 0) return std::nullopt;
    for (auto at = name.rfind('_', mark - 1); at != std::string::npos && at > 0; at = name.rfind('_', at - 1)) {
        auto log = representative_of(file.parent_path(), std::string_view(name).substr(0, at));
        if (log && beginning_of_file(file).starts_with("timestamp")) return log;
    }
    return std::nullopt;
}

std::string join_ulog_tables(const std::filesystem::path& file, const std::vector<MessageRequest>& wanted,
                             std::size_t max_bytes) {
    const auto log = without_topic(file.stem().string());
    std::string text;
    for (const auto& [topic, fields] : wanted) {
        for (std::size_t i = 0; i < max_instances; ++i) {
            const auto table = file.parent_path() / (table_name(log, topic, i) + ".csv");
            std::error_code none;
            if (!std::filesystem::is_regular_file(table, none)) continue;
            text += fmt::format("{}{} {} {}\n", table_marker, topic, i, table.string());
            text += read_file(table, max_bytes - std::min(max_bytes, text.size()), "--max-log-mb raises the limit");
            if (!text.ends_with('\n')) text += '\n';
        }
    }
    return text;
}

}  // namespace flightwatt::telemetry
