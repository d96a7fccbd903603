#include "mechanical/fit/robust_refinement.h"

#include "base/error.h"
#include "base/statistics.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/fourier_residual.h"
#include "mechanical/fit/least_squares.h"
#include "mechanical/fit/robust_loss.h"

#include <cmath>
#include <utility>
#include <vector>

#include <ceres/ceres.h>
#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// From the median of absolute values to the standard deviation, for normal noise.
constexpr double deviations_per_median = 1.4826;

/// Residuals below this, in standard deviations of the power, are rounding.
constexpr double smallest_scale = 1e-10;

constexpr int most_scalings = 50;
constexpr double same_scale = 1e-6;

/// One sample in Ceres's terms: a loss function takes hold of a residual block, so each sample is one.
class SampleCost final : public ceres::CostFunction {
  public:
    SampleCost(double tau, double value, const Eigen::MatrixXd& from_orthonormal)
        : tau_(tau), value_(value), from_orthonormal_(from_orthonormal) {
        set_num_residuals(1);
        *mutable_parameter_block_sizes() = {1, static_cast<int>(from_orthonormal.cols())};
    }

    bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
        const Eigen::Map<const Eigen::VectorXd> z(parameters[1], from_orthonormal_.cols());
        const auto at = fourier_residual({{tau_}, {value_}}, parameters[0][0], from_orthonormal_ * z);
        residuals[0] = at.residual(0);
        if (jacobians == nullptr) return true;
        if (jacobians[0] != nullptr) jacobians[0][0] = at.by_theta(0);
        if (jacobians[1] != nullptr) {
            Eigen::Map<Eigen::RowVectorXd>(jacobians[1], z.size()) = at.by_coefficients * from_orthonormal_;
        }
        return true;
    }

  private:
    double tau_;
    double value_;
    const Eigen::MatrixXd& from_orthonormal_;
};

double scale_of(std::span<const ScaledSamples> flights, const JointFit& fit) {
    std::vector<double> sizes;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const auto at = fourier_residual(flights[i], fit.theta_rad, fit.coefficients[i]);
        for (const double residual : at.residual) sizes.push_back(std::abs(residual));
    }
    return deviations_per_median * median(std::move(sizes));
}

/// The least loss at a fixed scale.
JointFit minimised(std::span<const ScaledSamples> flights, const FrequencyRange& range, const JointFit& start,
                   double scale) {
    const auto order = static_cast<int>(start.coefficients.front().size() - 1) / 2;
    auto result = start;
    std::vector<Eigen::MatrixXd> from_orthonormal;
    std::vector<Eigen::VectorXd> z;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const auto basis = fourier_basis(flights[i].tau, order, start.theta_rad);
        const auto fit = solve_least_squares(basis, basis * start.coefficients[i]);
        if (!fit) throw NoAnswerError("the samples do not determine the series");
        from_orthonormal.push_back(fit->from_orthonormal);
        z.push_back(fit->orthonormal);
    }
    ceres::Problem problem;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        for (std::size_t j = 0; j < flights[i].tau.size(); ++j) {
            problem.AddResidualBlock(
                new SampleCost(flights[i].tau[j], flights[i].value[j], from_orthonormal[i]),
                new ceres::HuberLoss(tuning_constant * scale), &result.theta_rad, z[i].data());
        }
    }
    problem.SetParameterLowerBound(&result.theta_rad, 0, range.low_rad);
    problem.SetParameterUpperBound(&result.theta_rad, 0, range.high_rad);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 500;
    options.function_tolerance = 1e-12;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (summary.termination_type != ceres::CONVERGENCE) {
        throw NoAnswerError(fmt::format("the robust fit did not converge: {}", summary.message));
    }
    for (std::size_t i = 0; i < flights.size(); ++i) {
        result.coefficients[i] = from_orthonormal[i] * z[i];
        result.square_sum[i] =
            fourier_residual(flights[i], result.theta_rad, result.coefficients[i]).residual.squaredNorm();
    }
    return result;
}

}  // namespace

RobustFit refine_robustly(std::span<const ScaledSamples> flights, const FrequencyRange& range,
                          const JointFit& start) {
    RobustFit fit{start, 0.0};
    fit.scale = scale_of(flights, fit.joint);
    for (int i = 0; i < most_scalings && fit.scale > smallest_scale; ++i) {
        fit.joint = minimised(flights, range, fit.joint, fit.scale);
        const double scale = scale_of(flights, fit.joint);
        const bool stays = std::abs(scale - fit.scale) <= same_scale * fit.scale;
        fit.scale = scale;
        if (stays) return fit;
    }
    return fit;
}

}  // namespace flightwatt::mechanical
