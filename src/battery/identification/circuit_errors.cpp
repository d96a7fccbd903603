#include "base/statistics.h"
#include "battery/identification/aligned_fit.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace flightwatt::battery {
namespace {

constexpr double unknown_log = 10.0;  // a factor of e^10: not determined

/// The change of the parameters with twice the segments: the curve's model error.
Eigen::VectorXd moved_by_finer_curve(const JointCircuitFit& joint, const ParameterIndices& places) {
    auto finer = joint;
    place_knots(finer, 2 * static_cast<int>(places.knots - 1));
    least_squares(finer, {});
    const auto& [before, after] = std::tie(joint.fit, finer.fit);
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(places.count);
    for (Eigen::Index k = 0; k < places.knots; ++k) {
        const auto knot = static_cast<std::size_t>(k);
        moved[places.first_knot + k] = after.open_circuit_v[2 * knot] - before.open_circuit_v[knot];
    }
    moved[places.resistance] = after.resistance_ohm - before.resistance_ohm;
    moved[places.rc_resistance] = after.rc_resistance_ohm - before.rc_resistance_ohm;
    moved[places.log_time_constant] =
        after.rc_time_constant_s > 0.0 ? std::log(after.rc_time_constant_s / before.rc_time_constant_s) : unknown_log;
    for (std::size_t r = 0; r < places.own.size(); ++r)
        moved[places.own[r].initial_charge] = finer.records[r].initial_charge_ah - joint.records[r].initial_charge_ah;
    return moved;
}

}  // namespace

CircuitErrors circuit_errors(const JointCircuitFit& joint) {
    const auto& [fit, records] = std::tie(joint.fit, joint.records);
    const auto problem = normal_equations(joint, {});
    const auto& places = problem.places;
    const auto found = parameter_errors(problem, fit.weights.sample_error_v);
    const double t = student_t_half_width(static_cast<double>(std::ssize(problem.blocks) - places.count));
    const Eigen::VectorXd half_width = t * found.standard_error + moved_by_finer_curve(joint, places).cwiseAbs();
    const auto around = [](double value, double half) { return Interval{std::max(0.0, value - half), value + half}; };
    CircuitErrors errors;
    errors.resistance_ohm = around(fit.resistance_ohm, half_width[places.resistance]);
    if (fit.rc_resistance_ohm > 0.0) {
        errors.rc_resistance_ohm = around(fit.rc_resistance_ohm, half_width[places.rc_resistance]);
        const double factor = std::exp(std::min(unknown_log, half_width[places.log_time_constant]));
        errors.rc_time_constant_s = {fit.rc_time_constant_s / factor, fit.rc_time_constant_s * factor};
    }
    const Eigen::VectorXd standard_error = half_width / normal_half_width();
    // The error of a coarse sensor does not average out over slow changes.
    double resolution_v = 0.0;
    for (const auto& aligned : records) resolution_v = std::max(resolution_v, aligned.record->resolution_v);
    const Eigen::VectorXd of_knots =
        standard_error.segment(places.first_knot, places.knots).cwiseMax(resolution_v / std::sqrt(12.0));
    errors.open_circuit_standard_error_v.assign(of_knots.begin(), of_knots.end());
    // Correlations are the jackknife's.
    const Eigen::MatrixXd unit = found.changes.middleRows(places.first_knot, places.knots).rowwise().normalized();
    errors.open_circuit_covariance_v2 = of_knots.asDiagonal() * (unit * unit.transpose()) * of_knots.asDiagonal();
    for (const auto& own : places.own)
        errors.initial_charge_error_ah.push_back(own.initial_charge == 0 ? 0.0 : standard_error[own.initial_charge]);
    return errors;
}

}  // namespace flightwatt::battery
