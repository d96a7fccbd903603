#include "battery/identification/state_of_health.h"

#include "base/piecewise_linear.h"
#include "base/statistics.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::battery {
namespace {

constexpr std::ptrdiff_t enough_blocks = 4;
constexpr double own_parameters = 3.0;  // of a flight, that blocks of its time must determine
constexpr double widest_ratio = 0.15;

/// How far an error of a flight's resistance moves its initial charge; none where its samples under load, by current
/// and charge alone, do not determine the resistance.
std::optional<double> charge_ah_per_ohm(const JointCircuitFit& worn, std::size_t f) {
    const auto& record = *worn.records[f].record;
    const auto knots = std::ssize(worn.fit.knots_ah);
    const auto loaded = used_sample_count(record) - rest_sample_count(record);
    const auto columns = rows_of(worn, f, linear_only).columns.bottomRows(loaded).eval();
    const auto current = columns.col(knots + resistance_column);
    const auto slope = columns.col(knots + charge_column);
    const double squares = slope.squaredNorm();
    const double products = slope.dot(current);
    constexpr double nearly_one = 1.0 - 1e-6;
    if (loaded < 2 || products * products >= nearly_one * squares * current.squaredNorm()) return std::nullopt;
    return -products / squares;
}

/// The error of a capacity's logarithm by what no model follows: a voltage beside the curve by as much as charged packs
/// rest beside it, over the voltage that the flight falls by on the curve.
double unlike_others(const JointCircuitFit& worn, std::size_t f) {
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

std::optional<ResistanceTrend> resistance_trend(std::span<const std::optional<FlightResistance>> in_order) {
    std::vector<double> number;
    std::vector<double> value_ohm;
    for (std::size_t i = 0; i < in_order.size(); ++i) {
        if (!in_order[i]) continue;
        number.push_back(static_cast<double>(i));
        value_ohm.push_back(in_order[i]->value_ohm);
    }
    constexpr std::size_t min_flights = 3;
    if (number.size() < min_flights) return std::nullopt;
    const double middle = mean(number);
    const double level_ohm = mean(value_ohm);
    double squares = 0.0;
    double products = 0.0;
    for (std::size_t i = 0; i < number.size(); ++i) {
        squares += std::pow(number[i] - middle, 2);
        products += (number[i] - middle) * (value_ohm[i] - level_ohm);
    }
    ResistanceTrend trend{number.size(), products / squares, {}};
    double left = 0.0;
    for (std::size_t i = 0; i < number.size(); ++i)
        left += std::pow(value_ohm[i] - level_ohm - trend.ohm_per_flight * (number[i] - middle), 2);
    const double degrees_of_freedom = static_cast<double>(number.size()) - 2.0;
    const double half = student_t_half_width(degrees_of_freedom) * std::sqrt(left / degrees_of_freedom / squares);
    trend.interval_ohm_a_flight = {trend.ohm_per_flight - half, trend.ohm_per_flight + half};
    return trend;
}

std::vector<FlightHealth> estimate_state_of_health(JointCircuitFit joint, bool with_capacity) {
    const FreeParameters free{true, false, true, with_capacity && joint.records.size() > 1};
    const auto problem = least_squares(joint, free);
    const auto errors = parameter_errors(problem, joint.fit.weights.sample_error_v).standard_error;
    std::vector<FlightHealth> health(joint.records.size());
    for (std::size_t f = 0; f < health.size(); ++f) {
        const auto& aligned = joint.records[f];
        const auto& places = problem.places.own[f];
        const auto moved_ah = charge_ah_per_ohm(joint, f);
        const auto blocks = std::ranges::count(problem.blocks, f, &RowBlock::record);
        if (blocks < enough_blocks || !moved_ah) continue;
        FlightResistance found;
        found.value_ohm = aligned.resistance_ohm;
        found.standard_error_ohm = errors[places.resistance];
        found.degrees_of_freedom = std::max(1.0, static_cast<double>(blocks) - own_parameters);
        found.charge_ah_per_ohm = *moved_ah;
        const double t = student_t_half_width(found.degrees_of_freedom);
        const double half_ohm = t * found.standard_error_ohm;
        found.interval_ohm = {std::max(0.0, found.value_ohm - half_ohm), found.value_ohm + half_ohm};
        if (std::isfinite(half_ohm) && found.value_ohm > 0.0) health[f].resistance = found;
        if (!free.own_capacities) continue;
        const double half_log = t * std::hypot(errors[places.log_capacity], unlike_others(joint, f));
        const double ratio = std::exp(aligned.log_capacity);
        if (half_log <= std::log1p(widest_ratio))
            health[f].capacity = FlightCapacity{ratio, {ratio * std::exp(-half_log), ratio * std::exp(half_log)}};
    }
    return health;
}

}  // namespace flightwatt::battery
