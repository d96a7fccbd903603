#include "base/text_table.h"

#include "base/csv.h"
#include "base/number.h"
#include "base/text.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include <boost/algorithm/string/replace.hpp>
#include <boost/algorithm/string/split.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt {
namespace {

/// The ends of "0.5 to 2".
std::optional<std::pair<std::string_view, std::string_view>> interval_ends(std::string_view cell) {
    constexpr std::string_view between_ends = " to ";
    const auto split = cell.find(between_ends);
    if (split == std::string_view::npos) return std::nullopt;
    const auto low = cell.substr(0, split);
    const auto high = cell.substr(split + between_ends.size());
    if (!parse_number(low) || !parse_number(high)) return std::nullopt;
    return std::pair(low, high);
}

bool is_numeric_column(const TextTable& table, std::size_t column) {
    return std::ranges::all_of(table.rows, [&](const auto& row) {
        std::string_view cell = row[column];
        if (!cell.empty() && (cell.back() == '%' || cell.back() == '*')) cell.remove_suffix(1);
        return cell.empty() || cell == "-" || parse_number(cell).has_value() || interval_ends(cell).has_value();
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

/// How LaTeX spells an ASCII character that it would read otherwise; empty for those without a special meaning. '[' and
/// '*' behind the end of a row would be that command's.
std::string_view latex_of(char c) {
    static const std::map<char, std::string_view> spelt{{'\\', "\\textbackslash{}"},
                                                        {'~', "\\textasciitilde{}"},
                                                        {'^', "\\textasciicircum{}"},
                                                        {'<', "\\textless{}"},
                                                        {'>', "\\textgreater{}"},
                                                        {'|', "\\textbar{}"},
                                                        {'"', "{\\char34}"},
                                                        {'[', "{[}"},
                                                        {'*', "{*}"},
                                                        {'&', "\\&"},
                                                        {'%', "\\%"},
                                                        {'$', "\\$"},
                                                        {'#', "\\#"},
                                                        {'_', "\\_"},
                                                        {'{', "\\{"},
                                                        {'}', "\\}"}};
    const auto found = spelt.find(c);
    return found == spelt.end() ? std::string_view() : found->second;
}

std::string latex_cell(std::string_view cell) {
    if (cell == "-") return "--";
    if (const auto ends = interval_ends(cell))
        return fmt::format("$[{},\\, {}]$", latex_number(ends->first), latex_number(ends->second));
    return parse_number(cell) ? fmt::format("${}$", latex_number(cell)) : latex_escaped(cell);
}

std::vector<std::string> lines_of(const std::string& cell) {
    std::vector<std::string> lines;
    return boost::split(lines, cell, [](char c) { return c == '\n'; });
}

}  // namespace

std::string fixed(const std::optional<double>& number, int decimals) {
    return number ? fmt::format("{:.{}f}", *number, decimals) : "-";
}

std::string aligned_text(const std::vector<std::vector<std::string>>& rows, const std::vector<bool>& right) {
    std::vector<std::vector<std::vector<std::string>>> lines;  // of each cell
    std::vector<std::size_t> widths(right.size(), 0);
    for (const auto& row : rows) {
        auto& cells = lines.emplace_back();
        for (std::size_t i = 0; i < row.size(); ++i) {
            cells.push_back(lines_of(row[i]));
            for (const auto& line : cells.back()) widths[i] = std::max(widths[i], character_count(line));
        }
    }
    std::string text;
    for (const auto& cells : lines) {
        std::size_t height = 1;
        for (const auto& cell : cells) height = std::max(height, cell.size());
        for (std::size_t k = 0; k < height; ++k) {
            std::string line;
            for (std::size_t i = 0; i < cells.size(); ++i) {
                const auto part = k < cells[i].size() ? cells[i][k] : "";
                const std::string blanks(widths[i] - character_count(part), ' ');
                line += (i > 0 ? "  " : "") + (right[i] ? blanks + part : part + blanks);
            }
            text += line.erase(line.find_last_not_of(' ') + 1) + '\n';
        }
    }
    return text;
}

std::string to_text(TextTable raw) {
    auto table = without_controls(std::move(raw));
    std::vector<bool> right;
    for (std::size_t column = 0; column < table.header.size(); ++column)
        right.push_back(is_numeric_column(table, column));
    table.rows.insert(table.rows.begin(), table.header);
    return aligned_text(table.rows, right);
}

std::string to_markdown(TextTable raw) {
    const auto table = without_controls(std::move(raw));
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
    auto text = csv_line(table.header);
    for (const auto& row : table.rows) text += csv_line(row);
    return text;
}

std::string latex_escaped(std::string_view text) {
    constexpr char32_t first_latin = 0xA0;
    constexpr char32_t last_latin = 0x17F;
    constexpr char32_t fixed_hyphen = 0x2011;
    constexpr char32_t plus_minus = 0xB1;
    std::string result;
    while (!text.empty()) {
        const auto [code, bytes] = first_character(text);
        const char c = text.front();
        if (code == plus_minus) {
            result += "$\\pm$";
        } else if (code >= first_latin && code <= last_latin) {
            result += text.substr(0, bytes);
        } else if (code == fixed_hyphen) {
            result += '-';
        } else if (code > 0x7E || code < 0x20) {
            result += code == '\t' || code == '\n' ? ' ' : '?';
        } else if (c == '^' && text.size() > 1 && text[1] >= '0' && text[1] <= '9') {  // of a unit: m/s^2
            result += fmt::format("$^{}$", text[1]);
            text.remove_prefix(1);
        } else {
            const auto spelt = latex_of(c);
            result += spelt.empty() ? std::string_view(&c, 1) : spelt;
        }
        text.remove_prefix(bytes);
    }
    return result;
}

std::string latex_number(std::string_view number) {
    const auto e = number.find('e');
    if (e == std::string_view::npos) return std::string(number);
    const auto exponent = parse_number(number.substr(e + (number.substr(e + 1).starts_with('+') ? 2 : 1)));
    return fmt::format("{} \\times 10^{{{:g}}}", number.substr(0, e), exponent.value_or(0.0));
}

std::string to_latex(const TextTable& table, std::string_view caption, std::string_view label) {
    std::string columns;
    for (std::size_t column = 0; column < table.header.size(); ++column)
        columns += is_numeric_column(table, column) ? 'r' : 'l';
    auto text = fmt::format(
        "% needs \\usepackage{{booktabs}}\n\\begin{{table}}\n\\centering\n\\caption{{{}}}\n\\label{{{}}}\n"
        "\\begin{{tabular}}{{{}}}\n\\toprule\n",
        latex_escaped(caption), label, columns);
    const auto add_line = [&](std::vector<std::string> row, const auto& cell) {
        std::ranges::transform(row, row.begin(), cell);
        text += fmt::format("{} \\\\\n", fmt::join(row, " & "));
    };
    add_line(table.header, latex_escaped);
    text += "\\midrule\n";
    for (const auto& row : table.rows) add_line(row, latex_cell);
    return text + "\\bottomrule\n\\end{tabular}\n\\end{table}\n";
}

}  // namespace flightwatt
