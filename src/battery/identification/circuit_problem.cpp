#include "battery/identification/circuit_problem.h"

#include "base/piecewise_linear.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace flightwatt::battery {
namespace {

constexpr int max_steps = 30;
constexpr int max_halvings = 6;
constexpr double min_block_s = 15.0;
constexpr double blocks_of_each = 12.0;
constexpr double more_blocks_of_one = 18.0;
// Weak priors: relative to the common resistance, and of a capacity's logarithm.
constexpr double own_resistance_sd_fraction = 1.0;
constexpr double log_capacity_sd = 0.3;
constexpr double mean_log_capacity_sd = 0.0003;  // of the sum: the curve is the mean flight's

ParameterIndices indices_of(const JointCircuitFit& joint, const FreeParameters& free) {
    ParameterIndices places;
    places.knots = std::ssize(joint.fit.knots_ah);
    Eigen::Index next = places.first_knot + places.knots;
    const auto place = [&](bool is_free) { return is_free ? next++ : Eigen::Index{0}; };
    const bool has_rc = joint.fit.rc_resistance_ohm > 0.0;
    places.common_rest = place(true);
    places.resistance = place(!free.own_resistances);
    places.rc_resistance = place(has_rc);
    places.log_time_constant = place(has_rc && free.time_constant);
    for (std::size_t r = 0; r < joint.records.size(); ++r) {
        ParameterIndices::Own own;
        own.rest = place(true);
        own.initial_charge = place(free.initial_charges && r != joint.reference);
        own.resistance = free.own_resistances ? place(true) : places.resistance;
        own.log_capacity = place(free.own_capacities);
        places.own.push_back(own);
    }
    places.count = next;
    return places;
}

/// The RC pair's current.
Eigen::VectorXd branch_current_a(const DischargeRecord& record, double time_constant_s) {
    const auto samples = rc_branch_current_a(record, time_constant_s);
    return Eigen::Map<const Eigen::VectorXd>(samples.data(), std::ssize(samples));
}

/// Ends of the blocks of a record's time, in used samples.
std::vector<Eigen::Index> block_ends(const DischargeRecord& record, std::size_t records) {
    const double length_s = record.time_s.back() - record.time_s.front();
    const double block_s =
        std::max(min_block_s, length_s / (blocks_of_each + more_blocks_of_one / static_cast<double>(records)));
    std::vector<Eigen::Index> ends;
    Eigen::Index row = 0;
    double block = 0.0;
    for (std::size_t i = 0; i < record.used.size(); ++i) {
        if (!record.used[i]) continue;
        const double in_block = std::floor((record.time_s[i] - record.time_s.front()) / block_s);
        if (in_block > block && row > 0) ends.push_back(row);
        block = in_block;
        ++row;
    }
    ends.push_back(row);
    return ends;
}

/// A sum of parameters, each times its factor.
using Terms = std::vector<std::pair<Eigen::Index, double>>;

/// Adds a prior: a sum of parameters is `difference` below its mean, with this standard deviation in samples' errors.
void add_prior(NormalEquations& problem, const Terms& terms, double difference, double sd_samples) {
    const double weight = 1.0 / (sd_samples * sd_samples);
    for (const auto& [i, factor] : terms) {
        for (const auto& [j, other] : terms) problem.normal(i, j) += weight * factor * other;
        problem.pull[i] += weight * factor * difference;
    }
    problem.objective += weight * difference * difference;
}

void add_circuit_prior(const JointCircuitFit& joint, NormalEquations& problem) {
    const auto& fit = joint.fit;
    const auto& places = problem.places;
    const double cells_per_error = fit.weights.cells / fit.weights.sample_error_v;
    add_prior(problem, {{places.common_rest, 1.0}}, -fit.common_rest_offset_v, common_rest_sd_v * cells_per_error);
    for (std::size_t k = 2; k < fit.open_circuit_v.size(); ++k) {
        const auto last = places.first_knot + static_cast<Eigen::Index>(k);
        const double bend_v = fit.open_circuit_v[k - 2] - 2.0 * fit.open_circuit_v[k - 1] + fit.open_circuit_v[k];
        add_prior(problem, {{last - 2, 1.0}, {last - 1, -2.0}, {last, 1.0}}, -bend_v,
                  slope_change_sd_v * cells_per_error);
    }
}

void add_records_prior(const JointCircuitFit& joint, const FreeParameters& free, NormalEquations& problem) {
    const auto& fit = joint.fit;
    const auto& places = problem.places;
    const double error_v = fit.weights.sample_error_v;
    Terms all_capacities;
    double sum = 0.0;
    for (std::size_t r = 0; r < joint.records.size(); ++r) {
        const auto& aligned = joint.records[r];
        const auto& own = places.own[r];
        const double lower_v = std::max(0.0, fit.weights.fullest_rest_v - aligned.record->resting_voltage_v);
        const double rest_sd_v = std::hypot(charged_rest_sd_v * fit.weights.cells, lower_rest_fraction * lower_v);
        add_prior(problem, {{own.rest, 1.0}, {places.common_rest, -1.0}},
                  fit.common_rest_offset_v - aligned.rest_offset_v, rest_sd_v / error_v);
        if (free.own_resistances) {
            add_prior(problem, {{own.resistance, 1.0}}, fit.resistance_ohm - aligned.resistance_ohm,
                      own_resistance_sd_fraction * fit.resistance_ohm / error_v);
        }
        if (!free.own_capacities) continue;
        add_prior(problem, {{own.log_capacity, 1.0}}, -aligned.log_capacity, log_capacity_sd / error_v);
        all_capacities.emplace_back(own.log_capacity, 1.0);
        sum += aligned.log_capacity;
    }
    add_prior(problem, all_capacities, -sum, mean_log_capacity_sd / error_v);
}

/// The inverse of the normal matrix times `right`, with parameters scaled to length 1; parameters without information
/// remain.
Eigen::MatrixXd solved(const Eigen::MatrixXd& normal, const Eigen::MatrixXd& right) {
    const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseMax(1e-12).cwiseInverse();
    Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
    constexpr double ridge = 1e-10;
    scaled.diagonal().array() += ridge;
    return scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * right);
}

