#include "compute/profiling/scattered_interpolation.h"

#include "base/error.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rank_tolerance = 1e-10;

/// A point a row.
MatrixXd matrix_of(const std::vector<std::vector<double>>& points) {
    MatrixXd matrix(static_cast<Index>(points.size()),
                    static_cast<Index>(points.empty() ? 0 : points.front().size()));
    for (Index i = 0; i < matrix.rows(); ++i) {
        for (Index j = 0; j < matrix.cols(); ++j) {
            matrix(i, j) = points[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
        }
    }
    return matrix;
}

/// The axes along which the points differ: others would make every system singular.
MatrixXd varying_columns(const MatrixXd& points) {
    std::vector<Index> varying;
    for (Index j = 0; j < points.cols(); ++j) {
        if (points.rows() > 0 && points.col(j).maxCoeff() > points.col(j).minCoeff()) varying.push_back(j);
    }
    return points(Eigen::all, varying);
}

MatrixXd scaled_together(std::vector<std::vector<double>> known, const std::vector<std::vector<double>>& at,
                         AxisScale scale) {
    known.insert(known.end(), at.begin(), at.end());
    return varying_columns(matrix_of(unit_points(known, scale)));
}

/// 1 and the coordinates, or every product of different coordinates.
MatrixXd terms_of(ScatteredMethod method, const MatrixXd& points) {
    if (method != ScatteredMethod::products) {
        MatrixXd terms(points.rows(), points.cols() + 1);
        terms << VectorXd::Ones(points.rows()), points;
        return terms;
    }
    MatrixXd terms = VectorXd::Ones(points.rows());
    for (Index j = 0; j < points.cols(); ++j) {
        const MatrixXd before = terms;
        terms.conservativeResize(Eigen::NoChange, 2 * before.cols());
        terms.rightCols(before.cols()) = before.array().colwise() * points.col(j).array();
    }
    return terms;
}

double thin_plate(double squared_distance) {
    return squared_distance > 0.0 ? 0.5 * squared_distance * std::log(squared_distance) : 0.0;
}

MatrixXd kernel(const MatrixXd& a, const MatrixXd& b) {
    MatrixXd matrix(a.rows(), b.rows());
    for (Index i = 0; i < a.rows(); ++i) {
        for (Index j = 0; j < b.rows(); ++j) {
            matrix(i, j) = thin_plate((a.row(i) - b.row(j)).squaredNorm());
        }
    }
    return matrix;
}

/// [K P; P' 0]
MatrixXd spline_system(const MatrixXd& points) {
    const auto terms = terms_of(ScatteredMethod::thin_plate, points);
    const auto n = points.rows();
    MatrixXd system = MatrixXd::Zero(n + terms.cols(), n + terms.cols());
    system.topLeftCorner(n, n) = kernel(points, points);
    system.topRightCorner(n, terms.cols()) = terms;
    system.bottomLeftCorner(terms.cols(), n) = terms.transpose();
    return system;
}

VectorXd padded(const VectorXd& values, Index size) {
    VectorXd result = VectorXd::Zero(size);
    result.head(values.size()) = values;
    return result;
}

/// The weighted mean over `points`, `skipped` (or -1) left out; exact at a node.
double shepard(const MatrixXd& points, const VectorXd& values, const Eigen::RowVectorXd& at, Index skipped) {
    double sum = 0.0;
    double weights = 0.0;
    for (Index i = 0; i < points.rows(); ++i) {
        if (i == skipped) continue;
        const double squared = (points.row(i) - at).squaredNorm();
        if (squared == 0.0) return values(i);
        sum += values(i) / squared;
        weights += 1.0 / squared;
    }
    return sum / weights;
}

[[noreturn]] void too_few(const ScatteredChoice& choice, Index count) {
    throw NoAnswerError(fmt::format("{} nodes do not determine {}", count, to_string(choice)));
}

std::optional<VectorXd> left_out_errors(ScatteredMethod method, const MatrixXd& points,
                                        const VectorXd& values) {
    const auto n = points.rows();
    VectorXd errors(n);
    if (method == ScatteredMethod::inverse_distance) {
        if (n < 2) return std::nullopt;
        for (Index k = 0; k < n; ++k) errors(k) = shepard(points, values, points.row(k), k) - values(k);
        return errors;
    }
    const auto terms = terms_of(method, points);
    if (n <= terms.cols()) return std::nullopt;
    const Eigen::ColPivHouseholderQR<MatrixXd> decomposed(terms);
    if (decomposed.rank() < terms.cols()) return std::nullopt;
    if (method == ScatteredMethod::thin_plate) {
        const Eigen::FullPivLU<MatrixXd> lu(spline_system(points));
        if (!lu.isInvertible()) return std::nullopt;
        const MatrixXd inverse = lu.inverse();
        const VectorXd weights = inverse * padded(values, inverse.rows());
        for (Index k = 0; k < n; ++k) {
            if (std::abs(inverse(k, k)) < rank_tolerance) return std::nullopt;
            errors(k) = -weights(k) / inverse(k, k);
        }
        return errors;
    }
    const MatrixXd q = decomposed.householderQ() * MatrixXd::Identity(n, terms.cols());
    const VectorXd residuals = q * (q.transpose() * values) - values;
    for (Index k = 0; k < n; ++k) {
        const double free = 1.0 - q.row(k).squaredNorm();
        if (free < rank_tolerance) return std::nullopt;  // without this node the others determine nothing
        errors(k) = residuals(k) / free;
    }
    return errors;
}

}  // namespace

