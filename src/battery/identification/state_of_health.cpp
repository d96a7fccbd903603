#include "base/piecewise_linear.h"
#include "base/statistics.h"
#include "battery/identification/circuit_problem.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::battery {
namespace {

constexpr std::ptrdiff_t enough_blocks = 4;
constexpr double own_parameters = 3.0;      // of a flight, that blocks of its time must determine
constexpr double max_relative_error = 0.5;  // of a resistance
constexpr double max_ratio_error = 0.15;

/// The model error of a capacity's logarithm: the deviation of charged packs' resting voltage from the curve, over the
/// flight's fall on the curve.
double log_capacity_error(const JointCircuitFit& worn, std::size_t f) {
    const auto& [record, initial_ah, rest_v, own_ohm, log_capacity] = worn.records[f];
    const auto& fit = worn.fit;
    const auto voltage_v = [&](double at_ah) { return interpolate_extended(fit.knots_ah, fit.open_circuit_v, at_ah); };
    const double drawn_ah = std::exp(-log_capacity) * record->charge_ah.back();
    const double fall_v = voltage_v(initial_ah) - voltage_v(initial_ah + drawn_ah);
    constexpr double min_v = 1e-3;
    return charged_rest_sd_v * fit.weights.cells / std::max(min_v, fall_v);
}

}  // namespace

double resistance_scatter_ohm(std::span<const std::optional<FlightResistance>> resistances, double fitted_ohm) {
    std::vector<double> values_ohm;
    double error_ohm2 = 0.0;
    for (const auto& own : resistances) {
        if (!own) continue;
        values_ohm.push_back(own->value_ohm);
        error_ohm2 += std::pow(own->standard_error_ohm, 2);
    }
    double sum_ohm2 = std::pow(default_scatter_fraction * fitted_ohm, 2);
    if (values_ohm.size() < 2) return std::sqrt(sum_ohm2);
    const auto n = static_cast<double>(values_ohm.size());
    sum_ohm2 += (n - 1.0) * std::max(0.0, sample_variance(values_ohm) - error_ohm2 / n);
    return std::sqrt(sum_ohm2 / n);
}

std::optional<ResistanceScatter> resistance_scatter(std::span<const std::optional<FlightResistance>> resistances,
                                                    double fitted_ohm) {
    const auto flights =
        static_cast<std::size_t>(std::ranges::count_if(resistances, [](const auto& own) { return own.has_value(); }));
    if (flights < 2) return std::nullopt;
    return ResistanceScatter{resistance_scatter_ohm(resistances, fitted_ohm), flights};
}

std::vector<FlightHealth> estimate_state_of_health(JointCircuitFit joint, bool with_capacity) {
    const FreeParameters free{true, false, true, with_capacity && joint.records.size() > 1};
    const auto problem = least_squares(joint, free);
    const auto errors = parameter_errors(problem, joint.fit.weights.sample_error_v).own;
    std::vector<FlightHealth> health(joint.records.size());
    for (std::size_t f = 0; f < health.size(); ++f) {
        const auto& aligned = joint.records[f];
        const auto own_errors = errors.col(static_cast<Eigen::Index>(f));
        const auto blocks = std::ssize(problem.records[f].blocks);
        health[f].initial_charge_error_ah = own_errors[charge_column];
        if (blocks < enough_blocks) continue;
        FlightResistance found;
        found.value_ohm = aligned.resistance_ohm;
        found.standard_error_ohm = own_errors[own_resistance_column];
        found.degrees_of_freedom = std::max(1.0, static_cast<double>(blocks) - own_parameters);
        const double t = student_t_half_width(found.degrees_of_freedom);
        const double half_ohm = t * found.standard_error_ohm;
        found.interval_ohm = {std::max(0.0, found.value_ohm - half_ohm), found.value_ohm + half_ohm};
        if (found.standard_error_ohm < max_relative_error * found.value_ohm) health[f].resistance = found;
        if (!free.own_capacities) continue;
        const double half_log = t * std::hypot(own_errors[capacity_column], log_capacity_error(joint, f));
        const double ratio = std::exp(aligned.log_capacity);
        if (half_log <= std::log1p(max_ratio_error))
            health[f].capacity = FlightCapacity{ratio, {ratio * std::exp(-half_log), ratio * std::exp(half_log)}};
    }
    return health;
}

}  // namespace flightwatt::battery
