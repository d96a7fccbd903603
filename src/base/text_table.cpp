#include "base/text_table.h"

#include "base/csv.h"
#include "base/number.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt {
namespace {

std::size_t width_of(std::string_view text) {
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

bool is_numeric_column(const TextTable& table, std::size_t column) {
    return std::ranges::all_of(table.rows, [&](const auto& row) {
        std::string_view cell = row[column];
        if (!cell.empty() && (cell.back() == '%' || cell.back() == '*')) cell.remove_suffix(1);
        return cell.empty() || cell == "-" || parse_number(cell).has_value();
    });
}

/// A name may hold a line break or a tab: in a table it must not.
TextTable without_controls(TextTable table) {
    const auto clean = [](std::vector<std::string>& cells) {
        for (auto& cell : cells) {
            std::ranges::replace_if(
                cell, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
        }
    };
    clean(table.header);
    for (auto& row : table.rows) clean(row);
    return table;
}

std::string padded(const std::string& cell, std::size_t width, bool right) {
    const std::string blanks(width - std::min(width, width_of(cell)), ' ');
    return right ? blanks + cell : cell + blanks;
}

}  // namespace

std::string fixed(const std::optional<double>& number, int decimals) {
    return number ? fmt::format("{:.{}f}", *number, decimals) : "-";
}

std::string to_text(const TextTable& raw) {
    const auto table = without_controls(raw);
    std::vector<std::size_t> widths;
    std::vector<bool> right;
    for (std::size_t column = 0; column < table.header.size(); ++column) {
        std::size_t width = width_of(table.header[column]);
        for (const auto& row : table.rows) width = std::max(width, width_of(row[column]));
        widths.push_back(width);
        right.push_back(is_numeric_column(table, column));
    }
    std::string text;
    const auto add_row = [&](const std::vector<std::string>& row) {
        std::string line;
        for (std::size_t column = 0; column < row.size(); ++column) {
            if (column > 0) line += "  ";
            line += padded(row[column], widths[column], right[column]);
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + '\n';
    };
    add_row(table.header);
    for (const auto& row : table.rows) add_row(row);
    return text;
}

std::string to_markdown(const TextTable& raw) {
    const auto table = without_controls(raw);
    std::string text;
    const auto add_row = [&](const std::vector<std::string>& row) {
        text += '|';
        for (const auto& cell : row) text += ' ' + boost::replace_all_copy(cell, "|", "\\|") + " |";
        text += '\n';
    };
    add_row(table.header);
    text += '|';
    for (std::size_t column = 0; column < table.header.size(); ++column) {
        text += is_numeric_column(table, column) ? "---:|" : "---|";
    }
    text += '\n';
    for (const auto& row : table.rows) add_row(row);
    return text;
}

std::string to_csv(const TextTable& table) {
    const auto line_of = [](const std::vector<std::string>& row) {
        std::vector<std::string> cells;
        std::ranges::transform(row, std::back_inserter(cells), csv_cell);
        return fmt::format("{}\n", fmt::join(cells, ","));
    };
    auto text = line_of(table.header);
    for (const auto& row : table.rows) text += line_of(row);
    return text;
}

}  // namespace flightwatt
