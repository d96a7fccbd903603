#include "base/statistics.h"
#include "battery/identification/aligned_fit.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace flightwatt::battery {
namespace {

constexpr double unknown_log = 10.0;  // a factor of e^10: not determined

/// The changes of the parameters with twice the segments: the curve's model error.
struct FinerCurveChanges {
    Eigen::VectorXd common;
    Eigen::VectorXd initial_charge_ah;
};

FinerCurveChanges changes_by_finer_curve(const JointCircuitFit& joint) {
    auto finer = joint;
    const auto knots = std::ssize(joint.fit.knots_ah);
    place_knots(finer, 2 * static_cast<int>(knots - 1));
    least_squares(finer, {});
    const auto& [before, after] = std::tie(joint.fit, finer.fit);
    FinerCurveChanges changes{Eigen::VectorXd::Zero(knots + common_columns),
                              Eigen::VectorXd(std::ssize(joint.records))};
    for (Eigen::Index k = 0; k < knots; ++k) {
        const auto knot = static_cast<std::size_t>(k);
        changes.common[k] = after.open_circuit_v[2 * knot] - before.open_circuit_v[knot];
    }
    changes.common[knots + resistance_column] = after.resistance_ohm - before.resistance_ohm;
    changes.common[knots + rc_column] = after.rc_resistance_ohm - before.rc_resistance_ohm;
    changes.common[knots + time_constant_column] =
        after.rc_time_constant_s > 0.0 ? std::log(after.rc_time_constant_s / before.rc_time_constant_s) : unknown_log;
    for (std::size_t r = 0; r < joint.records.size(); ++r)
        changes.initial_charge_ah[static_cast<Eigen::Index>(r)] =
            finer.records[r].initial_charge_ah - joint.records[r].initial_charge_ah;
    return changes;
}

}  // namespace

CircuitErrors circuit_errors(const JointCircuitFit& joint) {
    const auto& [fit, records] = std::tie(joint.fit, joint.records);
    const auto found = parameter_errors(normal_equations(joint, {}), fit.weights.sample_error_v);
    const auto knots = std::ssize(fit.knots_ah);
    const double t = student_t_half_width(found.degrees_of_freedom);
    const auto finer = changes_by_finer_curve(joint);
    const Eigen::VectorXd half_width = t * found.common + finer.common.cwiseAbs();
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
    const Eigen::VectorXd charge_error_ah =
        (t * found.own.row(charge_column).transpose() + finer.initial_charge_ah.cwiseAbs()) / normal_half_width();
    errors.initial_charge_error_ah.assign(charge_error_ah.begin(), charge_error_ah.end());
    return errors;
}

}  // namespace flightwatt::battery
