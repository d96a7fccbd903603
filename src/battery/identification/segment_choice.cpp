#include "base/statistics.h"
#include "battery/identification/aligned_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>

namespace flightwatt::battery {
namespace {

constexpr int max_segments = 12;
constexpr double min_sample_part = 20.0;  // samples a segment, at least
constexpr std::size_t parts_of_one = 20;

/// The rows of what is left out together.
struct Part {
    std::vector<Eigen::Index> rows;
    double deepest_ah = 0.0;
};

/// Samples under load; what is left out together follows from where they stand.
std::vector<Part> parts_of(std::span<const AlignedRecord> records) {
    std::vector<Part> parts(records.size() > 1 ? records.size() : parts_of_one);
    Eigen::Index row = 0;
    for (std::size_t f = 0; f < records.size(); ++f) {
        const auto& [record, initial_ah] = records[f];
        const double from_s = record->time_s.front();
        const double length_s = record->time_s.back() - from_s;
        for (std::size_t i = 0; i < record->used.size(); ++i) {
            if (!record->used[i]) continue;
            const auto at = static_cast<std::size_t>(parts_of_one * (record->time_s[i] - from_s) / length_s);
            auto& part = parts[records.size() > 1 ? f : std::min(parts_of_one - 1, at)];
            if (i >= record->rest_samples) part.rows.push_back(row);
            part.deepest_ah = std::max(part.deepest_ah, initial_ah + record->charge_ah[i]);
            ++row;
        }
    }
    return parts;
}

/// Derivatives without the rests', and the voltages that they have to explain.
struct LoadRows {
    Eigen::MatrixXd columns;
    Eigen::MatrixXd believed;
    Eigen::VectorXd voltage_v;
    Eigen::VectorXd charge_ah;
};

LoadRows load_rows(std::span<const AlignedRecord> records, const CircuitFit& like, int segments) {
    auto fit = fit_circuit(records, uniform_knots(records, segments), like.weights, like.rc_time_constant_s);
    const auto at = fit_columns(fit);
    const auto all = shared_jacobian(records, fit);
    const auto believed = prior_rows(records, fit);
    const Eigen::Index rc = fit.rc_resistance_ohm > 0.0 ? 1 : 0;
    LoadRows rows;
    rows.columns = all.leftCols(at.rest + rc);  // without the time constant's
    const auto bends = std::max<Eigen::Index>(0, at.resistance - 2);
    rows.believed = Eigen::MatrixXd::Zero(bends, at.rest + rc);
    rows.believed.leftCols(at.rest) = believed.bottomRows(bends).leftCols(at.rest);
    rows.voltage_v.resize(all.rows());
    rows.charge_ah.resize(all.rows());
    Eigen::Index row = 0;
    for (const auto& [record, initial_ah] : records) {
        for (std::size_t i = 0; i < record->used.size(); ++i) {
            if (!record->used[i]) continue;
            rows.voltage_v[row] = record->voltage_v[i];
            rows.charge_ah[row++] = record->charge_ah[i] + initial_ah;
        }
    }
    return rows;
}

double deepest_of_others_ah(const std::vector<Part>& parts, const Part& left_out) {
    double deepest_ah = 0.0;
    for (const auto& part : parts)
        if (&part != &left_out) deepest_ah = std::max(deepest_ah, part.deepest_ah);
    return deepest_ah;
}

/// Mean square errors of predicting each part by the others, its own level free. None of a part too deep for the
/// others.
std::vector<std::optional<double>> prediction_errors_v2(const LoadRows& rows, const std::vector<Part>& parts) {
    const auto width = rows.columns.cols();
    std::vector<Eigen::MatrixXd> normals;
    std::vector<Eigen::VectorXd> pulls;
    Eigen::MatrixXd normal = rows.believed.transpose() * rows.believed;
    normal.diagonal().array() += 1e-12;
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(width);
    for (const auto& part : parts) {
        const Eigen::MatrixXd columns = rows.columns(part.rows, Eigen::all);
        normals.emplace_back(columns.transpose() * columns);
        pulls.emplace_back(columns.transpose() * rows.voltage_v(part.rows));
        normal += normals.back();
        pull += pulls.back();
    }
    std::vector<std::optional<double>> all_v2(parts.size());
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const Eigen::VectorXd solution = (normal - normals[p]).ldlt().solve(pull - pulls[p]);
        const double deepest_ah = deepest_of_others_ah(parts, parts[p]);
        std::vector<double> errors_v;
        for (const auto row : parts[p].rows)
            if (rows.charge_ah[row] <= deepest_ah)
                errors_v.push_back(rows.voltage_v[row] - rows.columns.row(row).dot(solution));
        if (errors_v.size() > 1) all_v2[p] = sample_variance(errors_v);
    }
    return all_v2;
}

/// By how much more the parts are mistaken with one number of segments than with another.
struct Excess {
    double mean_v2 = 0.0;
    double standard_error_v2 = 0.0;
};

Excess excess_of(const std::vector<std::optional<double>>& some_v2,
                 const std::vector<std::optional<double>>& others_v2) {
    std::vector<double> more_v2;
    for (std::size_t p = 0; p < some_v2.size(); ++p)
        if (some_v2[p] && others_v2[p]) more_v2.push_back(*some_v2[p] - *others_v2[p]);
    if (more_v2.empty()) return {};
    const auto n = static_cast<double>(more_v2.size());
    return {mean(more_v2), n > 1.0 ? std::sqrt(sample_variance(more_v2) / n) : 0.0};
}

double mean_of(const std::vector<std::optional<double>>& errors_v2) {
    std::vector<double> known_v2;
    for (const auto& error_v2 : errors_v2)
        if (error_v2) known_v2.push_back(*error_v2);
    return known_v2.empty() ? 0.0 : mean(known_v2);
}

}  // namespace

std::vector<int> rank_segment_counts(std::span<const AlignedRecord> records, const CircuitFit& fit) {
    const auto parts = parts_of(records);
    std::vector<std::vector<std::optional<double>>> errors_v2;
    std::size_t best = 0;
    for (int segments = 1; segments <= max_segments; ++segments) {
        if (segments > 1 && static_cast<double>(fit.residual_v.size()) < min_sample_part * segments) break;
        errors_v2.push_back(prediction_errors_v2(load_rows(records, fit, segments), parts));
        if (excess_of(errors_v2.back(), errors_v2[best]).mean_v2 < 0.0) best = errors_v2.size() - 1;
    }
    // Of two records, where one does not tell more segments from fewer, the mean is the standard error but for
    // rounding: which one is larger must not depend on the processor.
    constexpr double no_difference = 1e-6;
    const double same_v2 = no_difference * mean_of(errors_v2[best]);
    std::size_t fewest = 0;
    for (; fewest < best; ++fewest) {
        const auto excess = excess_of(errors_v2[fewest], errors_v2[best]);
        if (excess.mean_v2 <= excess.standard_error_v2 + same_v2) break;
    }
    std::vector<int> in_turn;
    for (std::size_t s = fewest; s < errors_v2.size(); ++s) in_turn.push_back(static_cast<int>(s) + 1);
    for (std::size_t s = fewest; s-- > 0;) in_turn.push_back(static_cast<int>(s) + 1);
    return in_turn;
}

}  // namespace flightwatt::battery
