#include "battery/identification/circuit_problem.h"

#include "base/piecewise_linear.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace flightwatt::battery {
namespace {

constexpr int max_steps = 30;
constexpr int max_halvings = 3;
constexpr double min_block_s = 15.0;
constexpr double blocks_of_each = 12.0;
constexpr double more_blocks_of_one = 18.0;
// Weak priors: relative to the common resistance, and of a capacity's logarithm.
constexpr double own_resistance_sd_fraction = 1.0;
constexpr double log_capacity_sd = 0.3;
constexpr double mean_log_capacity_sd = 0.0003;  // of the sum: the curve is the mean flight's

double block_length_s(const DischargeRecord& record, std::size_t records) {
    const double length_s = record.time_s.back() - record.time_s.front();
    return std::max(min_block_s, length_s / (blocks_of_each + more_blocks_of_one / static_cast<double>(records)));
}

/// One used sample of a record at a fit.
struct SampleRow {
    double time_s = 0.0;
    Eigen::Index knot = 0;  ///< the one before it
    double fraction = 0.0;  ///< of the way to the next
    double slope = 0.0;     ///< of the curve [V/Ah]
    double drawn_ah = 0.0;
    double current_a = 0.0;
    double rc_a = 0.0;         ///< current of the RC pair's resistor
    double rc_change_a = 0.0;  ///< its derivative by the time constant's logarithm
    double rests = 0.0;        ///< 1 before the first load
    double residual_v = 0.0;   ///< measured less fitted
};

template <typename Visit>
void visit_rows(const JointCircuitFit& joint, std::size_t record_index, const Visit& visit) {
    const auto& fit = joint.fit;
    const auto& aligned = joint.records[record_index];
    const auto& record = *aligned.record;
    const bool has_rc = fit.rc_resistance_ohm > 0.0;
    const double capacity_scale = std::exp(-aligned.log_capacity);
    const double knot_step_ah = fit.knots_ah[1] - fit.knots_ah[0];
    const auto last_segment = static_cast<double>(fit.knots_ah.size() - 2);
    SampleRow row;
    row.rc_a = record.resting_current_a;
    for (std::size_t i = 0; i < record.used.size(); ++i) {
        if (has_rc && i > 0) {  // see rc_branch_current_a
            const double turns = (record.time_s[i] - record.time_s[i - 1]) / fit.rc_time_constant_s;
            const double decay = std::exp(-turns);
            const double above_a = row.rc_a - record.mean_current_a[i];
            row.rc_change_a = decay * (row.rc_change_a + above_a * turns);
            row.rc_a = record.mean_current_a[i] + above_a * decay;
        }
        if (!record.used[i]) continue;
        row.time_s = record.time_s[i];
        row.drawn_ah = capacity_scale * record.charge_ah[i];
        const double position = (aligned.initial_charge_ah + row.drawn_ah - fit.knots_ah[0]) / knot_step_ah;
        const double segment = std::clamp(std::floor(position), 0.0, last_segment);
        row.knot = static_cast<Eigen::Index>(segment);
        row.fraction = position - segment;
        const double from_v = fit.open_circuit_v[static_cast<std::size_t>(row.knot)];
        const double rise_v = fit.open_circuit_v[static_cast<std::size_t>(row.knot) + 1] - from_v;
        row.slope = rise_v / knot_step_ah;
        row.current_a = record.current_a[i];
        row.rests = i < record.rest_samples ? 1.0 : 0.0;
        row.residual_v = record.voltage_v[i] - from_v - row.fraction * rise_v + aligned.resistance_ohm * row.current_a +
                         fit.rc_resistance_ohm * row.rc_a - row.rests * aligned.rest_offset_v;
        visit(row);
    }
}

/// By the knots before and behind a sample, series resistance, RC resistance, time constant, rest, initial charge and
/// capacity.
using Derivatives = Eigen::Matrix<double, 8, 1>;

Derivatives derivatives_of(const SampleRow& row, double rc_resistance_ohm) {
    return {1.0 - row.fraction, row.fraction, -row.current_a,           -row.rc_a, -rc_resistance_ohm * row.rc_change_a,
            row.rests,          row.slope,    -row.slope * row.drawn_ah};
}

/// Sums over consecutive samples between the same knots.
struct RowSums {
    Eigen::Index knot = 0;
    Eigen::Matrix<double, 8, 8> normal = Eigen::Matrix<double, 8, 8>::Zero();
    Derivatives score = Derivatives::Zero();
};

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

/// The equations of a record's samples. Adds their squares to `objective`.
std::vector<Equations> block_equations(const JointCircuitFit& joint, std::size_t record_index,
                                       const FreeParameters& free, double& objective) {
    const auto& record = *joint.records[record_index].record;
    const auto knots = std::ssize(joint.fit.knots_ah);
    const auto own = knots + common_columns;
    const auto is = [](bool condition) { return condition ? 1.0 : 0.0; };
    const bool has_rc = joint.fit.rc_resistance_ohm > 0.0;
    const Derivatives is_free{1.0,
                              1.0,
                              1.0,
                              is(has_rc),
                              is(has_rc && free.time_constant),
                              1.0,
                              is(free.initial_charges && record_index != joint.reference),
                              is(free.own_capacities)};
    std::vector<Equations> blocks{zero_equations(own + own_columns)};
    RowSums sums;
    const auto add_sums = [&] {
        const std::array columns{sums.knot,
                                 sums.knot + 1,
                                 free.own_resistances ? own + own_resistance_column : knots + resistance_column,
                                 knots + rc_column,
                                 knots + time_constant_column,
                                 own + rest_column,
                                 own + charge_column,
                                 own + capacity_column};
        blocks.back().normal(columns, columns) += is_free.asDiagonal() * sums.normal * is_free.asDiagonal();
        blocks.back().pull(columns) += is_free.cwiseProduct(sums.score);
    };
    const double block_s = block_length_s(record, joint.records.size());
    std::optional<double> block;
    visit_rows(joint, record_index, [&](const SampleRow& row) {
        const double own_block = std::floor((row.time_s - record.time_s.front()) / block_s);
        const bool begins_block = block && own_block > *block;
        block = own_block;
        if (begins_block || row.knot != sums.knot) {
            add_sums();
            sums = {row.knot};
        }
        if (begins_block) blocks.push_back(zero_equations(own + own_columns));
        const auto derivatives = derivatives_of(row, joint.fit.rc_resistance_ohm);
        sums.normal.noalias() += derivatives * derivatives.transpose();
        sums.score += row.residual_v * derivatives;
        objective += row.residual_v * row.residual_v;
    });
    add_sums();
    return blocks;
}

/// The inverse of a symmetric matrix; zeros for parameters that are fixed.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& normal) {
    const Eigen::VectorXd length = normal.diagonal().cwiseAbs().cwiseSqrt();
    const Eigen::VectorXd scale = (length.array() > 0.0).select(length.cwiseInverse(), 0.0);
    Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
    scaled.diagonal() = (length.array() > 0.0).select(scaled.diagonal(), 1.0);
    return scale.asDiagonal() * scaled.ldlt().solve(Eigen::MatrixXd(scale.asDiagonal()));
}

