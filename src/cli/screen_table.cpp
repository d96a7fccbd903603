#include "cli/screen_table.h"

#include "base/csv.h"
#include "base/number.h"
#include "base/text.h"
#include "base/units.h"
#include "record/record.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

namespace flightwatt::cli {
namespace {

/// A cell of at most so many characters; of a longer one its beginning.
std::string shortened(const std::string& cell) {
    constexpr std::size_t max_characters = 40;
    if (character_count(cell) <= max_characters) return cell;
    std::size_t bytes = 0;
    for (std::size_t count = 0; count + 3 < max_characters; ++count)
        bytes += first_character(std::string_view(cell).substr(bytes)).bytes;
    return cell.substr(0, bytes) + "...";
}

std::size_t width_of(const TextTable& table, std::size_t column) {
    auto width = character_count(table.header[column]);
    for (const auto& row : table.rows) width = std::max(width, character_count(row[column]));
    return width;
}

/// The columns that are not empty and fit, chosen by importance, in the order of the table.
std::vector<std::size_t> columns_that_fit(const TextTable& table, std::size_t width,
                                          const std::vector<std::string>& first) {
    constexpr std::size_t gap = 2;  // blanks between columns
    std::vector<std::size_t> order(table.header.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(
        order, {}, [&](std::size_t column) { return std::ranges::find(first, table.header[column]) - first.begin(); });
    std::vector<std::size_t> columns;
    std::size_t used = 0;
    for (const auto column : order) {
        if (!table.rows.empty() && std::ranges::all_of(table.rows, [&](const auto& row) { return row[column] == "-"; }))
            continue;
        const auto needs = width_of(table, column) + (columns.empty() ? 0 : gap);
        if (!columns.empty() && used + needs > width) continue;
        used += needs;
        columns.push_back(column);
    }
    std::ranges::sort(columns);
    return columns;
}

/// The decimals of a column: by its unit, or enough for four digits.
std::string readable_cell(const std::string& cell, std::string_view column) {
    if (cell.empty()) return "-";
    const auto number = parse_number(cell);
    if (!number || !std::isfinite(*number)) return cell;
    constexpr int decimals_of_places = 5;  // a metre
    if (column.starts_with("latitude") || column.starts_with("longitude"))
        return fmt::format("{:.{}f}", *number, decimals_of_places);
    if (const auto* unit = unit_of_key(column)) return fmt::format("{:.{}f}", *number, unit->decimals);
    return cell.find_first_of(".eE") == std::string::npos ? cell : fmt::format("{:.4g}", *number);
}

/// The table of these columns.
TextTable selected(const TextTable& table, const std::vector<std::size_t>& columns) {
    TextTable shown{{}, std::vector<std::vector<std::string>>(table.rows.size())};
    for (const auto column : columns) {
        shown.header.push_back(table.header[column]);
        for (std::size_t i = 0; i < table.rows.size(); ++i) shown.rows[i].push_back(table.rows[i][column]);
    }
    return shown;
}

/// All columns in tables of the width, one below the other, each with the first column.
std::string split_text(const TextTable& table, std::size_t width) {
    constexpr std::size_t gap = 2;
    std::string text;
    std::vector<std::size_t> part{0};
    auto used = width_of(table, 0);
    for (std::size_t column = 1; column < table.header.size(); ++column) {
        const auto needs = gap + width_of(table, column);
        if (part.size() > 1 && used + needs > width) {
            text += to_text(selected(table, part)) + "\n";
            part = {0};
            used = width_of(table, 0);
        }
        used += needs;
        part.push_back(column);
    }
    return text + to_text(selected(table, part));
}

/// "duration" of "duration [s]" and "duration_s"; std::nullopt for other columns.
std::optional<std::string> name_of_time(const std::string& column) {
    constexpr std::string_view unit = " [s]";
    if (column.ends_with(unit)) return column.substr(0, column.size() - unit.size());
    if (column.ends_with("duration_s")) return column.substr(0, column.size() - 2);
    return std::nullopt;
}

/// The table with durations as people state them, "28 min 32 s", where one has a minute.
TextTable with_minutes(TextTable table) {
    for (std::size_t column = 0; column < table.header.size(); ++column) {
        const auto name = name_of_time(table.header[column]);
        const auto seconds = [&](const auto& row) { return parse_number(row[column]).value_or(0.0); };
        if (!name || std::ranges::none_of(table.rows,
                                          [&](const auto& row) { return seconds(row) >= units::seconds_per_minute; }))
            continue;
        table.header[column] = *name;
        for (auto& row : table.rows)
            if (parse_number(row[column])) row[column] = duration_text(seconds(row));
    }
    return table;
}

}  // namespace

Screen screen_of(const StageCall& call) { return {::isatty(STDOUT_FILENO) != 0, call.wide, terminal_columns(stdout)}; }

std::string screen_text(TextTable table, const Screen& screen, const ScreenTable& options) {
    if (!screen.is_terminal) return to_text(std::move(table));
    const auto rows = table.rows.size();
    if (options.max_rows > 0 && rows > options.max_rows) table.rows.resize(options.max_rows);
    table = with_minutes(std::move(table));
    auto first = options.first;
    for (auto& column : first)
        if (auto name = name_of_time(column); name && std::ranges::find(table.header, *name) != table.header.end())
            column = *name;
    auto text = options.title.empty() ? "" : wrapped(one_line(options.title), screen.columns) + "\n";
    if (screen.wide) {
        text += to_text(table);
    } else if (first.empty() && !table.header.empty()) {
        text += split_text(table, screen.columns);
    } else {
        for (auto& row : table.rows) std::ranges::transform(row, row.begin(), shortened);
        const auto columns = columns_that_fit(table, screen.columns, first);
        text += to_text(selected(table, columns));
        for (const auto column : columns) table.header[column].clear();
        std::erase(table.header, "");
        if (!table.header.empty())
            text += wrapped(fmt::format("not shown: {} (--wide shows all)", fmt::join(table.header, ", ")),
                            screen.columns) +
                    "\n";
    }
    const auto dropped = rows - table.rows.size();
    return dropped == 0 ? text : text + fmt::format("{} rows more, which -o FILE or a pipe gives\n", dropped);
}

TextTable readable_table(std::string_view csv) {
    const auto read = parse_csv(csv, "the result");
    TextTable table{read.columns, {}};
    table.rows.reserve(read.rows.size());
    for (const auto& row : read.rows) {
        auto& cells = table.rows.emplace_back();
        for (std::size_t i = 0; i < row.cells.size(); ++i)
            cells.push_back(readable_cell(row.cells[i].text, table.header[i]));
    }
    return table;
}

void write_csv_result(const StageCall& call, std::string_view csv, const ScreenTable& options) {
    write_csv_result(
        call, [csv](const TextSink& sink) { sink(csv); }, options);
}

void write_csv_result(const StageCall& call, const TextWriter& write_csv, const ScreenTable& options) {
    const auto screen = screen_of(call);
    if (call.output) return write_file_atomically(*call.output, write_csv);
    if (call.json) return;
    if (!screen.is_terminal) return write_csv([](std::string_view piece) { print(piece); });
    std::string csv;
    write_csv([&](std::string_view piece) { csv += piece; });
    print(screen_text(readable_table(csv), screen, options));
}

}  // namespace flightwatt::cli
