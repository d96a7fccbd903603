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

/// Separator of the ends of an asymmetric interval.
constexpr std::string_view between_ends = " to ";

std::string as_printed(const Interval& interval) {
    return as_printed(interval.low) + std::string(between_ends) + as_printed(interval.high);
}

/// The cells of a0, a1, b1, ...: of numbers, or of their intervals.
template <typename Value>
std::vector<std::string> coefficient_cells(const Value& a0, const std::vector<Value>& cos,
                                           const std::vector<Value>& sin, std::size_t order) {
    std::vector<std::string> cells{as_printed(a0)};
    for (std::size_t n = 0; n < order; ++n) {
        cells.push_back(n < cos.size() ? as_printed(cos[n]) : "-");
        cells.push_back(n < sin.size() ? as_printed(sin[n]) : "-");
    }
    return cells;
}

/// A column as long as row_names(order).
std::vector<std::string> column_of(const PhaseModel& phase, std::size_t order) {
    const auto& of = phase.fourier;
    auto cells = coefficient_cells(of.a0_w, of.cos_w, of.sin_w, order);
    const double theta_rad = of.omega_rad_per_s * phase.duration_s;
    cells.push_back(of.cos_w.empty() ? "-" : as_printed(units::table_one_xi_from_rad(theta_rad)));
    return cells;
}

/// The 95 % intervals of column_of's cells.
std::vector<std::string> intervals_of(const PhaseModel& phase, std::size_t order) {
    if (!phase.errors) return std::vector<std::string>(2 * order + 2, "-");
    const auto intervals = coefficient_intervals(phase);
    auto cells = coefficient_cells(intervals.a0_w, intervals.cos_w, intervals.sin_w, order);
    const auto xi = [&](double omega) { return units::table_one_xi_from_rad(omega * phase.duration_s); };
    const auto& [low, high] = intervals.omega_rad_per_s;
    cells.push_back(phase.errors->frequency_is_fixed ? "-" : as_printed(Interval{xi(low), xi(high)}));
    return cells;
}

void add_column(TextTable& table, const std::string& name, const std::vector<std::string>& cells) {
    table.header.push_back(name);
    table.rows.resize(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) table.rows[i].push_back(cells[i]);
}

constexpr std::string_view interval_heading = "95 %";

/// The model, next to the published one if there is one.
TextTable build_table(const MechanicalModel* published, const MechanicalModel& model, TableIntervals intervals) {
    const auto order = std::max(model_order(model), published ? model_order(*published) : 0);
    TextTable table;
    auto names = row_names(order);
    if (published) names.insert(names.end(), {"duration_s", "curve RMS difference [W]", "a0 difference [%]"});
    add_column(table, "coefficient", names);
    for (const auto phase : flight::all_phases) {
        const auto& is = model.phases[phase];
        std::string heading(column_names[phase]);
        auto cells = column_of(is, order);
        if (published) {
            const auto& was = published->phases[phase];
            auto published_cells = column_of(was, order);
            published_cells.insert(published_cells.end(), {as_printed(was.duration_s), "-", "-"});
            add_column(table, heading + " published", published_cells);
            cells.insert(cells.end(), {as_printed(is.duration_s), as_printed(rms_difference_w(was, is)),
                                       percent_of_change(was.fourier.a0_w, is.fourier.a0_w)});
            heading += " regenerated";
        }
        add_column(table, heading, cells);
        if (intervals == TableIntervals::absent) continue;
        auto interval_cells = intervals_of(is, order);
        interval_cells.resize(cells.size(), "-");
        add_column(table, fmt::format("{} {}", column_names[phase], interval_heading), interval_cells);
    }
    return table;
}

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

}  // namespace

TextTable table_one(const MechanicalModel& model, TableIntervals intervals) {
    return build_table(nullptr, model, intervals);
}

TextTable table_one_comparison(const MechanicalModel& published, const MechanicalModel& regenerated,
                               TableIntervals intervals) {
    return build_table(&published, regenerated, intervals);
}

std::string to_latex(const TextTable& table) {
    const bool intervals = std::ranges::any_of(table.header, is_interval);
    // With published constants or intervals the columns are wider than a page's text.
    constexpr std::size_t columns_that_fit = 4;
    const bool scaled = table.header.size() > columns_that_fit;
    auto cells = table;
    std::ranges::transform(table.header, cells.header.begin(), [](const std::string& heading) {
        return is_interval(heading) ? "" : latex_escaped(heading);
    });
    cells.header.front().clear();
    for (auto& row : cells.rows) {
        row.front() = row_name(row.front());
        for (std::size_t column = 1; column < row.size(); ++column)
            row[column] = cell(row[column], table.header[column]);
    }
    return latex_table(
        {scaled ? "% needs \\usepackage{graphicx}\n% needs \\usepackage{booktabs}" : "% needs \\usepackage{booktabs}",
         fmt::format("Constants for the mechanical energy model{}",
                     intervals ? " (in brackets: 95\\,\\% intervals)" : ""),
         "tab:mechanical-energy-model", "l" + std::string(table.header.size() - 1, 'r'), scaled ? "\\linewidth" : ""},
        cells);
}

}  // namespace flightwatt::mechanical
