#include "battery/identification/open_circuit.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace flightwatt::battery {
namespace {

constexpr double max_high_voltage_cell_v = 4.45;
constexpr double full_high_voltage_cell_v = 4.38;  // charged to 4.35 V, with an error of the sensor
constexpr double nearly_empty_percent = 25.0;      // less is no charge to take off with
constexpr double min_fraction = 0.03;              // of the charge: less does not determine the capacity
constexpr double flown_fraction = 0.95;
constexpr double added_step_percent = 5.0;

}  // namespace

int lipo_cells(double resting_voltage_v) {
    const int cells = static_cast<int>(std::max(1.0, std::ceil(resting_voltage_v / max_charged_cell_v)));
    const bool nearly_empty = resting_voltage_v / cells <= chart_voltage_v(Chemistry::lipo, nearly_empty_percent);
    return nearly_empty && resting_voltage_v <= (cells - 1) * full_high_voltage_cell_v ? std::max(1, cells - 1) : cells;
}

bool are_possible_lipo_cells(double resting_voltage_v, int cells) {
    const double cell_v = resting_voltage_v / cells;
    return cell_v >= chart_voltage_v(Chemistry::lipo, 0.0) && cell_v <= max_high_voltage_cell_v;
}

void require_possible_cells(const std::string& flight, double resting_voltage_v, int cells) {
    const double cell_v = resting_voltage_v / cells;
    if (cell_v >= min_cell_voltage_v && cell_v <= max_cell_voltage_v) return;
    const auto min_cells = std::max(1, static_cast<int>(std::ceil(resting_voltage_v / max_cell_voltage_v)));
    const auto max_cells = std::max(min_cells, static_cast<int>(resting_voltage_v / min_cell_voltage_v));
    throw UsageError(fmt::format(
        "--cells {}: {}, the fullest flight, rests at {:.3f} V, {:.3f} V a cell, and lithium cells rest at {} to {} V: "
        "expected {} to {} cells",
        cells, flight, resting_voltage_v, cell_v, min_cell_voltage_v, max_cell_voltage_v, min_cells, max_cells));
}

std::string cells_warning(double resting_voltage_v, int cells, bool is_given) {
    const double cell_v = resting_voltage_v / cells;
    const double empty_v = chart_voltage_v(Chemistry::lipo, 0.0);
    if (cell_v < empty_v) {
        return fmt::format(
            "{} cells rest at {:.2f} V each before take-off, below an empty LiPo cell ({} V): check the number with "
            "--cells",
            cells, cell_v, empty_v);
    }
    if (cell_v > max_charged_cell_v) {
        return fmt::format(
            "{} cells rest at {:.2f} V each, above a full LiPo cell ({:.2f} V): check the number with --cells, if they "
            "are no high-voltage cells",
            cells, cell_v, chart_voltage_v(Chemistry::lipo, 100.0));
    }
    const double one_less_v = resting_voltage_v / std::max(1, cells - 1);
    if (is_given || cells == 1 || one_less_v > max_high_voltage_cell_v) return "";
    return fmt::format(
        "{} cells assumed, at {:.2f} V each; {} full high-voltage cells rest at {:.2f} V each: give --cells", cells,
        cell_v, cells - 1, one_less_v);
}

std::string to_string(CapacityOrigin origin) {
    constexpr std::array names{"given", "flights drew nearly all of it", "charts of lithium cells"};
    return names.at(static_cast<std::size_t>(origin));
}

std::string to_string(Chemistry chemistry) {
    constexpr std::array names{"LiPo", "NMC", "high-voltage LiPo"};
    return names.at(static_cast<std::size_t>(chemistry));
}

Capacity estimate_capacity(double drawn_ah, std::span<const CapacityHypothesis> posterior,
                           std::optional<double> given_ah) {
    if (given_ah) return {*given_ah, CapacityOrigin::given, std::nullopt};
    constexpr double tail = (1.0 - confidence_level) / 2.0;
    Capacity capacity{capacity_quantile_ah(posterior, 0.5), CapacityOrigin::chart,
                      Interval{capacity_quantile_ah(posterior, tail), capacity_quantile_ah(posterior, 1.0 - tail)}};
    if (drawn_ah < min_fraction * capacity.value_ah) {
        throw NoResultError(fmt::format(
            "the flights drew {:.3f} Ah: too little to determine the capacity; give it with --capacity", drawn_ah));
    }
    if (drawn_ah >= flown_fraction * capacity.value_ah) capacity.origin = CapacityOrigin::measured;
    return capacity;
}

ExtendedCurve extrapolate_curve(const CircuitFit& fit, const std::vector<double>& standard_error_v, Chemistry chemistry,
                                double capacity_ah, double missing_ah) {
    const auto soc_at = [&](double charge_ah) {
        return std::max(0.0, units::percent_per_whole - units::percentage(missing_ah + charge_ah, capacity_ah));
    };
    ExtendedCurve extended;
    auto& soc = extended.curve.soc_percent;
    const double known_to = soc_at(fit.knots_ah.back());
    const double known_from = soc_at(fit.knots_ah.front());
    constexpr double same_percent = 1e-6;
    extended.known_down_to_percent = known_to > same_percent ? known_to : 0.0;
    extended.known_up_to_percent = known_from;
    const int cells = fit.weights.cells;
    // A knot of the chart, parallel to it from a measured one.
    const auto add_knot = [&](double percent, double from_percent, double from_v, double error_v) {
        const double above_v = cells * (chart_voltage_v(chemistry, percent) - chart_voltage_v(chemistry, from_percent));
        soc.push_back(percent);
        extended.curve.voltage_v.push_back(std::max(from_v + above_v, from_v / 2.0));
        extended.standard_error_v.push_back(
            std::hypot(error_v, cells * extrapolation_sd_v(chemistry, percent, from_percent)));
    };
    double percent = 0.0;
    for (; percent < extended.known_down_to_percent - 0.5; percent += added_step_percent)
        add_knot(percent, known_to, fit.open_circuit_v.back(), standard_error_v.back());
    for (std::size_t i = fit.knots_ah.size(); i-- > 0;) {
        // Of the knots beyond a given capacity only the first is used.
        if (i > 0 && soc_at(fit.knots_ah[i - 1]) <= 0.0) continue;
        soc.push_back(soc_at(fit.knots_ah[i]));
        extended.curve.voltage_v.push_back(fit.open_circuit_v[i]);
        extended.standard_error_v.push_back(standard_error_v[i]);
    }
    for (percent = added_step_percent * std::ceil(known_from / added_step_percent + 0.1);
         missing_ah > 0.0 && percent <= units::percent_per_whole; percent += added_step_percent)
        add_knot(percent, known_from, fit.open_circuit_v.front(), standard_error_v.front());
    soc.front() = 0.0;  // the last knot, nearly empty
    soc.back() = units::percent_per_whole;
    return extended;
}

}  // namespace flightwatt::battery
