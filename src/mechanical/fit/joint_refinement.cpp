#include "mechanical/fit/joint_refinement.h"

#include "base/error.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/fourier_residual.h"
#include "mechanical/fit/least_squares.h"

#include <memory>

#include <ceres/ceres.h>
#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

LinearFit fit_at(const ScaledSamples& samples, int order, double theta_rad) {
    const Eigen::Map<const Eigen::VectorXd> values(samples.value.data(),
                                                   static_cast<Eigen::Index>(samples.value.size()));
    auto fit = solve_least_squares(fourier_basis(samples.tau, order, theta_rad), values);
    if (!fit) {
        throw NoAnswerError(
            fmt::format("flight '{}': the times of its {} samples do not determine a series of "
                        "order {} at omega * duration = {:.4g} rad",
                        samples.flight, samples.tau.size(), order, theta_rad));
    }
    return *std::move(fit);
}

/// One flight in Ceres's terms (which leave no way but to derive). It searches for coefficients in the basis
/// that is orthonormal at the starting point, so its normal equations are well conditioned however collinear
/// the Fourier basis is.
class FlightCost final : public ceres::CostFunction {
  public:
    FlightCost(const ScaledSamples& samples, Eigen::MatrixXd from_orthonormal)
        : samples_(samples), from_orthonormal_(std::move(from_orthonormal)) {
        set_num_residuals(static_cast<int>(samples.tau.size()));
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
    const ScaledSamples& samples_;
    Eigen::MatrixXd from_orthonormal_;
};

ceres::Solver::Options solver_options() {
    ceres::Solver::Options options;
    options.minimizer_type = ceres::TRUST_REGION;
    options.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
    options.linear_solver_type = ceres::DENSE_SCHUR;  // the flights meet only in theta
    options.max_num_iterations = 200;
    // Values are of order 1. A change of the cost by 1e-13 of it moves a coefficient by a 1e-4th of its
    // standard error or less; a noise-free cost goes on falling to rounding.
    options.function_tolerance = 1e-13;
    options.gradient_tolerance = 1e-12;
    options.parameter_tolerance = 1e-11;
    options.logging_type = ceres::SILENT;
    return options;
}

}  // namespace

JointFit refine_jointly(std::span<const ScaledSamples> flights, int order, const FrequencyRange& range,
                        double start_rad) {
    double theta_rad = start_rad;
    // Side by side, in the flights' order: Ceres goes through a group's blocks in the order of their
    // addresses, and the answer's last digits must not depend on where the heap put them.
    Eigen::MatrixXd coefficients(coefficient_count(order), static_cast<Eigen::Index>(flights.size()));
    ceres::Problem problem;
    auto options = solver_options();
    options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const auto start = fit_at(flights[i], order, start_rad);
        auto own = coefficients.col(static_cast<Eigen::Index>(i));
        own = start.orthonormal;
        problem.AddResidualBlock(new FlightCost(flights[i], start.from_orthonormal), nullptr, &theta_rad,
                                 own.data());
        options.linear_solver_ordering->AddElementToGroup(own.data(), 0);
    }
    options.linear_solver_ordering->AddElementToGroup(&theta_rad, 1);
    problem.SetParameterLowerBound(&theta_rad, 0, range.low_rad);
    problem.SetParameterUpperBound(&theta_rad, 0, range.high_rad);

    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (summary.termination_type != ceres::CONVERGENCE) {
        throw NoAnswerError(fmt::format("the fit did not converge from omega * duration = {:.4g} rad: {}",
                                        start_rad, summary.message));
    }

    // Coefficients are linear in the values at the theta found: solve them once more, without iterations.
    JointFit result;
    result.theta_rad = theta_rad;
    for (const auto& flight : flights) {
        auto fit = fit_at(flight, order, theta_rad);
        result.coefficients.push_back(std::move(fit.coefficients));
        result.square_sum.push_back(fit.residual_square_sum);
    }
    return result;
}

}  // namespace flightwatt::mechanical
