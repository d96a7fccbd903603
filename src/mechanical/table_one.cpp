#include "mechanical/table_one.h"

#include "base/number.h"
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

std::size_t model_order(const MechanicalModel& model) {
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

/// A column as long as row_names(order).
std::vector<std::string> column_of(const PhaseModel& phase, std::size_t order) {
    const auto& of = phase.fourier;
    std::vector<std::string> cells{as_printed(of.a0_w)};
    for (std::size_t n = 0; n < order; ++n) {
        const bool there = n < of.cos_w.size();
        cells.push_back(there ? as_printed(of.cos_w[n]) : "-");
        cells.push_back(there ? as_printed(of.sin_w[n]) : "-");
    }
    const double theta_rad = of.omega_rad_per_s * phase.duration_s;
    cells.push_back(of.cos_w.empty() ? "-" : as_printed(units::table_one_xi_from_rad(theta_rad)));
    return cells;
}

/// Between the ends of an interval, which are not as far from the coefficient the one as the other.
constexpr std::string_view between_ends = " to ";

std::string interval_text(const Interval& interval) {
    return as_printed(interval.low) + std::string(between_ends) + as_printed(interval.high);
}

/// The 95 % intervals of column_of's cells.
std::vector<std::string> intervals_of(const PhaseModel& phase, std::size_t order) {
    if (!phase.errors) return std::vector<std::string>(2 * order + 2, "-");
    const auto intervals = coefficient_intervals(phase);
    std::vector<std::string> cells{interval_text(intervals.a0_w)};
    for (std::size_t n = 0; n < order; ++n) {
        const bool there = n < intervals.cos_w.size();
        cells.push_back(there ? interval_text(intervals.cos_w[n]) : "-");
        cells.push_back(there ? interval_text(intervals.sin_w[n]) : "-");
    }
    const auto xi = [&](double omega) { return units::table_one_xi_from_rad(omega * phase.duration_s); };
    const auto& [low, high] = intervals.omega_rad_per_s;
    cells.push_back(phase.errors->frequency_is_fixed ? "-" : interval_text({xi(low), xi(high)}));
    return cells;
}

void add_column(TextTable& table, const std::string& name, const std::vector<std::string>& cells) {
    table.header.push_back(name);
    table.rows.resize(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) table.rows[i].push_back(cells[i]);
}

constexpr std::string_view interval_heading = "95 %";

bool is_interval(std::string_view heading) { return heading.ends_with(interval_heading); }

std::string cell(std::string_view text, std::string_view heading) {
    if (text == "-") return "--";
    if (const auto split = text.find(between_ends); is_interval(heading) && split != std::string_view::npos) {
        return fmt::format("$[{},\\, {}]$", latex_number(text.substr(0, split)),
                           latex_number(text.substr(split + between_ends.size())));
    }
    if (!parse_number(text)) return latex_escaped(text);
    return fmt::format("${}$", latex_number(text));
}

/// a0 as $a_0$, xi as $\xi$; other rows as they are called.
std::string row_name(std::string_view name) {
    if (name == "xi") return "$\\xi$";
    const bool coefficient =
        name.size() > 1 && (name[0] == 'a' || name[0] == 'b') && parse_unsigned(name.substr(1)).has_value();
    return coefficient ? fmt::format("${}_{{{}}}$", name[0], name.substr(1)) : latex_escaped(name);
}

/// A heading of two words on two lines: numbers are narrower than "take-off regenerated".
std::string heading_cell(std::string_view heading) {
    if (is_interval(heading)) return "";
    const auto space = heading.rfind(' ');
    if (space == std::string_view::npos) return latex_escaped(heading);
    return fmt::format("\\shortstack[r]{{{}\\\\{}}}", latex_escaped(heading.substr(0, space)),
                       latex_escaped(heading.substr(space + 1)));
}

}  // namespace

TextTable table_one(const MechanicalModel& model, TableIntervals intervals) {
    const auto order = model_order(model);
    TextTable table;
    add_column(table, "coefficient", row_names(order));
    for (const auto phase : flight::all_phases) {
        add_column(table, std::string(column_names[phase]), column_of(model.phases[phase], order));
        if (intervals == TableIntervals::absent) continue;
        add_column(table, fmt::format("{} {}", column_names[phase], interval_heading),
                   intervals_of(model.phases[phase], order));
    }
    return table;
}

TextTable table_one_comparison(const MechanicalModel& published, const MechanicalModel& regenerated,
                               TableIntervals intervals) {
    const auto order = std::max(model_order(published), model_order(regenerated));
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
        right.insert(right.end(), {as_printed(is.duration_s), as_printed(rms_difference_w(was, is)),
                                   percent_of_change(was.fourier.a0_w, is.fourier.a0_w)});
        add_column(table, fmt::format("{} published", column_names[phase]), left);
        add_column(table, fmt::format("{} regenerated", column_names[phase]), right);
        if (intervals == TableIntervals::absent) continue;
        auto intervals_of_cells = intervals_of(is, order);
        intervals_of_cells.insert(intervals_of_cells.end(), {"-", "-", "-"});
        add_column(table, fmt::format("{} {}", column_names[phase], interval_heading), intervals_of_cells);
    }
    return table;
}

std::string to_latex(const TextTable& table) {
    const bool intervals = std::ranges::any_of(table.header, is_interval);
    std::string text =
        "% needs \\usepackage{booktabs}\n\\begin{table}\n\\centering\n\\caption{Constants for the mechanical energy model";
    if (intervals) text += " (in brackets: 95\\,\\% intervals)";
    text += "}\n\\label{tab:mechanical-energy-model}\n";
    // Beside published constants, or with intervals, the columns are wider than a page's text.
    constexpr std::size_t columns_that_fit = 4;
    const bool scaled = table.header.size() > columns_that_fit;
    if (scaled) text = "% needs \\usepackage{graphicx}\n" + text + "\\resizebox{\\linewidth}{!}{%\n";
    text += fmt::format("\\begin{{tabular}}{{l{}}}\n\\toprule\n", std::string(table.header.size() - 1, 'r'));
    for (std::size_t column = 1; column < table.header.size(); ++column) {
        text += " & " + heading_cell(table.header[column]);
    }
    text += " \\\\\n\\midrule\n";
    for (const auto& row : table.rows) {
        text += row_name(row[0]);
        for (std::size_t column = 1; column < row.size(); ++column) {
            text += " & " + cell(row[column], table.header[column]);
        }
        text += " \\\\\n";
    }
    return text + "\\bottomrule\n\\end{tabular}" + (scaled ? "}" : "") + "\n\\end{table}\n";
}

}  // namespace flightwatt::mechanical
