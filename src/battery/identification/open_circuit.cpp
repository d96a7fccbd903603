#include "battery/identification/open_circuit.h"

#include "base/piecewise_linear.h"
#include "base/statistics.h"
#include "base/units.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::battery {
namespace {

constexpr double greatest_cell_voltage_v = 4.25;
constexpr std::array chart_soc_percent{0.0,  5.0,  10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0,
                                       55.0, 60.0, 65.0, 70.0, 75.0, 80.0, 85.0, 90.0, 95.0, 100.0};
constexpr std::array chart_cell_v{3.27, 3.61, 3.69, 3.71, 3.73, 3.75, 3.77, 3.79, 3.80, 3.82, 3.84,
                                  3.85, 3.87, 3.91, 3.95, 3.98, 4.02, 4.08, 4.11, 4.15, 4.20};
constexpr double empty_cell_v = 3.5;        // at rest: the chart's knee
constexpr double least_part_percent = 3.0;  // of the chart: less tells no capacity
constexpr double added_step_percent = 5.0;

double chart_capacity_ah(double drawn_ah, double cell_voltage_v) {
    const double used_percent = units::percent_per_whole - lipo_chart_soc_percent(cell_voltage_v);
    return drawn_ah / std::max(used_percent, least_part_percent) * units::percent_per_whole;
}

}  // namespace

double lipo_chart_voltage_v(double soc_percent) {
    return interpolate_clamped(chart_soc_percent, chart_cell_v, soc_percent);
}

double lipo_chart_soc_percent(double cell_voltage_v) {
    return interpolate_clamped(chart_cell_v, chart_soc_percent, cell_voltage_v);
}

int lipo_cells(double resting_voltage_v) {
    return static_cast<int>(std::max(1.0, std::ceil(resting_voltage_v / greatest_cell_voltage_v)));
}

std::string to_string(CapacityOrigin origin) {
    constexpr std::array names{"given", "a flight drew all of it", "the LiPo chart"};
    return names.at(static_cast<std::size_t>(origin));
}

Capacity capacity_of(const CircuitFit& fit, double last_error_v, int cells, std::optional<double> given_ah) {
    const double drawn_ah = fit.knots_ah.back();
    if (given_ah) {
        if (*given_ah < drawn_ah) {
            throw UsageError(fmt::format("--capacity is {} Ah, and a flight drew {:.3f} Ah", *given_ah, drawn_ah));
        }
        return {*given_ah, CapacityOrigin::given, std::nullopt};
    }
    const double last_v = fit.open_circuit_v.back() / cells;
    if (last_v <= empty_cell_v) return {drawn_ah, CapacityOrigin::flown, std::nullopt};
    if (units::percent_per_whole - lipo_chart_soc_percent(last_v) < least_part_percent) {
        throw NoAnswerError(
            fmt::format("the flights drew {:.3f} Ah, down to {:.3f} V a cell: too little to tell the capacity; give it "
                        "with --capacity",
                        drawn_ah, last_v));
    }
    const double reach_v = normal_half_width() * std::hypot(lipo_chart_uncertainty_v, last_error_v / cells);
    return {chart_capacity_ah(drawn_ah, last_v), CapacityOrigin::chart,
            Interval{chart_capacity_ah(drawn_ah, last_v - reach_v), chart_capacity_ah(drawn_ah, last_v + reach_v)}};
}

ExtendedCurve extended_curve(const CircuitFit& fit, const std::vector<double>& standard_error_v, double capacity_ah,
                             int cells) {
    const auto soc_at = [&](double charge_ah) {
        return std::max(0.0, units::percent_per_whole - units::percent_of(charge_ah, capacity_ah));
    };
    ExtendedCurve extended;
    auto& [soc, volts] = extended.curve;
    const double known_to = soc_at(fit.knots_ah.back());
    const double last_v = fit.open_circuit_v.back();
    constexpr double same_percent = 1e-6;
    const bool extends = known_to > same_percent;
    extended.known_down_to_percent = extends ? known_to : 0.0;
    for (double percent = 0.0; extends && percent < known_to - 0.5; percent += added_step_percent) {
        const double below_v = lipo_chart_voltage_v(known_to) - lipo_chart_voltage_v(percent);
        soc.push_back(percent);
        volts.push_back(std::max(last_v - cells * below_v, last_v / 2.0));
        extended.standard_error_v.push_back(std::hypot(standard_error_v.back(), cells * lipo_chart_uncertainty_v));
    }
    for (std::size_t i = fit.knots_ah.size(); i-- > 0;) {
        soc.push_back(soc_at(fit.knots_ah[i]));
        volts.push_back(fit.open_circuit_v[i]);
        extended.standard_error_v.push_back(standard_error_v[i]);
    }
    soc.front() = 0.0;  // the last knot, where it is as good as empty
    return extended;
}

}  // namespace flightwatt::battery