/// A step, shortened to the range of the linearisation: a tenth of the curve, and a factor e of the time constant.
Eigen::VectorXd limited(Eigen::VectorXd step, const JointCircuitFit& joint, const ParameterIndices& places) {
    constexpr double max_curve_fraction = 0.1;
    const double max_ah = max_curve_fraction * (joint.fit.knots_ah.back() - joint.fit.knots_ah.front());
    double excess = std::max(1.0, std::abs(step[places.log_time_constant]));
    for (const auto& own : places.own) excess = std::max(excess, std::abs(step[own.initial_charge]) / max_ah);
    return step / excess;
}

JointCircuitFit moved(JointCircuitFit joint, const ParameterIndices& places, const Eigen::VectorXd& step) {
    auto& fit = joint.fit;
    for (Eigen::Index k = 0; k < places.knots; ++k)
        fit.open_circuit_v[static_cast<std::size_t>(k)] += step[places.first_knot + k];
    fit.common_rest_offset_v += step[places.common_rest];
    fit.resistance_ohm += step[places.resistance];
    fit.rc_resistance_ohm = std::max(0.0, fit.rc_resistance_ohm + step[places.rc_resistance]);
    const double moved_s = fit.rc_time_constant_s * std::exp(step[places.log_time_constant]);
    const auto& [min_s, max_s] = joint.time_constants_s;
    fit.rc_time_constant_s = fit.rc_resistance_ohm > 0.0 ? std::clamp(moved_s, min_s, max_s) : 0.0;
    for (std::size_t r = 0; r < joint.records.size(); ++r) {
        auto& aligned = joint.records[r];
        const auto& own = places.own[r];
        aligned.rest_offset_v += step[own.rest];
        aligned.initial_charge_ah += step[own.initial_charge];
        aligned.resistance_ohm += step[own.resistance];
        aligned.log_capacity += step[own.log_capacity];
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

RecordRows rows_of(const JointCircuitFit& joint, std::size_t record_index, const FreeParameters& free) {
    const auto& fit = joint.fit;
    const auto& aligned = joint.records[record_index];
    const auto& record = *aligned.record;
    const auto own = std::ssize(fit.knots_ah);
    Eigen::VectorXd rc_a = Eigen::VectorXd::Zero(std::ssize(record.time_s));
    Eigen::VectorXd rc_change_a = rc_a;  // by the time constant's logarithm
    if (fit.rc_resistance_ohm > 0.0) {
        rc_a = branch_current_a(record, fit.rc_time_constant_s);
        constexpr double log_step = 1e-4;
        if (free.time_constant) {
            rc_change_a = (branch_current_a(record, fit.rc_time_constant_s * std::exp(log_step)) -
                           branch_current_a(record, fit.rc_time_constant_s * std::exp(-log_step))) /
                          (2.0 * log_step);
        }
    }
    const double scale = std::exp(-aligned.log_capacity);
    const auto samples = used_sample_count(record);
    RecordRows rows{Eigen::MatrixXd::Zero(samples, own + own_columns), Eigen::VectorXd(samples),
                    Eigen::VectorXd(samples)};
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < record.used.size(); ++i) {
        if (!record.used[i]) continue;
        const auto sample = static_cast<Eigen::Index>(i);
        const double drawn_ah = scale * record.charge_ah[i];
        rows.charge_ah[row] = aligned.initial_charge_ah + drawn_ah;
        const auto [lower, fraction] = find_knot_interval(fit.knots_ah, rows.charge_ah[row]);
        const double from_v = fit.open_circuit_v[lower];
        const double to_v = fit.open_circuit_v[lower + 1];
        const double slope = (to_v - from_v) / (fit.knots_ah[lower + 1] - fit.knots_ah[lower]);
        const double rests = i < record.rest_samples ? 1.0 : 0.0;
        auto columns = rows.columns.row(row);
        columns[static_cast<Eigen::Index>(lower)] = 1.0 - fraction;
        columns[static_cast<Eigen::Index>(lower) + 1] = fraction;
        columns[own + rc_column] = -rc_a[sample];
        columns[own + time_constant_column] = -fit.rc_resistance_ohm * rc_change_a[sample];
        columns[own + rest_column] = rests;
        columns[own + charge_column] = slope;
        columns[own + resistance_column] = -record.current_a[i];
        columns[own + capacity_column] = -slope * drawn_ah;
        rows.residual_v[row++] = record.voltage_v[i] - std::lerp(from_v, to_v, fraction) +
                                 aligned.resistance_ohm * record.current_a[i] + fit.rc_resistance_ohm * rc_a[sample] -
                                 rests * aligned.rest_offset_v;
    }
    return rows;
}

std::vector<Eigen::Index> NormalEquations::columns_of(std::size_t record) const {
    std::vector<Eigen::Index> columns(static_cast<std::size_t>(places.knots));
    std::iota(columns.begin(), columns.end(), places.first_knot);
    const auto& own = places.own[record];
    columns.insert(columns.end(), {places.rc_resistance, places.log_time_constant, own.rest, own.initial_charge,
                                   own.resistance, own.log_capacity});
    return columns;
}

NormalEquations normal_equations(const JointCircuitFit& joint, const FreeParameters& free) {
    NormalEquations problem;
    problem.places = indices_of(joint, free);
    const auto count = problem.places.count;
    problem.normal = Eigen::MatrixXd::Zero(count, count);
    problem.pull = Eigen::VectorXd::Zero(count);
    add_circuit_prior(joint, problem);
    add_records_prior(joint, free, problem);
    for (std::size_t r = 0; r < joint.records.size(); ++r) {
        const auto rows = rows_of(joint, r, free);
        const auto columns = problem.columns_of(r);
        problem.objective += rows.residual_v.squaredNorm();
        Eigen::Index first = 0;
        for (const auto end : block_ends(*joint.records[r].record, joint.records.size())) {
            const auto part = rows.columns.middleRows(first, end - first);
            RowBlock block{r, first, end - first, part.transpose() * part,
                           part.transpose() * rows.residual_v.segment(first, end - first)};
            problem.normal(columns, columns) += block.normal;
            problem.pull(columns) += block.score;
            problem.blocks.push_back(std::move(block));
            first = end;
        }
    }
    problem.normal.row(0).setZero();
    problem.normal.col(0).setZero();
    problem.normal(0, 0) = 1.0;
    problem.pull[0] = 0.0;
    return problem;
}

Eigen::VectorXd step_of(const NormalEquations& problem) { return solved(problem.normal, problem.pull); }

NormalEquations least_squares(JointCircuitFit& joint, const FreeParameters& free) {
    const FreeParameters linear{false, false, free.own_resistances, false};
    const bool is_linear = !free.initial_charges && !free.time_constant && !free.own_capacities;
    auto problem = normal_equations(joint, free);
    for (int i = 0; i < max_steps; ++i) {
        auto step = step_of(problem);
        constexpr double little = 1e-9;
        if (problem.pull.dot(step) < little * problem.objective) break;
        step = limited(std::move(step), joint, problem.places);
        bool helps = false;
        for (int halved = 0; halved < max_halvings && !helps; ++halved, step /= 2.0) {
            auto tried = moved(joint, problem.places, step);
            if (!is_linear) {
                place_knots(tried, static_cast<int>(problem.places.knots) - 1);
                const auto at_once = normal_equations(tried, linear);
                tried = moved(std::move(tried), at_once.places, step_of(at_once));
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
    Eigen::MatrixXd all_free = Eigen::MatrixXd::Identity(problem.places.count, problem.places.count);
    all_free(0, 0) = 0.0;
    const auto inverse = solved(problem.normal, all_free);
    const auto count = static_cast<double>(problem.blocks.size());
    ParameterErrors errors;
    errors.changes.resize(problem.places.count, std::ssize(problem.blocks));
    for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
        // The change without a block, (N - P)^-1 s, from the inverse of N, as P has the record's columns only
        // (Woodbury).
        const auto& block = problem.blocks[b];
        const auto columns = problem.columns_of(block.record);
        const Eigen::MatrixXd across = inverse(Eigen::all, columns);
        const Eigen::MatrixXd without = Eigen::MatrixXd::Identity(block.normal.rows(), block.normal.cols()) -
                                        block.normal * across(columns, Eigen::all);
        errors.changes.col(static_cast<Eigen::Index>(b)) =
            -across * without.partialPivLu().solve(block.score) * std::sqrt((count - 1.0) / count);
    }
    errors.standard_error =
        errors.changes.rowwise().norm().cwiseMax(inverse.diagonal().cwiseMax(0.0).cwiseSqrt() * sample_error_v);
    return errors;
}

}  // namespace flightwatt::battery
