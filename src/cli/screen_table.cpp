#include "cli/screen_table.h"

#include "base/csv.h"
#include "base/duration_text.h"
#include "base/number.h"
#include "base/text.h"
#include "record/record.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/join.hpp>
#include <boost/algorithm/string/split.hpp>
#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

/// Columns of durations are in minutes, in a table for people; so are moments since a mission began.
bool is_duration(std::string_view column) {
    constexpr std::array<std::string_view, 8> others{"depleted_at_s", "cut_off_at_s", "empty at [s]", "cut off at [s]",
                                                     "planned s",     "flown s",      "take-off s",   "landing s"};
    if (column == "cruise s" || column == "duration [s]") return true;
    return (column.starts_with("duration") && column.ends_with("_s")) || std::ranges::count(others, column) > 0;
}

/// The first `count` characters of `text`, in bytes.
std::size_t bytes_of_characters(std::string_view text, std::size_t count) {
    std::size_t at = 0;
    while (at < text.size() && count > 0) {
        ++at;
        while (at < text.size() && continues_character(text[at])) ++at;
        --count;
    }
    return at;
}

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    boost::split(words, text, boost::is_any_of(" "), boost::token_compress_on);
    std::erase(words, "");
    return words;
}

/// Text in lines of at most `width` characters, broken between words, and within one that is longer (after an
/// underscore, a slash or a hyphen, where it has one).
std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
    std::vector<std::string> lines;
    std::string line;
    const auto end_line = [&] {
        if (!line.empty()) lines.push_back(line);
        line.clear();
    };
    for (std::string word : words_of(text)) {
        if (!line.empty() && character_count(line) + 1 + character_count(word) > width) end_line();
        if (!line.empty()) line += ' ';
        while (character_count(line) + character_count(word) > width) {
            end_line();
            auto cut = bytes_of_characters(word, width);
            const auto joint = std::string_view(word).substr(0, cut).find_last_of("_/-");
            if (joint != std::string_view::npos && joint > 0) cut = joint + 1;
            lines.push_back(word.substr(0, cut));
            word.erase(0, cut);
        }
        line += word;
    }
    end_line();
    if (lines.empty()) lines.emplace_back();
    return lines;
}

/// A column as it is shown.
struct ShownColumn {
    std::size_t index = 0;
    std::string name;  ///< words of the head
    std::string unit;  ///< below them, or empty
    bool is_text = false;
    std::size_t min_width = 0;  ///< characters
    std::size_t natural = 0;    ///< characters of its widest cell and head
    std::size_t width = 0;
};

bool is_number_like(std::string_view cell) {
    return !cell.empty() && (std::isdigit(static_cast<unsigned char>(cell.front())) != 0 || cell.front() == '-' ||
                             cell.front() == '+' || cell == "nan");
}

constexpr std::size_t text_wraps_from = 24;  ///< characters: names of flights and missions stay on one line

ShownColumn shown_column(const TextTable& table, std::size_t index) {
    ShownColumn column;
    column.index = index;
    std::string_view head = table.header[index];
    if (const auto* unit = unit_of_key(head); unit != nullptr && head.find(' ') == std::string_view::npos) {
        head.remove_suffix(unit->suffix.size());
        if (!is_duration(table.header[index])) column.unit = std::string(unit->unit);
    }
    for (const std::string_view seconds : {" s", " [s]"})
        if (is_duration(table.header[index]) && head.ends_with(seconds)) head.remove_suffix(seconds.size());
    column.name = std::string(head);
    std::ranges::replace(column.name, '_', ' ');
    std::size_t widest = character_count(column.unit);
    std::size_t numbers = 0;
    for (const auto& row : table.rows) {
        widest = std::max(widest, character_count(row[index]));
        if (row[index].empty() || is_number_like(row[index])) ++numbers;
    }
    column.is_text = numbers * 2 < table.rows.size() || table.rows.empty();
    std::size_t max_word = 0;
    for (const auto& word : words_of(column.name)) max_word = std::max(max_word, character_count(word));
    column.natural = std::max(widest, max_word);
    column.min_width = column.is_text ? std::max(std::min(widest, text_wraps_from), max_word) : column.natural;
    return column;
}

/// Indices of the columns, the most important first.
std::vector<std::size_t> by_importance(const TextTable& table, const std::vector<std::string>& first) {
    std::vector<std::size_t> order;
    for (const auto& name : first) {
        const auto found = std::ranges::find(table.header, name);
        if (found != table.header.end()) order.push_back(static_cast<std::size_t>(found - table.header.begin()));
    }
    for (std::size_t i = 0; i < table.header.size(); ++i)
        if (std::ranges::find(order, i) == order.end()) order.push_back(i);
    return order;
}

constexpr std::size_t gap = 2;  ///< blanks between columns

bool is_empty_column(const TextTable& table, std::size_t index) {
    return std::ranges::all_of(table.rows, [&](const auto& row) { return row[index].empty() || row[index] == "-"; });
}

/// The columns that fit, each with its width, in the order of the table.
std::vector<ShownColumn> columns_that_fit(const TextTable& table, const Screen& screen, const ScreenTable& options) {
    std::vector<ShownColumn> columns;
    std::size_t used = 0;
    for (const auto index : by_importance(table, options.first)) {
        auto column = shown_column(table, index);
        if (!screen.wide && !table.rows.empty() && is_empty_column(table, index)) continue;
        const auto needs = column.min_width + (columns.empty() ? 0 : gap);
        if (!screen.wide && !columns.empty() && used + needs > screen.columns) continue;
        column.width = screen.wide ? column.natural : std::min(column.min_width, screen.columns);
        used += needs;
        columns.push_back(std::move(column));
    }
    for (auto& column : columns) {  // the remaining width goes to texts, the important ones first
        if (screen.wide || !column.is_text || used >= screen.columns) continue;
        const auto more = std::min(column.natural - std::min(column.natural, column.width), screen.columns - used);
        column.width += more;
        used += more;
    }
    std::ranges::sort(columns, {}, &ShownColumn::index);
    return columns;
}

