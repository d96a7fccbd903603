#include "base/statistics.h"
#include "battery/identification/circuit_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace flightwatt::battery {
namespace {

constexpr double wanted_blocks = 30.0;
constexpr double shortest_block_s = 15.0;
constexpr std::size_t enough_records = 3;
constexpr double tells_nothing = 10.0;  // of a logarithm: beyond a factor e^10 an interval is all there is

/// Rows that follow each other, and by how much rounding may be off throughout.
struct Block {
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
    for (const auto& aligned : records) {
        const auto* record = aligned.record;
        double end_s = record->time_s.front() + block_s;
        std::vector<double> voltages_v;
        const auto close = [&] {
            if (voltages_v.empty()) return;
            const auto count = static_cast<Eigen::Index>(voltages_v.size());
            blocks.push_back({row, count, common_rounding_v(*record, voltages_v)});
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
    for (const auto& [record, charge] : records) {
        blocks.push_back({row, used_samples(*record), 0.0});
        row += blocks.back().count;
    }
    return blocks;
}

/// Standard errors; `columns` are the derivatives, scaled to unit length.
Eigen::VectorXd jackknife(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
                          const std::vector<Block>& blocks) {
    const auto width = columns.cols();
    // A knot that one block alone has seen cannot be estimated without it: then it stays where it is.
    constexpr double ridge = 1e-9;
    const Eigen::MatrixXd gram = columns.transpose() * columns + ridge * Eigen::MatrixXd::Identity(width, width);
    const auto all = gram.ldlt();
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(width);
    Eigen::VectorXd rounding = Eigen::VectorXd::Zero(width);
    for (const auto& [first, rows, rounding_v] : blocks) {
        const auto part = columns.middleRows(first, rows);
        const Eigen::VectorXd score = part.transpose() * residual.segment(first, rows);
        const Eigen::MatrixXd others = gram - part.transpose() * part;
        const Eigen::VectorXd change = others.ldlt().solve(score);
        squares += change.cwiseAbs2();
        // Packs rest at the same voltages, and so do their roundings: they add up.
        const Eigen::VectorXd shift = all.solve(part.colwise().sum().transpose()) * rounding_v;
        rounding += shift.cwiseAbs();
    }
    const auto count = static_cast<double>(blocks.size());
    return ((count - 1.0) / count * squares + rounding.cwiseAbs2()).cwiseSqrt();
}

/// How far the parameters move, in the order of the derivatives, if the curve has twice the segments.
Eigen::VectorXd moved_by_finer_curve(std::span<const AlignedRecord> records, const CircuitFit& fit) {
    std::vector<double> knots_ah{fit.knots_ah.front()};
    for (std::size_t i = 1; i < fit.knots_ah.size(); ++i) {
        knots_ah.push_back((fit.knots_ah[i - 1] + fit.knots_ah[i]) / 2.0);
        knots_ah.push_back(fit.knots_ah[i]);
    }
    const auto finer = fit_circuit(records, knots_ah);
    const auto knots = fit.knots_ah.size();
    const bool has_rc = fit.rc_resistance_ohm > 0.0;
    Eigen::VectorXd moved(static_cast<Eigen::Index>(has_rc ? knots + 3 : knots + 1));
    for (std::size_t i = 0; i < knots; ++i)
        moved[static_cast<Eigen::Index>(i)] = std::abs(finer.open_circuit_v[2 * i] - fit.open_circuit_v[i]);
    const auto k = static_cast<Eigen::Index>(knots);
    moved[k] = std::abs(finer.resistance_ohm - fit.resistance_ohm);
    if (has_rc) {
        moved[k + 1] = std::abs(finer.rc_resistance_ohm - fit.rc_resistance_ohm);
        moved[k + 2] = finer.rc_time_constant_s > 0.0
                           ? std::abs(std::log(finer.rc_time_constant_s / fit.rc_time_constant_s))
                           : tells_nothing;
    }
    return moved;
}

}  // namespace

CircuitErrors circuit_errors(std::span<const AlignedRecord> records, const CircuitFit& fit) {
    double total_s = 0.0;
    for (const auto& [record, charge] : records) total_s += record->time_s.back() - record->time_s.front();
    CircuitErrors errors;
    errors.block_s = std::max(shortest_block_s, total_s / wanted_blocks);
    auto columns = voltage_derivatives(records, fit);
    const Eigen::VectorXd length = columns.colwise().norm();
    for (Eigen::Index i = 0; i < columns.cols(); ++i) columns.col(i) /= length[i];
    const auto in_time = blocks_of_time(records, errors.block_s);
    errors.blocks = in_time.size();
    const double degrees_of_freedom = static_cast<double>(errors.blocks) - static_cast<double>(columns.cols());
    Eigen::VectorXd half_width = jackknife(columns, fit.residual_v, in_time) * student_t_half_width(degrees_of_freedom);
    if (records.size() >= enough_records) {
        const double t = student_t_half_width(static_cast<double>(records.size()) - 1.0);
        half_width = half_width.cwiseMax(jackknife(columns, fit.residual_v, blocks_of_records(records)) * t);
    }
    half_width = half_width.cwiseQuotient(length) + moved_by_finer_curve(records, fit);

    const auto knots = static_cast<Eigen::Index>(fit.knots_ah.size());
    for (Eigen::Index i = 0; i < knots; ++i)
        errors.open_circuit_standard_error_v.push_back(half_width[i] / normal_half_width());
    const auto around = [](double value, double half) { return Interval{std::max(0.0, value - half), value + half}; };
    errors.resistance_ohm = around(fit.resistance_ohm, half_width[knots]);
    if (fit.rc_resistance_ohm > 0.0) {
        errors.rc_resistance_ohm = around(fit.rc_resistance_ohm, half_width[knots + 1]);
        const double factor = std::exp(std::min(tells_nothing, half_width[knots + 2]));
        errors.rc_time_constant_s = {fit.rc_time_constant_s / factor, fit.rc_time_constant_s * factor};
    }
    return errors;
}

}  // namespace flightwatt::battery
