// The normal equations of a circuit and its records: of their samples and of the priors.

#include "base/piecewise_linear.h"
#include "battery/identification/circuit_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace flightwatt::battery {
namespace {

constexpr double min_block_s = 15.0;
constexpr double blocks_of_each = 12.0;
constexpr double more_blocks_of_one = 18.0;
// Weak priors: relative to the common resistance, and of a capacity's logarithm.
constexpr double own_resistance_sd_fraction = 1.0;
constexpr double log_capacity_sd = 0.3;
constexpr double min_span_wh = 0.01;
constexpr double mean_log_capacity_sd = 0.0003;  // of the sum: the curve is the mean flight's

/// By the knots before and behind a sample, series resistance, RC resistance, the time constant's logarithm, rest,
/// initial charge, the capacity's logarithm and the warming.
using Derivatives = Eigen::Matrix<double, 9, 1>;

/// Calls `visit` with the index, the knot before it, the derivatives and the residual of each used sample.
template <typename Visit>
void visit_rows(const JointCircuitFit& joint, std::size_t record_index, const Visit& visit) {
    const auto& fit = joint.fit;
    const auto& aligned = joint.records[record_index];
    const auto& record = *aligned.record;
    const double rc_ohm = fit.rc_resistance_ohm;
    const double capacity_scale = std::exp(-aligned.log_capacity);
    const double step_ah = fit.knots_ah[1] - fit.knots_ah[0];
    const auto last_segment = static_cast<double>(fit.knots_ah.size() - 2);
    double rc_a = record.resting_current_a;  // in the RC pair's resistor, see rc_branch_current_a
    double rc_change_a = 0.0;                // its derivative by the time constant's logarithm
    const auto heat = heat_a2s(record);
    Derivatives derivatives;
    for (std::size_t i = 0; i < record.used.size(); ++i) {
        if (rc_ohm > 0.0 && i > 0) {
            const double turns = (record.time_s[i] - record.time_s[i - 1]) / fit.rc_time_constant_s;
            const double decay = std::exp(-turns);
            const double above_a = rc_a - record.mean_current_a[i];
            rc_change_a = decay * (rc_change_a + above_a * turns);
            rc_a = record.mean_current_a[i] + above_a * decay;
        }
        if (!record.used[i]) continue;
        const double drawn_ah = capacity_scale * record.charge_ah[i];
        const double position = (aligned.initial_charge_ah + drawn_ah - fit.knots_ah[0]) / step_ah;
        const double segment = std::clamp(std::floor(position), 0.0, last_segment);
        const double fraction = position - segment;
        const auto knot = static_cast<std::size_t>(segment);
        const double from_v = fit.open_circuit_v[knot];
        const double rise_v = fit.open_circuit_v[knot + 1] - from_v;
        const double slope = rise_v / step_ah;
        const double rests = i < record.rest_samples ? 1.0 : 0.0;
        const double after_half_a2s = heat[i] - 0.5 * heat.back();
        const double warmed = fit.warming_per_j * aligned.resistance_ohm * after_half_a2s;
        const double per_ohm_v = -record.current_a[i] * std::exp(-warmed);
        const double over_resistance_v = aligned.resistance_ohm * per_ohm_v;
        derivatives << 1.0 - fraction, fraction, per_ohm_v * (1.0 - warmed), -rc_a, -rc_ohm * rc_change_a, rests, slope,
            -slope * drawn_ah, -over_resistance_v * aligned.resistance_ohm * after_half_a2s;
        const double fitted_v =
            from_v + fraction * rise_v + over_resistance_v - rc_ohm * rc_a + rests * aligned.rest_offset_v;
        visit(i, static_cast<Eigen::Index>(knot), derivatives, record.voltage_v[i] - fitted_v);
    }
}

Equations zero_equations(Eigen::Index columns) {
    return {Eigen::MatrixXd::Zero(columns, columns), Eigen::VectorXd::Zero(columns)};
}

/// A sum of parameters, each times its factor.
using Terms = std::vector<std::pair<Eigen::Index, double>>;

/// Adds a prior: a sum of parameters is `difference` below its mean, with this standard deviation in samples' errors.
/// Returns its square.
double add_prior(Equations& equations, const Terms& terms, double difference, double sd_samples) {
    const double weight = 1.0 / (sd_samples * sd_samples);
    for (const auto& [i, factor] : terms) {
        for (const auto& [j, other] : terms) equations.normal(i, j) += weight * factor * other;
        equations.pull[i] += weight * factor * difference;
    }
    return weight * difference * difference;
}

void add_circuit_prior(const JointCircuitFit& joint, const FreeParameters& free, NormalEquations& problem) {
    const auto& fit = joint.fit;
    const auto knots = std::ssize(fit.knots_ah);
    const double cells_per_error = fit.weights.cells / fit.weights.sample_error_v;
    auto& circuit = problem.circuit;
    problem.objective += add_prior(circuit, {{knots + common_rest_column, 1.0}}, -fit.common_rest_offset_v,
                                   common_rest_sd_v * cells_per_error);
    for (Eigen::Index k = 2; k < knots; ++k) {
        const auto* curve_v = fit.open_circuit_v.data() + k;
        problem.objective +=
            add_prior(circuit, {{k - 2, 1.0}, {k - 1, -2.0}, {k, 1.0}}, -(curve_v[-2] - 2.0 * curve_v[-1] + curve_v[0]),
                      slope_change_sd_v * cells_per_error);
    }
    const double span_wh = fit.weights.fullest_rest_v * (fit.knots_ah.back() - fit.knots_ah.front());
    if (free.time_constant)
        problem.objective +=
            add_prior(circuit, {{knots + warming_column, 1.0}}, -fit.warming_per_j,
                      warming_sd_wh_per_j / std::max(min_span_wh, span_wh) / fit.weights.sample_error_v);
    if (!free.own_capacities) return;
    double sum = 0.0;
    for (const auto& aligned : joint.records) sum += aligned.log_capacity;
    const double variance = std::pow(mean_log_capacity_sd / fit.weights.sample_error_v, 2);
    circuit.normal(knots + capacity_sum_column, knots + capacity_sum_column) = -variance;
    circuit.pull[knots + capacity_sum_column] = -sum;
    problem.objective += sum * sum / variance;
}

/// Returns its square.
double add_record_prior(const JointCircuitFit& joint, std::size_t record, const FreeParameters& free,
                        Equations& equations) {
    const auto& fit = joint.fit;
    const auto& aligned = joint.records[record];
    const auto knots = std::ssize(fit.knots_ah);
    const auto own = knots + common_columns;
    const double error_v = fit.weights.sample_error_v;
    const double lower_v = std::max(0.0, fit.weights.fullest_rest_v - aligned.record->resting_voltage_v);
    const double rest_sd_v = std::hypot(charged_rest_sd_v * fit.weights.cells, lower_rest_fraction * lower_v);
    double square = add_prior(equations, {{own + rest_column, 1.0}, {knots + common_rest_column, -1.0}},
                              fit.common_rest_offset_v - aligned.rest_offset_v, rest_sd_v / error_v);
    if (free.own_resistances)
        square +=
            add_prior(equations, {{own + own_resistance_column, 1.0}}, fit.resistance_ohm - aligned.resistance_ohm,
                      own_resistance_sd_fraction * fit.resistance_ohm / error_v);
    if (!free.own_capacities) return square;
    equations.normal(own + capacity_column, knots + capacity_sum_column) = 1.0;
    equations.normal(knots + capacity_sum_column, own + capacity_column) = 1.0;
    return square +
           add_prior(equations, {{own + capacity_column, 1.0}}, -aligned.log_capacity, log_capacity_sd / error_v);
}

/// Sums over consecutive samples between the same knots.
struct RowSums {
    Eigen::Index knot = 0;
    Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
    Derivatives score = Derivatives::Zero();
};

/// The equations of a record's samples. Adds their squares to `objective`.
std::vector<Equations> block_equations(const JointCircuitFit& joint, std::size_t record_index,
                                       const FreeParameters& free, double& objective) {
    const auto& record = *joint.records[record_index].record;
    const auto knots = std::ssize(joint.fit.knots_ah);
    const auto own = knots + common_columns;
    const bool has_rc = joint.fit.rc_resistance_ohm > 0.0;
    Eigen::Array<bool, 9, 1> is_free;
    is_free << true, true, true, has_rc, has_rc && free.time_constant, true,
        free.initial_charges && record_index != joint.reference, free.own_capacities, free.time_constant;
    const Derivatives mask = is_free.cast<double>();
    Eigen::Array<Eigen::Index, 9, 1> columns;
    columns << 0, 0, free.own_resistances ? own + own_resistance_column : knots + resistance_column, knots + rc_column,
        knots + time_constant_column, own + rest_column, own + charge_column, own + capacity_column,
        knots + warming_column;
    std::vector<Equations> blocks{zero_equations(own + own_columns)};
    RowSums sums;
    const auto add_sums = [&] {
        columns[0] = sums.knot;
        columns[1] = sums.knot + 1;
        blocks.back().normal(columns, columns) += mask.asDiagonal() * sums.normal * mask.asDiagonal();
        blocks.back().pull(columns) += mask.cwiseProduct(sums.score);
    };
    const double length_s = record.time_s.back() - record.time_s.front();
    const double block_s = std::max(
        min_block_s, length_s / (blocks_of_each + more_blocks_of_one / static_cast<double>(joint.records.size())));
    std::optional<double> block;
    visit_rows(joint, record_index, [&](std::size_t i, auto knot, const Derivatives& derivatives, double residual_v) {
        const double own_block = std::floor((record.time_s[i] - record.time_s.front()) / block_s);
        const bool begins_block = block && own_block > *block;
        block = own_block;
        if (begins_block || knot != sums.knot) {
            add_sums();
            sums = {knot};
        }
        if (begins_block) blocks.push_back(zero_equations(own + own_columns));
        sums.normal.noalias() += derivatives * derivatives.transpose();
        sums.score += residual_v * derivatives;
        objective += residual_v * residual_v;
    });
    add_sums();
    return blocks;
}

}  // namespace

