#include "base/statistics.h"
#include "battery/identification/aligned_fit.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace flightwatt::battery {
namespace {

constexpr double wanted_blocks = 30.0;  // of one record; each further one adds a dozen, for its own parameters
constexpr double more_blocks = 12.0;
constexpr double shortest_block_s = 15.0;
constexpr std::size_t enough_records = 3;
constexpr double tells_nothing = 10.0;  // of a logarithm: beyond a factor e^10 an interval is all there is

/// Rows that follow each other, and by how much rounding may be off throughout.
struct Block {
    std::size_t record = 0;
    Eigen::Index first = 0;
    Eigen::Index count = 0;
    double rounding_v = 0.0;  ///< standard deviation
};

/// Rounding of a voltage that hardly moves is the same for the whole block; of one that does, it is noise.
double common_rounding_v(const DischargeRecord& record, const std::vector<double>& voltages_v) {
    const auto n = static_cast<double>(voltages_v.size());
    const double variance = n > 1.0 ? sample_variance(voltages_v) * (n - 1.0) / n : 0.0;
    const bool still = std::sqrt(variance) < record.resolution_v / 2.0;
    return still ? record.resolution_v / std::sqrt(12.0) : 0.0;  // of a uniform distribution
}

std::vector<Block> blocks_of_time(std::span<const AlignedRecord> records, double block_s) {
    std::vector<Block> blocks;
    Eigen::Index row = 0;
    for (std::size_t f = 0; f < records.size(); ++f) {
        const auto* record = records[f].record;
        double end_s = record->time_s.front() + block_s;
        std::vector<double> voltages_v;
        const auto close = [&] {
            if (voltages_v.empty()) return;
            const auto count = static_cast<Eigen::Index>(voltages_v.size());
            blocks.push_back({f, row, count, common_rounding_v(*record, voltages_v)});
            row += count;
            voltages_v.clear();
        };
        for (std::size_t i = 0; i < record->used.size(); ++i) {
            if (record->time_s[i] >= end_s) {
                close();
                while (record->time_s[i] >= end_s) end_s += block_s;
            }
            if (record->used[i]) voltages_v.push_back(record->voltage_v[i]);
        }
        close();
    }
    return blocks;
}

std::vector<Block> blocks_of_records(std::span<const AlignedRecord> records) {
    std::vector<Block> blocks;
    Eigen::Index row = 0;
    for (std::size_t f = 0; f < records.size(); ++f) {
        blocks.push_back({f, row, used_sample_count(*records[f].record), 0.0});
        row += blocks.back().count;
    }
    return blocks;
}

/// The joint problem, each parameter scaled to length 1.
struct Scaled {
    std::vector<RecordJacobian> records;
    Eigen::MatrixXd normal;
    Eigen::VectorXd length;
};

/// Of the first `width` parameters; the others, the last of each record's, are held.
Scaled scaled(const JointCircuitFit& aligned, Eigen::Index width) {
    Scaled problem;
    problem.records = joint_jacobian(aligned);
    auto belief = joint_prior(aligned);
    belief.rows.conservativeResize(Eigen::NoChange, width);
    for (auto& [first, places, columns] : problem.records) {
        std::erase_if(places, [&](Eigen::Index place) { return place >= width; });
        columns.conservativeResize(Eigen::NoChange, std::ssize(places));
    }
    problem.normal = normal_matrix(problem.records, belief);
    problem.length = problem.normal.diagonal().cwiseSqrt().cwiseMax(1e-12);
    const Eigen::VectorXd inverse = problem.length.cwiseInverse();
    problem.normal = inverse.asDiagonal() * problem.normal * inverse.asDiagonal();
    for (auto& [first, places, columns] : problem.records)
        columns = columns * Eigen::VectorXd(inverse(places)).asDiagonal();
    // A knot that one block alone has seen cannot be estimated without it: then it stays where it is.
    constexpr double ridge = 1e-9;
    problem.normal.diagonal().array() += ridge;
    return problem;
}

Eigen::MatrixXd inverse_of(const Scaled& problem) {
    const auto width = problem.normal.rows();
    return problem.normal.ldlt().solve(Eigen::MatrixXd::Identity(width, width));
}

/// Covariance of the scaled parameters. `inverse` is the normal matrix's.
Eigen::MatrixXd jackknife(const Scaled& problem, const Eigen::MatrixXd& inverse, const Eigen::VectorXd& residual_v,
                          const std::vector<Block>& blocks) {
    const auto width = problem.normal.rows();
    Eigen::MatrixXd changes(width, std::ssize(blocks));
    Eigen::VectorXd rounding = Eigen::VectorXd::Zero(width);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const auto& [record, first, rows, rounding_v] = blocks[b];
        const auto& [record_first, places, columns] = problem.records[record];
        const auto part = columns.middleRows(first - record_first, rows);
        const Eigen::VectorXd score = part.transpose() * residual_v.segment(first, rows);
        const Eigen::MatrixXd across = inverse(Eigen::all, places);
        // (N - P)^-1 s with the inverse of N alone, as P has the record's columns only (Woodbury).
        const Eigen::MatrixXd without = Eigen::MatrixXd::Identity(score.size(), score.size()) -
                                        part.transpose() * part * across(places, Eigen::all);
        changes.col(static_cast<Eigen::Index>(b)) = across * without.partialPivLu().solve(score);
        // Packs rest at the same voltages, and so do their roundings: they add up.
        const Eigen::VectorXd shift = across * part.colwise().sum().transpose() * rounding_v;
        rounding += shift.cwiseAbs();
    }
    const auto count = static_cast<double>(blocks.size());
    Eigen::MatrixXd covariance = changes * changes.transpose() * ((count - 1.0) / count);
    covariance.diagonal() += rounding.cwiseAbs2();
    return covariance;
}

