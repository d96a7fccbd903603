#include "base/number.h"
#include "mechanical/table_one.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// Text in which TeX's own characters stand for themselves.
std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (std::string_view("&%$#_{}").find(c) != std::string_view::npos) result += '\\';
        if (c == '\\')
            result += "\\textbackslash{}";
        else if (c == '~')
            result += "\\textasciitilde{}";
        else if (c == '^')
            result += "\\textasciicircum{}";
        else
            result += c;
    }
    return result;
}

/// "1.5e-05" as 1.5 \times 10^{-5}, for mathematical mode.
std::string number_text(std::string_view text) {
    const auto e = text.find('e');
    if (e == std::string_view::npos) return std::string(text);
    const auto exponent = parse_number(text.substr(e + 1));
    return fmt::format("{} \\times 10^{{{:g}}}", text.substr(0, e), exponent.value_or(0.0));
}

bool is_half_width(std::string_view heading) { return heading.ends_with("+-"); }

std::string cell(std::string_view text, std::string_view heading) {
    if (text == "-") return "--";
    if (!parse_number(text)) return escaped(text);
    return fmt::format("${}{}$", is_half_width(heading) ? "\\pm " : "", number_text(text));
}

/// a0 as $a_0$, xi as $\xi$; other rows as they are called.
std::string row_name(std::string_view name) {
    if (name == "xi") return "$\\xi$";
    const bool coefficient =
        name.size() > 1 && (name[0] == 'a' || name[0] == 'b') &&
        std::all_of(name.begin() + 1, name.end(), [](char c) { return c >= '0' && c <= '9'; });
    return coefficient ? fmt::format("${}_{{{}}}$", name[0], name.substr(1)) : escaped(name);
}

/// A heading of two words on two lines: numbers are narrower than "take-off regenerated".
std::string heading_cell(std::string_view heading) {
    if (is_half_width(heading)) return "";
    const auto space = heading.rfind(' ');
    if (space == std::string_view::npos) return escaped(heading);
    return fmt::format("\\shortstack[r]{{{}\\\\{}}}", escaped(heading.substr(0, space)),
                       escaped(heading.substr(space + 1)));
}

}  // namespace

std::string to_latex(const TextTable& table) {
    const bool intervals = std::any_of(table.header.begin(), table.header.end(),
                                       [](const std::string& heading) { return is_half_width(heading); });
    std::string text = "\\begin{table}\n\\centering\n\\caption{Constants for the mechanical energy model";
    if (intervals) text += " ($\\pm$: half widths of the 95\\,\\% intervals)";
    text += "}\n\\label{tab:mechanical-energy-model}\n";
    // Beside published constants, or with intervals, the columns are wider than a page's text.
    constexpr std::size_t columns_that_fit = 4;
    const bool scaled = table.header.size() > columns_that_fit;
    if (scaled) text = "% needs \\usepackage{graphicx}\n" + text + "\\resizebox{\\linewidth}{!}{%\n";
    text += fmt::format("\\begin{{tabular}}{{l{}}}\n\\hline\n", std::string(table.header.size() - 1, 'r'));
    for (std::size_t column = 1; column < table.header.size(); ++column) {
        text += " & " + heading_cell(table.header[column]);
    }
    text += " \\\\\n\\hline\n";
    for (const auto& row : table.rows) {
        text += row_name(row[0]);
        for (std::size_t column = 1; column < row.size(); ++column) {
            text += " & " + cell(row[column], table.header[column]);
        }
        text += " \\\\\n";
    }
    return text + "\\hline\n\\end{tabular}" + (scaled ? "}" : "") + "\n\\end{table}\n";
}

}  // namespace flightwatt::mechanical