/// A record's own parameters are own_inverse * pull - by_common * (the common ones).
struct EliminatedRecord {
    Eigen::MatrixXd own_inverse;
    Eigen::MatrixXd by_common;
};

/// Records are eliminated one by one (Schur complement), so that the cost is linear in them.
struct SolvedEquations {
    Eigen::MatrixXd common_inverse;
    std::vector<EliminatedRecord> records;
    ParameterStep step;
};

SolvedEquations solved(const NormalEquations& problem) {
    const auto common = problem.common_count();
    constexpr double ridge = 1.0 + 1e-10;  // parameters with little information remain
    auto [normal, pull] = problem.circuit;
    for (const auto& record : problem.records) normal += record.sum.normal.topLeftCorner(common, common);
    normal.diagonal() *= ridge;
    SolvedEquations result;
    for (const auto& [sum, blocks] : problem.records) {
        Eigen::MatrixXd own = sum.normal.bottomRightCorner(own_columns, own_columns);
        own.diagonal() *= ridge;
        auto& record = result.records.emplace_back(EliminatedRecord{inverse_of(own), {}});
        record.by_common = record.own_inverse * sum.normal.bottomLeftCorner(own_columns, common);
        normal -= sum.normal.topRightCorner(common, own_columns) * record.by_common;
        pull += sum.pull.head(common) - record.by_common.transpose() * sum.pull.tail(own_columns);
    }
    result.common_inverse = inverse_of(normal);
    auto& step = result.step;
    step.common = result.common_inverse * pull;
    step.own.resize(own_columns, std::ssize(problem.records));
    step.objective_change = -problem.circuit.pull.dot(step.common);
    for (Eigen::Index r = 0; r < step.own.cols(); ++r) {
        const auto& [own_inverse, by_common] = result.records[static_cast<std::size_t>(r)];
        const auto& record_pull = problem.records[static_cast<std::size_t>(r)].sum.pull;
        step.own.col(r) = own_inverse * record_pull.tail(own_columns) - by_common * step.common;
        step.objective_change -=
            record_pull.head(common).dot(step.common) + record_pull.tail(own_columns).dot(step.own.col(r));
    }
    return result;
}

