#include "battery/identification/circuit_problem.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace flightwatt::battery {
namespace {

constexpr int max_steps = 30;
constexpr int max_halvings = 3;
constexpr double negligible_gain = 0.01;  // in squares of a sample's error: a tenth of a standard error, or less

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
    fit.warming_per_j = std::max(0.0, fit.warming_per_j + step.common[knots + warming_column]);
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
        double gain_v2 = 0.0;
        for (int halved = 0; halved < max_halvings && !(gain_v2 > 0.0); ++halved) {
            auto tried = moved(joint, step, free);
            step.common /= 2.0;
            step.own /= 2.0;
            if (!is_linear) {
                place_knots(tried, static_cast<int>(joint.fit.knots_ah.size()) - 1);
                tried = moved(tried, step_of(normal_equations(tried, linear)), linear);
            }
            auto there = normal_equations(tried, free);
            gain_v2 = problem.objective - there.objective;
            if (!(gain_v2 > 0.0)) continue;
            joint = std::move(tried);
            problem = std::move(there);
        }
        if (!(gain_v2 > negligible_gain * joint.fit.weights.sample_error_v * joint.fit.weights.sample_error_v)) break;
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
