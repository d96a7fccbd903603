#include "base/statistics.h"
#include "battery/identification/aligned_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace flightwatt::battery {
namespace {

constexpr double min_segment_samples = 20.0;

using PartErrors = std::vector<std::optional<double>>;

/// The parts that are left out in turn: the blocks of a single record, or each record's together.
std::vector<RowBlock> left_out_parts(const NormalEquations& problem) {
    if (problem.places.own.size() == 1) return problem.blocks;
    std::vector<RowBlock> parts;
    for (const auto& block : problem.blocks) {
        if (parts.empty() || parts.back().record != block.record) {
            parts.push_back(block);
            continue;
        }
        parts.back().count += block.count;
        parts.back().normal += block.normal;
        parts.back().score += block.score;
    }
    return parts;
}

/// Mean square errors of predicting each part under load by the others, its own level free. None of a part too deep
/// for the others.
PartErrors prediction_errors_v2(JointCircuitFit joint, int segments) {
    place_knots(joint, segments);
    const auto problem = least_squares(joint, linear_only);
    const auto inverse = inverse_of(problem);
    const auto parts = left_out_parts(problem);
    std::vector<RecordRows> rows;
    for (std::size_t r = 0; r < joint.records.size(); ++r) rows.push_back(rows_of(joint, r, linear_only));
    std::vector<double> deepest_ah(parts.size());
    std::ranges::transform(parts, deepest_ah.begin(), [&](const auto& part) {
        return rows[part.record].charge_ah.segment(part.first, part.count).maxCoeff();
    });
    PartErrors all_v2;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const auto& part = parts[p];
        double others_ah = 0.0;
        for (std::size_t other = 0; other < parts.size(); ++other)
            if (other != p) others_ah = std::max(others_ah, deepest_ah[other]);
        const auto& [columns, residual_v, charge_ah] = rows[part.record];
        const Eigen::VectorXd change = change_without(problem, inverse, part)(problem.columns_of(part.record));
        std::vector<double> errors_v;
        const auto load = rest_sample_count(*joint.records[part.record].record);
        for (auto row = std::max(part.first, load); row < part.first + part.count; ++row)
            if (charge_ah[row] <= others_ah) errors_v.push_back(residual_v[row] - columns.row(row).dot(change));
        all_v2.push_back(errors_v.size() > 1 ? std::optional(sample_variance(errors_v)) : std::nullopt);
    }
    return all_v2;
}

/// By how much more the parts are mistaken with one number of segments than with another.
struct Excess {
    double mean_v2 = 0.0;
    double standard_error_v2 = 0.0;
};

Excess excess_of(const PartErrors& some_v2, const PartErrors& others_v2) {
    std::vector<double> more_v2;
    for (std::size_t p = 0; p < some_v2.size(); ++p)
        if (some_v2[p] && others_v2[p]) more_v2.push_back(*some_v2[p] - *others_v2[p]);
    if (more_v2.empty()) return {};
    const auto n = static_cast<double>(more_v2.size());
    return {mean(more_v2), n > 1.0 ? std::sqrt(sample_variance(more_v2) / n) : 0.0};
}

}  // namespace

int choose_segment_count(const JointCircuitFit& joint) {
    double samples = 0.0;
    for (const auto& aligned : joint.records) samples += static_cast<double>(used_sample_count(*aligned.record));
    std::vector<PartErrors> errors_v2;
    std::size_t best = 0;
    for (int segments = 1; segments <= max_segments; ++segments) {
        if (segments > 1 && samples < min_segment_samples * segments) break;
        errors_v2.push_back(prediction_errors_v2(joint, segments));
        if (excess_of(errors_v2.back(), errors_v2[best]).mean_v2 < 0.0) best = errors_v2.size() - 1;
    }
    const auto as_good = std::ranges::find_if(errors_v2, [&](const PartErrors& tried) {
        const auto excess = excess_of(tried, errors_v2[best]);
        // Of two records of which one does not depend on the segments, the mean is the standard error but for rounding.
        constexpr double rounding = 1.0 + 1e-6;
        return excess.mean_v2 <= rounding * excess.standard_error_v2;
    });
    return static_cast<int>(as_good - errors_v2.begin()) + 1;
}

}  // namespace flightwatt::battery
