#include "battery/identification/flight_resistance.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace flightwatt::battery {
namespace {

constexpr double shortest_part_s = 15.0;
constexpr double wanted_parts = 12.0;
constexpr std::size_t enough_parts = 4;

/// Samples of one flight under load: derivatives by resistance and initial charge, and what the common fit leaves.
struct OwnRows {
    Eigen::MatrixX2d columns;
    Eigen::VectorXd residual_v;
    std::vector<Eigen::Index> part_ends;
};

OwnRows own_rows(const AlignedRecord& aligned, const CircuitFit& fit, Eigen::Index first) {
    const auto& record = *aligned.record;
    const auto slopes = slopes_v_per_ah(aligned, fit);
    OwnRows own;
    own.columns.resize(slopes.size(), 2);
    own.residual_v.resize(slopes.size());
    const double length_s = record.time_s.back() - record.time_s.front();
    const double part_s = std::max(shortest_part_s, length_s / wanted_parts);
    double end_s = record.time_s.front() + part_s;
    Eigen::Index sample = 0;
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < record.used.size(); ++i) {
        if (!record.used[i]) continue;
        const auto at = sample++;
        if (i < record.rest_samples) continue;
        if (record.time_s[i] >= end_s) {
            if (row > 0 && (own.part_ends.empty() || own.part_ends.back() < row)) own.part_ends.push_back(row);
            end_s += part_s * std::ceil((record.time_s[i] - end_s) / part_s + 1e-9);
        }
        own.columns(row, 0) = -record.current_a[i];
        own.columns(row, 1) = slopes[at];
        own.residual_v[row++] = fit.residual_v[first + at];
    }
    own.columns.conservativeResize(row, Eigen::NoChange);
    own.residual_v.conservativeResize(row);
    if (row > 0) own.part_ends.push_back(row);
    return own;
}

std::optional<FlightResistance> resistance_of(const OwnRows& own, double fitted_ohm) {
    if (own.part_ends.size() < enough_parts) return std::nullopt;
    const Eigen::Matrix2d normal = own.columns.transpose() * own.columns;
    constexpr double nearly_one = 1.0 - 1e-6;
    if (std::pow(normal(0, 1), 2) >= nearly_one * normal(0, 0) * normal(1, 1)) return std::nullopt;
    const Eigen::Vector2d change = normal.ldlt().solve(own.columns.transpose() * own.residual_v);
    const Eigen::VectorXd left_v = own.residual_v - own.columns * change;
    double squares = 0.0;
    Eigen::Index first = 0;
    for (const auto end : own.part_ends) {
        const auto part = own.columns.middleRows(first, end - first);
        const Eigen::Vector2d score = part.transpose() * left_v.segment(first, end - first);
        const Eigen::Matrix2d others = normal - part.transpose() * part;
        squares += std::pow(others.ldlt().solve(score)[0], 2);
        first = end;
    }
    const auto parts = static_cast<double>(own.part_ends.size());
    FlightResistance found;
    found.value_ohm = fitted_ohm + change[0];
    found.standard_error_ohm = std::sqrt((parts - 1.0) / parts * squares);
    found.degrees_of_freedom = parts - 2.0;
    found.charge_ah_per_ohm = -normal(0, 1) / normal(1, 1);
    const double half_ohm = student_t_half_width(found.degrees_of_freedom) * found.standard_error_ohm;
    found.interval_ohm = {std::max(0.0, found.value_ohm - half_ohm), found.value_ohm + half_ohm};
    if (!std::isfinite(half_ohm) || found.value_ohm <= 0.0) return std::nullopt;
    return found;
}

}  // namespace

std::vector<std::optional<FlightResistance>> flight_resistances(const AlignedFit& aligned) {
    std::vector<std::optional<FlightResistance>> resistances;
    Eigen::Index first = 0;
    for (const auto& record : aligned.records) {
        resistances.push_back(resistance_of(own_rows(record, aligned.fit, first), aligned.fit.resistance_ohm));
        first += used_samples(*record.record);
    }
    return resistances;
}

double resistance_scatter_ohm(std::span<const std::optional<FlightResistance>> resistances, double fitted_ohm) {
    std::vector<double> values_ohm;
    double error_ohm2 = 0.0;
    for (const auto& own : resistances) {
        if (!own) continue;
        values_ohm.push_back(own->value_ohm);
        error_ohm2 += std::pow(own->standard_error_ohm, 2);
    }
    double sum_ohm2 = std::pow(usual_scatter_part * fitted_ohm, 2);
    if (values_ohm.size() < 2) return std::sqrt(sum_ohm2);
    const auto n = static_cast<double>(values_ohm.size());
    sum_ohm2 += (n - 1.0) * std::max(0.0, sample_variance(values_ohm) - error_ohm2 / n);
    return std::sqrt(sum_ohm2 / n);
}

std::optional<ResistanceTrend> resistance_trend(std::span<const std::optional<FlightResistance>> in_order) {
    std::vector<double> number;
    std::vector<double> value_ohm;
    for (std::size_t i = 0; i < in_order.size(); ++i) {
        if (!in_order[i]) continue;
        number.push_back(static_cast<double>(i));
        value_ohm.push_back(in_order[i]->value_ohm);
    }
    constexpr std::size_t least_flights = 3;
    if (number.size() < least_flights) return std::nullopt;
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
        left += std::pow(value_ohm[i] - level_ohm - trend.ohm_a_flight * (number[i] - middle), 2);
    const double degrees_of_freedom = static_cast<double>(number.size()) - 2.0;
    const double half = student_t_half_width(degrees_of_freedom) * std::sqrt(left / degrees_of_freedom / squares);
    trend.interval_ohm_a_flight = {trend.ohm_a_flight - half, trend.ohm_a_flight + half};
    return trend;
}

}  // namespace flightwatt::battery
