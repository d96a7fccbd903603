#include "mechanical/table_one.h"

#include "base/number.h"
#include "base/units.h"

#include <algorithm>
#include <vector>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

constexpr flight::PerPhase<std::string_view> column_names{{"take-off", "cruise", "landing"}};

std::string as_printed(double value) { return fmt::format("{:.4g}", value); }

std::string percent_of_change(double was, double is) {
    return was == 0.0 ? "-" : as_printed((is - was) / was * units::percent_per_whole);
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

std::string as_printed(const Interval& interval) {
    return fmt::format("{} to {}", as_printed(interval.low), as_printed(interval.high));
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

/// Where other frequencies fit almost as well, intervals of the coefficients would be far wider than the curve's.
constexpr auto open_frequency_reason = "other frequencies fit";
constexpr auto no_errors_reason = "no errors known";
constexpr auto fixed_frequency_reason = "not fitted";

/// The 95 % intervals of column_of's cells, or the reason why a coefficient has none.
std::vector<std::string> intervals_of(const PhaseModel& phase, std::size_t order) {
    if (!phase.errors || phase.open_frequency) {
        auto cells = column_of(phase, order);
        for (auto& cell : cells)
            if (cell != "-") cell = phase.errors ? open_frequency_reason : no_errors_reason;
        return cells;
    }
    const auto intervals = coefficient_intervals(phase);
    auto cells = coefficient_cells(intervals.a0_w, intervals.cos_w, intervals.sin_w, order);
    const auto xi = [&](double omega) { return units::table_one_xi_from_rad(omega * phase.duration_s); };
    const auto& [low, high] = intervals.omega_rad_per_s;
    cells.push_back(phase.fourier.cos_w.empty()        ? "-"
                    : phase.errors->frequency_is_fixed ? fixed_frequency_reason
                                                       : as_printed(Interval{xi(low), xi(high)}));
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
    std::vector<std::string> row_units(names.size(), "W");
    row_units.back() = "rad";  // xi
    if (published) names.insert(names.end(), {"duration", "curve RMS difference", "a0 difference"});
    if (published) row_units.insert(row_units.end(), {"s", "W", "%"});
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
    add_column(table, "unit", row_units);
    return table;
}

/// a0 as $a_0$, xi as $\xi$; other rows as they are called.
std::string row_name(const std::string& name) {
    if (name == "xi") return "$\\xi$";
    const bool coefficient =
        name.size() > 1 && (name[0] == 'a' || name[0] == 'b') && parse_unsigned(name.substr(1)).has_value();
    return coefficient ? fmt::format("${}_{{{}}}$", name[0], name.substr(1)) : name;
}

}  // namespace

TextTable table_one(const MechanicalModel& model, TableIntervals intervals) {
    return build_table(nullptr, model, intervals);
}

TextTable table_one_comparison(const MechanicalModel& published, const MechanicalModel& regenerated,
                               TableIntervals intervals) {
    return build_table(&published, regenerated, intervals);
}

std::string to_latex(const TextTable& table, std::string_view label) {
    auto cells = table;
    cells.header.front().clear();
    std::string notes;
    for (std::size_t column = cells.header.size(); column-- > 0;) {
        auto& heading = cells.header[column];
        if (!heading.ends_with(interval_heading)) continue;
        const auto reason = cells.rows.front()[column];
        if (reason != open_frequency_reason && reason != no_errors_reason) {
            heading.clear();
            continue;
        }
        notes.insert(0, fmt::format("; no interval of the {}: {}", heading.substr(0, heading.find(' ')), reason));
        const auto at = static_cast<std::ptrdiff_t>(column);
        cells.header.erase(cells.header.begin() + at);
        for (auto& row : cells.rows) row.erase(row.begin() + at);
    }
    if (std::ranges::count(cells.header, "") > 1) notes = "; in brackets: 95 % intervals" + notes;
    std::string caption = "Constants for the mechanical energy model";
    if (!notes.empty()) caption += fmt::format(" ({})", notes.substr(2));
    auto text = flightwatt::to_latex(cells, caption, label);
    for (const auto& row : cells.rows)
        boost::replace_first(text, "\n" + row.front() + " & ", "\n" + row_name(row.front()) + " & ");
    return text;
}

}  // namespace flightwatt::mechanical
