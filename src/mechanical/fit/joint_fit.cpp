#include "mechanical/fit/joint_fit.h"

#include "base/error.h"
#include "mechanical/fit/fourier_basis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/QR>
#include <boost/math/distributions/fisher_f.hpp>
#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// Half of a scan's step, from the middle of the phase, costs at most this fraction of a harmonic's power.
constexpr double lost_between_fraction = 0.02;

/// Minima of the scan from which a fit starts. One that explains less than this fraction of the best explanation cannot
/// become the best within a step.
constexpr std::size_t max_starts = 8;
constexpr double candidate_fraction = 0.95;

/// Probability of a harmonic that is noise.
constexpr double harmonic_significance = 1e-3;

/// A harmonic with less than this fraction of the power that the series explains is negligible.
constexpr double negligible_fraction = 0.02;

/// Below this fraction of the values' own sum of squares a residual is rounding.
constexpr double rounding_level = 1e-9;

/// The residuals f(tau) - power of a flight's samples over theta, with the coefficients that fit best there.
class ProjectedResiduals : public ceres::CostFunction {
  public:
    ProjectedResiduals(const PhaseSamples& samples, int order) : samples_(samples), order_(order) {
        set_num_residuals(static_cast<int>(samples.tau.size()));
        *mutable_parameter_block_sizes() = {1};
    }

    bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
        const auto basis = fourier_basis(samples_.tau, order_, *parameters[0]);
        const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(basis);
        const auto outside_basis = [&](Eigen::VectorXd values) {
            values.applyOnTheLeft(qr.householderQ().adjoint());
            values.head(basis.cols()).setZero();
            values.applyOnTheLeft(qr.householderQ());
            return values;
        };
        const auto power_w = as_vector(samples_.power_w);
        Eigen::Map<Eigen::VectorXd>(residuals, basis.rows()) = -outside_basis(power_w);
        if (jacobians == nullptr || jacobians[0] == nullptr) return true;
        const Eigen::VectorXd coefficients = qr.solve(power_w);
        Eigen::VectorXd by_angle = Eigen::VectorXd::Zero(basis.rows());
        for (Eigen::Index n = 1; n <= order_; ++n)
            by_angle += static_cast<double>(n) *
                        (coefficients[2 * n] * basis.col(2 * n - 1) - coefficients[2 * n - 1] * basis.col(2 * n));
        Eigen::Map<Eigen::VectorXd>(jacobians[0], basis.rows()) =
            outside_basis(by_angle.cwiseProduct(as_vector(samples_.tau)));
        return true;
    }

  private:
    const PhaseSamples& samples_;
    int order_;
};

double own_square_sum(std::span<const PhaseSamples> flights) {
    double sum = 0.0;
    for (const auto& flight : flights) sum += as_vector(flight.power_w).squaredNorm();
    return sum;
}

/// Returns the part of a range within a distance of theta.
FrequencyRange within(const FrequencyRange& range, double theta_rad, double reach_rad) {
    return {std::max(range.low_rad, theta_rad - reach_rad), std::min(range.high_rad, theta_rad + reach_rad)};
}

/// Returns the theta within a range at which the flights' residual sum of squares, each with its own best coefficients,
/// is least near a start: Levenberg and Marquardt's method (Ceres Solver) over theta, in which the coefficients follow by
/// variable projection (Golub and Pereyra 1973, with Kaufman's Jacobian).
Candidate least_squares_near(std::span<const PhaseSamples> flights, int order, const FrequencyRange& range,
                             double start_rad) {
    double theta_rad = std::clamp(start_rad, range.low_rad, range.high_rad);
    ceres::Problem problem;
    for (const auto& flight : flights)
        problem.AddResidualBlock(new ProjectedResiduals(flight, order), nullptr, &theta_rad);
    problem.SetParameterLowerBound(&theta_rad, 0, range.low_rad);
    problem.SetParameterUpperBound(&theta_rad, 0, range.high_rad);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.function_tolerance = 1e-12;  // theta to a thousandth of its standard error
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return {theta_rad, 2.0 * summary.final_cost};
}

}  // namespace

double find_frequency(std::span<const PhaseSamples> flights, int order, const FrequencyRange& range,
                      const FrequencyScan& scan) {
    auto starts = minima(scan);
    starts.resize(std::min(starts.size(), max_starts));
    const double own = own_square_sum(flights);
    Candidate best;
    for (const auto& [start_rad, square_sum] : starts) {
        if (own - square_sum < candidate_fraction * (own - best.square_sum)) break;
        const auto found = least_squares_near(flights, order, within(range, start_rad, scan.grid.step_rad), start_rad);
        if (found.square_sum < best.square_sum) best = found;
    }
    return resolve_subharmonic(flights, order, range, scan, best);
}

double resolve_subharmonic(std::span<const PhaseSamples> flights, int order, const FrequencyRange& range,
                           const FrequencyScan& scan, const Candidate& found) {
    const double own = own_square_sum(flights);
    const double rounding = std::max(rounding_level * own, std::numeric_limits<double>::min());
    const double best = std::max(rounding, found.square_sum);
    double degrees_of_freedom = -1.0;
    for (const auto& flight : flights)
        degrees_of_freedom += static_cast<double>(flight.tau.size()) - coefficient_count(order);
    degrees_of_freedom = std::max(1.0, degrees_of_freedom);
    const double variance = best / degrees_of_freedom;
    for (int multiple = order; multiple >= 2; --multiple) {
        const double simpler_rad = multiple * found.theta_rad;
        const double reach_rad = turn_between_rad / order * multiple;
        if (simpler_rad + reach_rad > range.high_rad) continue;
        const int lost_harmonics = order - order / multiple;
        const double lacking = 2.0 * static_cast<double>(flights.size()) * lost_harmonics;
        const boost::math::fisher_f distribution(lacking, degrees_of_freedom);
        const double by_chance =
            lacking * variance * boost::math::quantile(boost::math::complement(distribution, harmonic_significance));
        const double explained = own - best;
        const double max_worse = std::min(by_chance, lacking * variance + negligible_fraction * explained);
        const auto lowest = lowest_between(scan, simpler_rad - reach_rad, simpler_rad + reach_rad);
        if (lowest.square_sum - best > max_worse + lost_between_fraction * explained) continue;
        const auto simpler =
            least_squares_near(flights, order, within(range, simpler_rad, reach_rad), lowest.theta_rad);
        const bool slope = std::abs(simpler.theta_rad - simpler_rad) > 0.9 * reach_rad;
        if (slope) continue;  // the least is where the search ended, not a minimum
        if (std::max(rounding, simpler.square_sum) - best <= max_worse) return simpler.theta_rad;
    }
    return found.theta_rad;
}

JointFit fit_at_frequency(std::span<const PhaseSamples> flights, int order, double theta_rad) {
    JointFit result;
    result.theta_rad = theta_rad;
    for (const auto& flight : flights) {
        auto fit = solve_least_squares(fourier_basis(flight.tau, order, theta_rad), as_vector(flight.power_w));
        if (!fit)
            throw NoResultError(
                fmt::format("flight '{}': the times of its {} samples do not determine a series of "
                            "order {} at omega * duration = {:.4g} rad",
                            flight.flight, flight.tau.size(), order, theta_rad));
        result.coefficients.push_back(std::move(fit->coefficients));
        result.square_sum.push_back(fit->residual_square_sum);
    }
    return result;
}

}  // namespace flightwatt::mechanical