std::string to_string(const ScatteredChoice& choice) {
    const auto* scale = choice.scale == AxisScale::value ? "value" : "rank";
    switch (choice.method) {
        case ScatteredMethod::plane:
            return fmt::format("plane by {}", scale);
        case ScatteredMethod::products:
            return fmt::format("products by {}", scale);
        case ScatteredMethod::thin_plate:
            return fmt::format("thin plate by {}", scale);
        case ScatteredMethod::inverse_distance:
            return fmt::format("inverse distance by {}", scale);
    }
    return "?";
}

LeaveOneOut summarize_left_out(std::string method, std::vector<double> error_w,
                               const std::vector<double>& power_w) {
    LeaveOneOut summary;
    summary.method = std::move(method);
    double squares = 0.0;
    for (std::size_t i = 0; i < error_w.size(); ++i) {
        if (std::isnan(error_w[i])) continue;
        ++summary.nodes;
        const double size = std::abs(error_w[i]);
        summary.mean_absolute_w += size;
        summary.mean_absolute_percent += units::percent_of(size, std::abs(power_w[i]));
        squares += size * size;
        summary.largest_w = std::max(summary.largest_w, size);
    }
    const auto count = static_cast<double>(summary.nodes);
    if (summary.nodes > 0) {
        summary.mean_absolute_w /= count;
        summary.mean_absolute_percent /= count;
        summary.rms_w = std::sqrt(squares / count);
    }
    summary.error_w = std::move(error_w);
    return summary;
}

std::vector<double> interpolate_scattered(const ScatteredChoice& choice,
                                          const std::vector<std::vector<double>>& known,
                                          const std::vector<double>& power_w,
                                          const std::vector<std::vector<double>>& at) {
    const auto scaled = scaled_together(known, at, choice.scale);
    const auto n = static_cast<Index>(known.size());
    const MatrixXd points = scaled.topRows(n);
    const MatrixXd queries = scaled.bottomRows(scaled.rows() - n);
    const VectorXd values = Eigen::Map<const VectorXd>(power_w.data(), n);
    VectorXd found(queries.rows());
    const auto terms = terms_of(choice.method, points);
    if (choice.method == ScatteredMethod::inverse_distance) {
        if (n == 0) too_few(choice, n);
        for (Index k = 0; k < queries.rows(); ++k) found(k) = shepard(points, values, queries.row(k), -1);
    } else if (choice.method == ScatteredMethod::thin_plate) {
        const Eigen::FullPivLU<MatrixXd> lu(spline_system(points));
        if (n < terms.cols() || !lu.isInvertible()) too_few(choice, n);
        const VectorXd weights = lu.solve(padded(values, n + terms.cols()));
        found = kernel(queries, points) * weights.head(n) +
                terms_of(choice.method, queries) * weights.tail(terms.cols());
    } else {
        const Eigen::ColPivHouseholderQR<MatrixXd> decomposed(terms);
        if (decomposed.rank() < terms.cols()) too_few(choice, n);
        found = terms_of(choice.method, queries) * decomposed.solve(values);
    }
    return {found.begin(), found.end()};
}

std::optional<LeaveOneOut> leave_one_out(const ScatteredChoice& choice,
                                         const std::vector<std::vector<double>>& known,
                                         const std::vector<double>& power_w,
                                         const std::vector<std::vector<double>>& at) {
    const MatrixXd points =
        scaled_together(known, at, choice.scale).topRows(static_cast<Index>(known.size()));
    const VectorXd values = Eigen::Map<const VectorXd>(power_w.data(), static_cast<Index>(power_w.size()));
    const auto errors = left_out_errors(choice.method, points, values);
    if (!errors) return std::nullopt;
    return summarize_left_out(to_string(choice), {errors->begin(), errors->end()}, power_w);
}

std::vector<std::pair<ScatteredChoice, LeaveOneOut>> ranked_methods(
    const std::vector<std::vector<double>>& known, const std::vector<double>& power_w,
    const std::vector<std::vector<double>>& at) {
    constexpr std::size_t fewest = 3;
    std::vector<std::pair<ScatteredChoice, LeaveOneOut>> ranked;
    if (known.size() < fewest) return ranked;
    for (const auto method : {ScatteredMethod::plane, ScatteredMethod::products, ScatteredMethod::thin_plate,
                              ScatteredMethod::inverse_distance}) {
        for (const auto scale : {AxisScale::value, AxisScale::rank}) {
            const ScatteredChoice choice{method, scale};
            if (auto errors = leave_one_out(choice, known, power_w, at)) ranked.emplace_back(choice, *errors);
        }
    }
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& a, const auto& b) { return a.second.rms_w < b.second.rms_w; });
    return ranked;
}

}  // namespace flightwatt::compute