void place_knots(JointCircuitFit& joint, int segments) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const auto& aligned : joint.records) {
        const double scale = std::exp(-aligned.log_capacity);
        const auto [min, max] = std::ranges::minmax_element(aligned.record->charge_ah);
        // A counter that falls has drifted.
        low = std::min(low, aligned.initial_charge_ah + scale * std::max(0.0, *min));
        high = std::max(high, aligned.initial_charge_ah + scale * *max);
    }
    auto& fit = joint.fit;
    std::vector<double> knots_ah;
    std::vector<double> voltage_v;
    for (int i = 0; i <= segments; ++i) {
        knots_ah.push_back(std::lerp(low, high, static_cast<double>(i) / segments));
        voltage_v.push_back(
            fit.knots_ah.empty() ? 0.0 : interpolate_extended(fit.knots_ah, fit.open_circuit_v, knots_ah.back()));
    }
    fit.knots_ah = std::move(knots_ah);
    fit.open_circuit_v = std::move(voltage_v);
}

Eigen::VectorXd residual_v(const JointCircuitFit& joint, std::size_t record) {
    Eigen::VectorXd residual(used_sample_count(*joint.records[record].record));
    Eigen::Index row = 0;
    visit_rows(joint, record, [&](auto, auto, const auto&, double own_v) { residual[row++] = own_v; });
    return residual;
}

NormalEquations normal_equations(const JointCircuitFit& joint, const FreeParameters& free) {
    const auto common = std::ssize(joint.fit.knots_ah) + common_columns;
    NormalEquations problem{zero_equations(common), {}, 0.0};
    add_circuit_prior(joint, free, problem);
    for (std::size_t r = 0; r < joint.records.size(); ++r) {
        auto& [sum, blocks] = problem.records.emplace_back(RecordEquations{zero_equations(common + own_columns), {}});
        problem.objective += add_record_prior(joint, r, free, sum);
        blocks = block_equations(joint, r, free, problem.objective);
        for (const auto& block : blocks) {
            sum.normal += block.normal;
            sum.pull += block.pull;
        }
    }
    return problem;
}

}  // namespace flightwatt::battery
