#include "mechanical/table_one.h"

#include "base/number.h"
#include "base/statistics.h"
#include "base/units.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

constexpr flight::PerPhase<std::string_view> column_names{{"take-off", "cruise", "landing"}};

std::string as_printed(double value) { return fmt::format("{:.4g}", value); }

std::string percent_of_change(double was, double is) {
    return was == 0.0 ? "-" : as_printed((is - was) / was * units::percent_per_whole);
}

std::size_t highest_order(const MechanicalModel& model) {
    std::size_t order = 0;
    for (const auto phase : flight::all_phases) order = std::max(order, model.phases[phase].fourier.cos_w.size());
    return order;
}

std::vector<std::string> row_names(std::size_t order) {
    std::vector<std::string> names{"a0"};
    for (std::size_t n = 1; n <= order; ++n) {
        names.push_back(fmt::format("a{}", n));
        names.push_back(fmt::format("b{}", n));
    }
    names.emplace_back("xi");
    return names;
}

/// A column as long as row_names(order): of a FourierModel or its PhaseErrors, with xi unless it has none.
template <typename Coefficients, typename Print>
std::vector<std::string> cells_of(const Coefficients& of, std::size_t order, double duration_s, bool has_xi,
                                  const Print& print) {
    std::vector<std::string> cells{print(of.a0_w)};
    for (std::size_t n = 0; n < order; ++n) {
        const bool there = n < of.cos_w.size();
        cells.push_back(there ? print(of.cos_w[n]) : "-");
        cells.push_back(there ? print(of.sin_w[n]) : "-");
    }
    cells.push_back(has_xi ? print(units::table_one_xi_from_rad(of.omega_rad_per_s * duration_s)) : "-");
    return cells;
}

std::vector<std::string> column_of(const PhaseModel& phase, std::size_t order) {
    const bool has_frequency = !phase.fourier.cos_w.empty();
    return cells_of(phase.fourier, order, phase.duration_s, has_frequency, as_printed);
}

/// Half the widths of the 95 % intervals of column_of's cells.
std::vector<std::string> half_widths_of(const PhaseModel& phase, std::size_t order) {
    if (!phase.errors) return std::vector<std::string>(2 * order + 2, "-");
    const double wide = student_t_half_width(phase.errors->degrees_of_freedom);
    return cells_of(*phase.errors, order, phase.duration_s, !phase.errors->frequency_is_given,
                    [&](double error) { return fmt::format("{:.2g}", wide * error); });
}

void add_column(TextTable& table, const std::string& name, const std::vector<std::string>& cells) {
    table.header.push_back(name);
    table.rows.resize(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) table.rows[i].push_back(cells[i]);
}

/// Text in which TeX's own characters stand for themselves.
std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (std::string_view("&%$#_{}").find(c) != std::string_view::npos) result += '\\';
        result += c == '\\'  ? "\\textbackslash{}"
                  : c == '~' ? "\\textasciitilde{}"
                  : c == '^' ? "\\textasciicircum{}"
                             : std::string(1, c);
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
        name.size() > 1 && (name[0] == 'a' || name[0] == 'b') && parse_unsigned(name.substr(1)).has_value();
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

TextTable table_one(const MechanicalModel& model, TableIntervals intervals) {
    const auto order = highest_order(model);
    TextTable table;
    add_column(table, "coefficient", row_names(order));
    for (const auto phase : flight::all_phases) {
        add_column(table, std::string(column_names[phase]), column_of(model.phases[phase], order));
        if (intervals == TableIntervals::absent) continue;
        add_column(table, fmt::format("{} +-", column_names[phase]), half_widths_of(model.phases[phase], order));
    }
    return table;
}

TextTable table_one_beside(const MechanicalModel& published, const MechanicalModel& regenerated,
                           TableIntervals intervals) {
    const auto order = std::max(highest_order(published), highest_order(regenerated));
    TextTable table;
    auto names = row_names(order);
    names.insert(names.end(), {"duration_s", "curve RMS difference [W]", "a0 difference [%]"});
    add_column(table, "coefficient", names);
    for (const auto phase : flight::all_phases) {
        const auto& was = published.phases[phase];
        const auto& is = regenerated.phases[phase];
        auto left = column_of(was, order);
        left.insert(left.end(), {as_printed(was.duration_s), "-", "-"});
        auto right = column_of(is, order);
        right.insert(right.end(), {as_printed(is.duration_s), as_printed(curve_rms_difference_w(was, is)),
                                   percent_of_change(was.fourier.a0_w, is.fourier.a0_w)});
        add_column(table, fmt::format("{} published", column_names[phase]), left);
        add_column(table, fmt::format("{} regenerated", column_names[phase]), right);
        if (intervals == TableIntervals::absent) continue;
        auto half_widths = half_widths_of(is, order);
        half_widths.insert(half_widths.end(), {"-", "-", "-"});
        add_column(table, fmt::format("{} +-", column_names[phase]), half_widths);
    }
    return table;
}

std::string to_latex(const TextTable& table) {
    const bool intervals = std::ranges::any_of(table.header, is_half_width);
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