/// How far the parameters move, in the order of the joint derivatives, if the curve has twice the segments.
Eigen::VectorXd moved_by_finer_curve(const JointCircuitFit& aligned) {
    const auto& fit = aligned.fit;
    const auto segments = static_cast<int>(fit.knots_ah.size()) - 1;
    auto finer = aligned;
    finer.fit = fit_circuit(aligned.records, uniform_knots(aligned.records, 2 * segments), fit.weights);
    const auto at = fit_columns(fit);
    const auto flights = static_cast<Eigen::Index>(aligned.records.size());
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(at.width + flights);
    for (Eigen::Index k = 0; k < at.resistance; ++k) {
        const auto knot = static_cast<std::size_t>(k);
        moved[k] = finer.fit.open_circuit_v[2 * knot] - fit.open_circuit_v[knot];
    }
    moved[at.resistance] = finer.fit.resistance_ohm - fit.resistance_ohm;
    if (fit.rc_resistance_ohm > 0.0) {
        moved[at.rc] = finer.fit.rc_resistance_ohm - fit.rc_resistance_ohm;
        moved[at.rc + 1] = finer.fit.rc_time_constant_s > 0.0
                               ? std::log(finer.fit.rc_time_constant_s / fit.rc_time_constant_s)
                               : tells_nothing;
    }
    moved.tail(flights) = gauss_newton_step(finer).tail(flights);
    return moved;
}

/// A half width made at least as wide, the covariance with it.
void widen(Eigen::MatrixXd& covariance, Eigen::VectorXd& half_width, Eigen::Index i, double wider) {
    if (wider <= half_width[i]) return;
    const double factor = half_width[i] > 0.0 ? wider / half_width[i] : 1.0;
    covariance.row(i) *= factor;
    covariance.col(i) *= factor;
    half_width[i] = wider;
}

