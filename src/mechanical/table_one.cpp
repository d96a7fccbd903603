#include "mechanical/table_one.h"

#include "base/statistics.h"
#include "base/units.h"
#include "mechanical/phase_curve.h"

#include <algorithm>
#include <string>
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
    for (const auto phase : flight::all_phases)
        order = std::max(order, model.phases[phase].fourier.cos_w.size());
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

/// One phase's column, as long as row_names(order).
std::vector<std::string> column_of(const PhaseModel& phase, std::size_t order) {
    const auto& fourier = phase.fourier;
    std::vector<std::string> cells{as_printed(fourier.a0_w)};
    for (std::size_t n = 0; n < order; ++n) {
        const bool there = n < fourier.cos_w.size();
        cells.push_back(there ? as_printed(fourier.cos_w[n]) : "-");
        cells.push_back(there ? as_printed(fourier.sin_w[n]) : "-");
    }
    const double theta_rad = fourier.omega_rad_per_s * phase.duration_s;
    const bool constant = fourier.cos_w.empty();  // it has no frequency that matters
    cells.push_back(constant ? "-" : as_printed(units::table_one_xi_from_rad(theta_rad)));
    return cells;
}

/// Half the widths of the 95 % intervals of column_of's cells.
std::vector<std::string> half_widths_of(const PhaseModel& phase, std::size_t order) {
    if (!phase.errors) return std::vector<std::string>(2 * order + 2, "-");
    const auto& errors = *phase.errors;
    const double wide = student_t_half_width(errors.degrees_of_freedom);
    const auto printed = [&](double error) { return fmt::format("{:.2g}", wide * error); };
    std::vector<std::string> cells{printed(errors.a0_w)};
    for (std::size_t n = 0; n < order; ++n) {
        const bool there = n < errors.cos_w.size();
        cells.push_back(there ? printed(errors.cos_w[n]) : "-");
        cells.push_back(there ? printed(errors.sin_w[n]) : "-");
    }
    const double theta_rad = errors.omega_rad_per_s * phase.duration_s;
    cells.push_back(errors.frequency_is_given ? "-" : printed(units::table_one_xi_from_rad(theta_rad)));
    return cells;
}

void add_column(TextTable& table, const std::string& name, const std::vector<std::string>& cells) {
    table.header.push_back(name);
    table.rows.resize(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) table.rows[i].push_back(cells[i]);
}

}  // namespace

TextTable table_one(const MechanicalModel& model, TableIntervals intervals) {
    const auto order = highest_order(model);
    TextTable table;
    add_column(table, "coefficient", row_names(order));
    for (const auto phase : flight::all_phases) {
        add_column(table, std::string(column_names[phase]), column_of(model.phases[phase], order));
        if (intervals == TableIntervals::absent) continue;
        add_column(table, fmt::format("{} +-", column_names[phase]),
                   half_widths_of(model.phases[phase], order));
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

}  // namespace flightwatt::mechanical
