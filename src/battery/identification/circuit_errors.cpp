#include "base/statistics.h"
#include "battery/identification/circuit_problem.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace flightwatt::battery {
namespace {

constexpr double unknown_log = 10.0;  // a factor of e^10: not determined

/// The common parameters of a fit, with the curve at every n-th of its knots.
Eigen::VectorXd common_values(const CircuitFit& fit, Eigen::Index n) {
    const auto knots = (std::ssize(fit.knots_ah) - 1) / n + 1;
    Eigen::VectorXd values = Eigen::VectorXd::Zero(knots + common_columns);
    for (Eigen::Index k = 0; k < knots; ++k) values[k] = fit.open_circuit_v[static_cast<std::size_t>(n * k)];
    values[knots + resistance_column] = fit.resistance_ohm;
    values[knots + rc_column] = fit.rc_resistance_ohm;
    values[knots + time_constant_column] = std::log(fit.rc_time_constant_s);
    return values;
}

}  // namespace

CircuitErrors circuit_errors(const JointCircuitFit& joint) {
    const auto& [fit, records] = std::tie(joint.fit, joint.records);
    const auto found = parameter_errors(normal_equations(joint, {}), fit.weights.sample_error_v);
    const auto knots = std::ssize(fit.knots_ah);
    const double t = student_t_half_width(found.degrees_of_freedom);
    // How far twice the segments move the parameters is the curve's model error.
    auto finer = joint;
    place_knots(finer, 2 * static_cast<int>(knots - 1));
    least_squares(finer, {});
    const Eigen::VectorXd half_width =
        t * found.common + (common_values(finer.fit, 2) - common_values(fit, 1)).cwiseAbs();
    const auto around = [](double value, double half) { return Interval{std::max(0.0, value - half), value + half}; };
    CircuitErrors errors;
    errors.resistance_ohm = around(fit.resistance_ohm, half_width[knots + resistance_column]);
    if (fit.rc_resistance_ohm > 0.0) {
        errors.rc_resistance_ohm = around(fit.rc_resistance_ohm, half_width[knots + rc_column]);
        const double factor = std::exp(std::min(unknown_log, half_width[knots + time_constant_column]));
        errors.rc_time_constant_s = {fit.rc_time_constant_s / factor, fit.rc_time_constant_s * factor};
    }
    // The error of a coarse sensor does not average out over slow changes.
    double resolution_v = 0.0;
    for (const auto& aligned : records) resolution_v = std::max(resolution_v, aligned.record->resolution_v);
    const Eigen::VectorXd of_knots =
        (half_width.head(knots) / normal_half_width()).cwiseMax(resolution_v / std::sqrt(12.0));
    errors.open_circuit_standard_error_v.assign(of_knots.begin(), of_knots.end());
    // Correlations are the jackknife's.
    const Eigen::MatrixXd unit = found.common_changes.topRows(knots).rowwise().normalized();
    errors.open_circuit_covariance_v2 = of_knots.asDiagonal() * (unit * unit.transpose()) * of_knots.asDiagonal();
    for (std::size_t r = 0; r < records.size(); ++r) {
        const double moved_ah = std::abs(finer.records[r].initial_charge_ah - records[r].initial_charge_ah);
        const double half_ah = t * found.own(charge_column, static_cast<Eigen::Index>(r)) + moved_ah;
        errors.initial_charge_error_ah.push_back(half_ah / normal_half_width());
    }
    return errors;
}

}  // namespace flightwatt::battery
