#include "mechanical/fit/refinement.h"

#include "base/error.h"
#include "base/statistics.h"
#include "mechanical/fit/fourier_basis.h"

#include <memory>
#include <string>
#include <utility>

#include <ceres/ceres.h>
#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// From the median of absolute values to the standard deviation, for normal noise.
constexpr double deviations_per_median = 1.4826;

/// Residuals below this, in standard deviations of the power, are rounding.
constexpr double smallest_scale = 1e-10;

constexpr int max_scalings = 50;
constexpr double same_scale = 1e-6;

LinearFit fit_at(const ScaledSamples& samples, const Eigen::MatrixXd& basis, const Eigen::VectorXd& values,
                 double theta_rad) {
    auto fit = solve_least_squares(basis, values);
    if (fit) return *std::move(fit);
    throw NoResultError(
        fmt::format("flight '{}': the times of its {} samples do not determine a series of "
                    "order {} at omega * duration = {:.4g} rad",
                    samples.flight, samples.tau.size(), basis.cols() / 2, theta_rad));
}

LinearFit fit_at(const ScaledSamples& samples, int order, double theta_rad) {
    return fit_at(samples, fourier_basis(samples.tau, order, theta_rad), as_vector(samples.value), theta_rad);
}

/// A flight, or one sample of it, in Ceres's terms (which leave no way but to derive). It searches for
/// coefficients in the basis that is orthonormal at the starting point, so its normal equations are well
/// conditioned however collinear the Fourier basis is.
class FourierCost final : public ceres::CostFunction {
  public:
    FourierCost(ScaledSamples samples, Eigen::MatrixXd from_orthonormal)
        : samples_(std::move(samples)), from_orthonormal_(std::move(from_orthonormal)) {
        set_num_residuals(static_cast<int>(samples_.tau.size()));
        *mutable_parameter_block_sizes() = {1, static_cast<int>(from_orthonormal_.cols())};
    }

    bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
        const Eigen::Map<const Eigen::VectorXd> z(parameters[1], from_orthonormal_.cols());
        const auto result = fourier_residual(samples_, parameters[0][0], from_orthonormal_ * z);
        const auto count = result.residual.size();
        Eigen::Map<Eigen::VectorXd>(residuals, count) = result.residual;
        if (jacobians == nullptr) return true;
        using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        if (jacobians[0] != nullptr) Eigen::Map<Eigen::VectorXd>(jacobians[0], count) = result.by_theta;
        if (jacobians[1] != nullptr) {
            Eigen::Map<RowMajor>(jacobians[1], count, z.size()) = result.by_coefficients * from_orthonormal_;
        }
        return true;
    }

  private:
    ScaledSamples samples_;
    Eigen::MatrixXd from_orthonormal_;
};

/// Throws NoResultError, `failure` and Ceres's reason, unless theta and the coefficients converge.
void solve(ceres::Problem& problem, const ceres::Solver::Options& options, double& theta_rad,
           const FrequencyRange& range, const std::string& failure) {
    problem.SetParameterLowerBound(&theta_rad, 0, range.low_rad);
    problem.SetParameterUpperBound(&theta_rad, 0, range.high_rad);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (summary.termination_type == ceres::CONVERGENCE) return;
    throw NoResultError(fmt::format("{}: {}", failure, summary.message));
}

double scale_of(std::span<const ScaledSamples> flights, const JointFit& fit) {
    std::vector<double> sizes;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const auto at = fourier_residual(flights[i], fit.theta_rad, fit.coefficients[i]);
        for (const double residual : at.residual) sizes.push_back(std::abs(residual));
    }
    return deviations_per_median * median(std::move(sizes));
}

/// Moves the fit to the least loss at its scale of the noise.
void minimise(std::span<const ScaledSamples> flights, const FrequencyRange& range, JointFit& fit) {
    const auto order = static_cast<int>(fit.coefficients.front().size() - 1) / 2;
    std::vector<LinearFit> start;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const auto basis = fourier_basis(flights[i].tau, order, fit.theta_rad);
        start.push_back(fit_at(flights[i], basis, basis * fit.coefficients[i], fit.theta_rad));
    }
    ceres::Problem problem;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        for (std::size_t j = 0; j < flights[i].tau.size(); ++j) {
            // A loss takes hold of a residual block, so each sample is one.
            problem.AddResidualBlock(
                new FourierCost({{flights[i].tau[j]}, {flights[i].value[j]}}, start[i].from_orthonormal),
                new ceres::HuberLoss(huber_threshold * fit.noise_scale), &fit.theta_rad, start[i].orthonormal.data());
        }
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 500;
    options.function_tolerance = 1e-12;
    options.logging_type = ceres::SILENT;
    solve(problem, options, fit.theta_rad, range, "the robust fit did not converge");
    for (std::size_t i = 0; i < flights.size(); ++i) {
        fit.coefficients[i] = start[i].from_orthonormal * start[i].orthonormal;
        fit.square_sum[i] = fourier_residual(flights[i], fit.theta_rad, fit.coefficients[i]).residual.squaredNorm();
    }
}

}  // namespace

JointFit refine_jointly(std::span<const ScaledSamples> flights, int order, const FrequencyRange& range,
                        double start_rad) {
    JointFit result;
    result.theta_rad = start_rad;
    ceres::Problem problem;
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;  // the flights meet only in theta
    options.max_num_iterations = 200;
    // Values are of order 1. A change of the cost by 1e-13 of it moves a coefficient by a 1e-4th of its
    // standard error or less; a noise-free cost goes on falling to rounding.
    options.function_tolerance = 1e-13;
    options.gradient_tolerance = 1e-12;
    options.parameter_tolerance = 1e-11;
    options.logging_type = ceres::SILENT;
    options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    // Side by side, in the flights' order: Ceres goes through a group's blocks in the order of their
    // addresses, and the answer's last digits must not depend on where the heap put them.
    Eigen::MatrixXd coefficients(coefficient_count(order), static_cast<Eigen::Index>(flights.size()));
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const auto start = fit_at(flights[i], order, start_rad);
        auto own = coefficients.col(static_cast<Eigen::Index>(i));
        own = start.orthonormal;
        problem.AddResidualBlock(new FourierCost(flights[i], start.from_orthonormal), nullptr, &result.theta_rad,
                                 own.data());
        options.linear_solver_ordering->AddElementToGroup(own.data(), 0);
    }
    options.linear_solver_ordering->AddElementToGroup(&result.theta_rad, 1);
    solve(problem, options, result.theta_rad, range,
          fmt::format("the fit did not converge from omega * duration = {:.4g} rad", start_rad));

    // Coefficients are linear in the values at the theta found: solve them once more, without iterations.
    for (const auto& flight : flights) {
        auto fit = fit_at(flight, order, result.theta_rad);
        result.coefficients.push_back(std::move(fit.coefficients));
        result.square_sum.push_back(fit.residual_square_sum);
    }
    return result;
}

JointFit refine_robustly(std::span<const ScaledSamples> flights, const FrequencyRange& range, JointFit fit) {
    fit.noise_scale = scale_of(flights, fit);
    for (int i = 0; i < max_scalings && fit.noise_scale > smallest_scale; ++i) {
        minimise(flights, range, fit);
        const double before = std::exchange(fit.noise_scale, scale_of(flights, fit));
        if (std::abs(fit.noise_scale - before) <= same_scale * before) break;
    }
    return fit;
}

}  // namespace flightwatt::mechanical