/// The inverse of all equations in the columns of one record.
Eigen::MatrixXd inverse_in_columns_of(const EliminatedRecord& record, const Eigen::MatrixXd& common_inverse) {
    const auto common = common_inverse.rows();
    Eigen::MatrixXd inverse(common + own_columns, common + own_columns);
    const Eigen::MatrixXd across = -record.by_common * common_inverse;
    inverse << common_inverse, across.transpose(), across, record.own_inverse - across * record.by_common.transpose();
    return inverse;
}

/// A step, shortened to the range of the linearisation: a tenth of the curve, and a factor e of the time constant.
ParameterStep limited(ParameterStep step, const JointCircuitFit& joint) {
    constexpr double max_curve_fraction = 0.1;
    const auto& knots_ah = joint.fit.knots_ah;
    const double max_ah = max_curve_fraction * (knots_ah.back() - knots_ah.front());
    const double excess = std::max({1.0, std::abs(step.common[std::ssize(knots_ah) + time_constant_column]),
                                    step.own.row(charge_column).cwiseAbs().maxCoeff() / max_ah});
    step.common /= excess;
    step.own /= excess;
    return step;
}

JointCircuitFit moved(JointCircuitFit joint, const ParameterStep& step, const FreeParameters& free) {
    auto& fit = joint.fit;
    const auto knots = std::ssize(fit.knots_ah);
    Eigen::Map<Eigen::VectorXd>(fit.open_circuit_v.data(), knots) += step.common.head(knots);
    fit.common_rest_offset_v += step.common[knots + common_rest_column];
    fit.resistance_ohm += step.common[knots + resistance_column];
    fit.rc_resistance_ohm = std::max(0.0, fit.rc_resistance_ohm + step.common[knots + rc_column]);
    const double moved_s = fit.rc_time_constant_s * std::exp(step.common[knots + time_constant_column]);
    const auto& [min_s, max_s] = joint.time_constants_s;
    fit.rc_time_constant_s = fit.rc_resistance_ohm > 0.0 ? std::clamp(moved_s, min_s, max_s) : 0.0;
    for (std::size_t r = 0; r < joint.records.size(); ++r) {
        auto& aligned = joint.records[r];
        const auto own = step.own.col(static_cast<Eigen::Index>(r));
        aligned.rest_offset_v += own[rest_column];
        aligned.initial_charge_ah += own[charge_column];
        aligned.resistance_ohm +=
            free.own_resistances ? own[own_resistance_column] : step.common[knots + resistance_column];
        aligned.log_capacity += own[capacity_column];
    }
    return joint;
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
    visit_rows(joint, record, [&](const SampleRow& sample) { residual[row++] = sample.residual_v; });
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

ParameterStep step_of(const NormalEquations& problem) { return solved(problem).step; }

NormalEquations least_squares(JointCircuitFit& joint, const FreeParameters& free) {
    const FreeParameters linear{false, false, free.own_resistances, false};
    const bool is_linear = !free.initial_charges && !free.time_constant && !free.own_capacities;
    auto problem = normal_equations(joint, free);
    for (int i = 0; i < max_steps; ++i) {
        auto step = step_of(problem);
        constexpr double little = 1e-9;
        if (-step.objective_change < little * problem.objective) break;
        step = limited(std::move(step), joint);
        bool helps = false;
        for (int halved = 0; halved < max_halvings && !helps; ++halved) {
            auto tried = moved(joint, step, free);
            step.common /= 2.0;
            step.own /= 2.0;
            if (!is_linear) {
                place_knots(tried, static_cast<int>(joint.fit.knots_ah.size()) - 1);
                tried = moved(tried, step_of(normal_equations(tried, linear)), linear);
            }
            auto there = normal_equations(tried, free);
            helps = there.objective < problem.objective;
            if (!helps) continue;
            joint = std::move(tried);
            problem = std::move(there);
        }
        if (!helps) break;
    }
    return problem;
}

ParameterErrors parameter_errors(const NormalEquations& problem, double sample_error_v) {
    const auto common = problem.common_count();
    const auto [common_inverse, eliminated, step] = solved(problem);
    const auto free_count = [](const Eigen::MatrixXd& inverse) { return (inverse.diagonal().array() != 0.0).count(); };
    Eigen::Index count = 0;
    for (const auto& record : problem.records) count += std::ssize(record.blocks);
    const auto samples = static_cast<double>(count);
    ParameterErrors errors;
    errors.degrees_of_freedom = samples - 1.0 - static_cast<double>(free_count(common_inverse));
    // The changes without a block, (N - P)^-1 s, from the inverse of N in the columns of its record (Woodbury).
    Eigen::MatrixXd changes(common + own_columns, count);
    Eigen::Index column = 0;
    for (std::size_t r = 0; r < problem.records.size(); ++r) {
        const auto inverse = inverse_in_columns_of(eliminated[r], common_inverse);
        for (const auto& block : problem.records[r].blocks) {
            const Eigen::MatrixXd without =
                Eigen::MatrixXd::Identity(inverse.rows(), inverse.cols()) - block.normal * inverse;
            changes.col(column++) =
                -inverse * without.partialPivLu().solve(block.pull) * std::sqrt((samples - 1.0) / samples);
        }
    }
    const auto larger_of = [&](const Eigen::VectorXd& variance_v2, const Eigen::VectorXd& inverse_diagonal) {
        return variance_v2.cwiseSqrt().cwiseMax(inverse_diagonal.cwiseMax(0.0).cwiseSqrt() * sample_error_v).eval();
    };
    errors.common_changes = changes.topRows(common);
    errors.common = larger_of(errors.common_changes.rowwise().squaredNorm(), common_inverse.diagonal());
    errors.own.resize(own_columns, std::ssize(problem.records));
    const Eigen::MatrixXd all = errors.common_changes * errors.common_changes.transpose();
    column = 0;
    for (std::size_t r = 0; r < problem.records.size(); ++r) {
        const auto& [own_inverse, by_common] = eliminated[r];
        const auto of_record = changes.middleCols(column, std::ssize(problem.records[r].blocks));
        // Blocks of other records change it by the common parameters only.
        const Eigen::MatrixXd by_others = all - of_record.topRows(common) * of_record.topRows(common).transpose();
        errors.own.col(static_cast<Eigen::Index>(r)) =
            larger_of(of_record.bottomRows(own_columns).rowwise().squaredNorm() +
                          (by_common * by_others * by_common.transpose()).diagonal(),
                      inverse_in_columns_of(eliminated[r], common_inverse).diagonal().tail(own_columns));
        errors.degrees_of_freedom -= static_cast<double>(free_count(own_inverse));
        column += of_record.cols();
    }
    return errors;
}

}  // namespace flightwatt::battery
