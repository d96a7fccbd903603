#include "compute/profile_interpolation.h"

#include "base/error.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rank_tolerance = 1e-10;

/// A point a row.
MatrixXd matrix_of(const QosPoints& points) {
    MatrixXd matrix(static_cast<Index>(points.size()), static_cast<Index>(points.empty() ? 0 : points.front().size()));
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

MatrixXd scaled_together(QosPoints known, const QosPoints& at, AxisScale scale) {
    known.insert(known.end(), at.begin(), at.end());
    return varying_columns(matrix_of(unit_points(known, scale)));
}

/// 1 and the coordinates: the plane.
MatrixXd plane_terms(const MatrixXd& points) {
    MatrixXd terms(points.rows(), points.cols() + 1);
    terms << VectorXd::Ones(points.rows()), points;
    return terms;
}

double thin_plate(double squared_distance) {
    return squared_distance > 0.0 ? 0.5 * squared_distance * std::log(squared_distance) : 0.0;
}

MatrixXd kernel(const MatrixXd& a, const MatrixXd& b) {
    MatrixXd matrix(a.rows(), b.rows());
    for (Index i = 0; i < a.rows(); ++i) {
        for (Index j = 0; j < b.rows(); ++j) matrix(i, j) = thin_plate((a.row(i) - b.row(j)).squaredNorm());
    }
    return matrix;
}

/// [K P; P' 0]
MatrixXd spline_system(const MatrixXd& points) {
    const auto terms = plane_terms(points);
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

/// Of each node found from the others; std::nullopt if these do not determine the spline.
std::optional<VectorXd> errors_of(const MatrixXd& points, const VectorXd& values) {
    const auto n = points.rows();
    const auto terms = plane_terms(points);
    if (n <= terms.cols()) return std::nullopt;
    const Eigen::FullPivLU<MatrixXd> lu(spline_system(points));
    if (!lu.isInvertible()) return std::nullopt;
    const MatrixXd inverse = lu.inverse();
    const VectorXd weights = inverse * padded(values, inverse.rows());
    VectorXd errors(n);
    for (Index k = 0; k < n; ++k) {
        if (std::abs(inverse(k, k)) < rank_tolerance) return std::nullopt;
        errors(k) = -weights(k) / inverse(k, k);
    }
    return errors;
}

}  // namespace

LeaveOneOutErrors summarize_errors(std::string method, std::vector<double> error_w,
                                   const std::vector<double>& power_w) {
    LeaveOneOutErrors summary;
    summary.method = std::move(method);
    double squares = 0.0;
    for (std::size_t i = 0; i < error_w.size(); ++i) {
        if (std::isnan(error_w[i])) continue;
        ++summary.nodes;
        const double size = std::abs(error_w[i]);
        summary.mean_absolute_w += size;
        summary.mean_absolute_percent += units::percentage(size, std::abs(power_w[i]));
        squares += size * size;
        summary.largest_w = std::max(summary.largest_w, size);
    }
    const auto count = static_cast<double>(std::max<std::size_t>(summary.nodes, 1));
    summary.mean_absolute_w /= count;
    summary.mean_absolute_percent /= count;
    summary.rms_w = std::sqrt(squares / count);
    summary.error_w = std::move(error_w);
    return summary;
}

std::vector<double> interpolate_thin_plate(AxisScale scale, const QosPoints& known, const std::vector<double>& power_w,
                                           const QosPoints& at) {
    const auto scaled = scaled_together(known, at, scale);
    const auto n = static_cast<Index>(known.size());
    const MatrixXd points = scaled.topRows(n);
    const MatrixXd queries = scaled.bottomRows(scaled.rows() - n);
    const VectorXd values = Eigen::Map<const VectorXd>(power_w.data(), n);
    const auto terms = plane_terms(queries);
    const Eigen::FullPivLU<MatrixXd> lu(spline_system(points));
    if (n < terms.cols() || !lu.isInvertible()) {
        throw NoResultError(fmt::format("{} nodes do not determine the thin plate", n));
    }
    const VectorXd weights = lu.solve(padded(values, n + terms.cols()));
    const VectorXd found = kernel(queries, points) * weights.head(n) + terms * weights.tail(terms.cols());
    return {found.begin(), found.end()};
}

std::optional<LeaveOneOutErrors> leave_one_out(AxisScale scale, const QosPoints& known,
                                               const std::vector<double>& power_w, const QosPoints& at) {
    const MatrixXd points = scaled_together(known, at, scale).topRows(static_cast<Index>(known.size()));
    const VectorXd values = Eigen::Map<const VectorXd>(power_w.data(), static_cast<Index>(power_w.size()));
    const auto errors = errors_of(points, values);
    if (!errors) return std::nullopt;
    return summarize_errors(scale == AxisScale::value ? "thin plate by value" : "thin plate by rank",
                            {errors->begin(), errors->end()}, power_w);
}

std::optional<ScaleChoice> choose_scale(const QosPoints& known, const std::vector<double>& power_w,
                                        const QosPoints& at) {
    if (known.size() < 3) return std::nullopt;
    std::optional<ScaleChoice> best;
    for (const auto scale : {AxisScale::value, AxisScale::rank}) {
        auto error = leave_one_out(scale, known, power_w, at);
        if (error && (!best || error->rms_w < best->error.rms_w)) best = {scale, std::move(*error)};
    }
    return best;
}

QosPoints grid_points(const PowerProfile& profile) {
    std::vector<QosRange> ranges;
    for (const auto& axis : profile.axes) ranges.push_back({"", axis});
    return cartesian_product(ranges);
}

LeaveOneOutErrors leave_one_out(const PowerProfile& profile) {
    std::vector<double> errors;
    for (std::size_t k = 0; k < profile.power_w.size(); ++k) {
        double sum = 0.0;
        int ways = 0;
        std::size_t stride = 1;
        for (std::size_t i = profile.axes.size(); i-- > 0;) {
            const auto& axis = profile.axes[i];
            const auto place = k / stride % axis.size();
            if (place > 0 && place + 1 < axis.size()) {
                const double fraction = (axis[place] - axis[place - 1]) / (axis[place + 1] - axis[place - 1]);
                sum += std::lerp(profile.power_w[k - stride], profile.power_w[k + stride], fraction);
                ++ways;
            }
            stride *= axis.size();
        }
        errors.push_back(ways == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / ways - profile.power_w[k]);
    }
    return summarize_errors("linear between neighbours", std::move(errors), profile.power_w);
}

std::vector<LeaveOneOutErrors> interpolation_errors(const PowerProfile& profile) {
    std::vector<LeaveOneOutErrors> errors{leave_one_out(profile)};
    if (const auto choice = choose_scale(grid_points(profile), profile.power_w)) errors.push_back(choice->error);
    return errors;
}

}  // namespace flightwatt::compute