/// The cells of a row, each in lines of its column's width.
std::vector<std::string> wrapped_cells(const std::vector<std::string>& row, const std::vector<ShownColumn>& columns) {
    std::vector<std::string> cells;
    cells.reserve(columns.size());
    for (const auto& column : columns)
        cells.push_back(boost::algorithm::join(wrapped(one_line(row[column.index]), column.width), "\n"));
    return cells;
}

/// The words of each head at its bottom, the units below.
std::vector<std::string> head_cells(const std::vector<ShownColumn>& columns) {
    std::vector<std::string> cells;
    std::ptrdiff_t height = 0;
    cells.reserve(columns.size());
    for (const auto& column : columns) {
        cells.push_back(boost::algorithm::join(wrapped(column.name, column.width), "\n"));
        height = std::max(height, std::ranges::count(cells.back(), '\n'));
    }
    const bool has_units = std::ranges::any_of(columns, [](const auto& column) { return !column.unit.empty(); });
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const auto missing = static_cast<std::size_t>(height - std::ranges::count(cells[i], '\n'));
        cells[i] = std::string(missing, '\n') + cells[i] + (has_units ? "\n" + columns[i].unit : "");
    }
    return cells;
}

/// Numbers of rows shown before and after those left out in the middle.
struct ShownRows {
    std::size_t before = 0;
    std::size_t after = 0;
};

ShownRows shown_rows(std::size_t rows, const ScreenTable& options) {
    if (options.max_rows == 0 || rows <= options.max_rows) return {rows, 0};
    return {options.max_rows - options.max_rows / 3, options.max_rows / 3};
}

/// The names of the columns that are not shown.
std::string left_out_text(const TextTable& table, const std::vector<ShownColumn>& columns, const Screen& screen) {
    std::vector<std::string> no_room;
    std::vector<std::string> empty;
    for (std::size_t i = 0; i < table.header.size(); ++i) {
        if (std::ranges::find(columns, i, &ShownColumn::index) != columns.end()) continue;
        (is_empty_column(table, i) ? empty : no_room).push_back(table.header[i]);
    }
    std::string text;
    const auto add = [&](const char* what, const std::vector<std::string>& names, const char* more) {
        if (names.empty()) return;
        for (const auto& line : wrapped(what + boost::algorithm::join(names, ", ") + more, screen.columns))
            text += line + "\n";
    };
    add("left out: ", no_room, " (--wide shows all)");
    add("empty: ", empty, "");
    return text;
}

/// The decimals of a column: by its unit, or enough for four digits of the largest number.
std::string readable_cell(const std::string& cell, std::string_view column) {
    const auto number = parse_number(cell);
    if (!number || !std::isfinite(*number)) return cell;
    if (is_duration(column)) return cell;  // in minutes when it is shown
    const bool is_place = column.starts_with("latitude") || column.starts_with("longitude");
    constexpr int decimals_of_places = 5;  // a metre
    if (is_place) return fmt::format("{:.{}f}", *number, decimals_of_places);
    if (const auto* unit = unit_of_key(column)) return fmt::format("{:.{}f}", *number, unit->decimals);
    if (cell.find_first_of(".eE") == std::string::npos) return cell;
    return fmt::format("{:.4g}", *number);
}

TextTable with_minutes(TextTable table) {
    for (std::size_t i = 0; i < table.header.size(); ++i) {
        if (!is_duration(table.header[i])) continue;
        for (auto& row : table.rows)
            if (const auto number = parse_number(row[i])) row[i] = duration_text(*number);
    }
    return table;
}

}  // namespace

Screen screen_of(const StageCall& call) {
    const auto ability = standard_output_ability();
    return {ability.is_terminal, call.wide, ability.columns};
}

std::string screen_text(TextTable whole, const Screen& screen, const ScreenTable& options) {
    if (!screen.is_terminal) return to_text(std::move(whole));
    const auto table = with_minutes(std::move(whole));
    const auto columns = columns_that_fit(table, screen, options);
    std::vector<std::vector<std::string>> rows{head_cells(columns)};
    std::vector<bool> right;
    right.reserve(columns.size());
    for (const auto& column : columns) right.push_back(!column.is_text);
    const auto [before, after] = shown_rows(table.rows.size(), options);
    for (std::size_t r = 0; r < before; ++r) rows.push_back(wrapped_cells(table.rows[r], columns));
    const auto left_out = table.rows.size() - before - after;
    if (left_out > 0) rows.emplace_back(columns.size(), "...");
    for (auto r = before + left_out; r < table.rows.size(); ++r) rows.push_back(wrapped_cells(table.rows[r], columns));
    std::string text;
    if (!options.title.empty())
        text = boost::algorithm::join(wrapped(one_line(options.title), screen.columns), "\n") + "\n";
    text += aligned_text(rows, right);
    if (left_out > 0) text += fmt::format("...: {} rows more, which -o FILE or a pipe gives\n", left_out);
    return text + left_out_text(table, columns, screen);
}

TextTable readable_table(std::string_view csv) {
    const auto read = parse_csv(csv, "the result");
    TextTable table{read.columns, {}};
    table.rows.reserve(read.rows.size());
    for (const auto& row : read.rows) {
        auto& cells = table.rows.emplace_back();
        cells.reserve(row.cells.size());
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