/// Half widths of 95 % intervals, of all parameters.
Eigen::VectorXd half_widths(const JointCircuitFit& aligned, const std::vector<Block>& in_time,
                            Eigen::MatrixXd& covariance) {
    const auto at = fit_columns(aligned.fit);
    const auto problem = scaled(aligned, parameter_count(aligned));
    const auto inverse = inverse_of(problem);
    const auto& residual_v = aligned.fit.residual_v;
    const double degrees_of_freedom = static_cast<double>(in_time.size()) - static_cast<double>(inverse.cols());
    const Eigen::VectorXd unit = problem.length.cwiseInverse();
    covariance = unit.asDiagonal() * jackknife(problem, inverse, residual_v, in_time) * unit.asDiagonal();
    const double t_in_time = student_t_half_width(degrees_of_freedom);
    covariance *= std::pow(t_in_time / normal_half_width(), 2);
    Eigen::VectorXd half_width = covariance.diagonal().cwiseSqrt() * normal_half_width();
    // If samples were independent, each with its effective error: what counts where no sample tells a parameter, and
    // only what is believed does.
    const Eigen::VectorXd believed =
        inverse.diagonal().cwiseMax(0.0).cwiseSqrt().cwiseProduct(unit) * aligned.fit.weights.sample_error_v;
    for (Eigen::Index f = 0; f < static_cast<Eigen::Index>(aligned.records.size()); ++f) {
        const auto i = at.width + f;
        if (static_cast<std::size_t>(f) != aligned.reference)
            widen(covariance, half_width, i, believed[i] * normal_half_width());
    }
    for (Eigen::Index k = 0; k < at.resistance; ++k)
        widen(covariance, half_width, k, believed[k] * normal_half_width());
    if (aligned.records.size() < enough_records) return half_width;
    const auto held = scaled(aligned, at.width);
    const auto blocks = blocks_of_records(aligned.records);
    const Eigen::VectorXd of_records = jackknife(held, inverse_of(held), residual_v, blocks).diagonal().cwiseSqrt();
    const double t = student_t_half_width(static_cast<double>(aligned.records.size()) - 1.0);
    for (Eigen::Index i = 0; i < at.width; ++i) widen(covariance, half_width, i, of_records[i] / held.length[i] * t);
    return half_width;
}

}  // namespace

CircuitErrors circuit_errors(const JointCircuitFit& aligned) {
    const auto& [records, fit] = std::tie(aligned.records, aligned.fit);
    double total_s = 0.0;
    for (const auto& [record, charge] : records) total_s += record->time_s.back() - record->time_s.front();
    CircuitErrors errors;
    const double blocks = wanted_blocks + more_blocks * (static_cast<double>(records.size()) - 1.0);
    errors.block_s = std::max(shortest_block_s, total_s / blocks);
    const auto in_time = blocks_of_time(records, errors.block_s);
    errors.blocks = in_time.size();
    Eigen::MatrixXd covariance;
    Eigen::VectorXd half_width = half_widths(aligned, in_time, covariance);
    const auto moved = moved_by_finer_curve(aligned);
    half_width += moved.cwiseAbs();

    const auto at = fit_columns(fit);
    const auto knots = at.resistance;
    for (Eigen::Index i = 0; i < knots; ++i)
        errors.open_circuit_standard_error_v.push_back(half_width[i] / normal_half_width());
    errors.open_circuit_covariance_v2 =
        covariance.topLeftCorner(knots, knots) + moved.head(knots) * moved.head(knots).transpose();
    const auto around = [](double value, double half) { return Interval{std::max(0.0, value - half), value + half}; };
    errors.resistance_ohm = around(fit.resistance_ohm, half_width[knots]);
    if (fit.rc_resistance_ohm > 0.0) {
        errors.rc_resistance_ohm = around(fit.rc_resistance_ohm, half_width[at.rc]);
        const double factor = std::exp(std::min(tells_nothing, half_width[at.rc + 1]));
        errors.rc_time_constant_s = {fit.rc_time_constant_s / factor, fit.rc_time_constant_s * factor};
    }
    for (std::size_t f = 0; f < records.size(); ++f) {
        errors.initial_charge_error_ah.push_back(half_width[at.width + static_cast<Eigen::Index>(f)] /
                                                 normal_half_width());
    }
    return errors;
}

}  // namespace flightwatt::battery
