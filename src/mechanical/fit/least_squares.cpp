#include "mechanical/fit/least_squares.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/statistics.h"
#include "mechanical/fit/fourier_basis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/tools/minima.hpp>
#include <ceres/ceres.h>
#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// How far the highest harmonic may turn between two thetas of the scan: half of it, seen from the middle of
/// the phase, costs at most 2 % of a harmonic's power.
constexpr double turn_between_rad = 1.0;

/// So many minima of the scan are refined, at most, before the lowest is chosen. One that explains less than
/// this part of the best explanation cannot make it up within a step.
constexpr std::size_t refined_minima = 8;
constexpr double hopeful_fraction = 0.95;

/// Chance of taking noise for a harmonic.
constexpr double harmonic_significance = 1e-3;

/// A harmonic with less than this part of the power that the series explains may be done without.
constexpr double negligible_fraction = 0.02;

/// At a multiple that explains less than this, before it is refined, there is no need to look closer.
constexpr double promising_fraction = 0.5;

/// Below this part of the values' own sum of squares a residual is rounding.
constexpr double rounding_level = 1e-12;

/// Bits of theta that the refinement finds; a minimum cannot be placed better than half of a double's.
constexpr int refined_bits = 24;

struct Candidate {
    double theta_rad = 0.0;
    double square_sum = std::numeric_limits<double>::infinity();
};

double own_square_sum(std::span<const ScaledSamples> flights) {
    double sum = 0.0;
    for (const auto& flight : flights)
        sum = std::inner_product(flight.value.begin(), flight.value.end(), flight.value.begin(), sum);
    return sum;
}

Candidate refined(std::span<const ScaledSamples> flights, int order, const FrequencyRange& range, double theta_rad,
                  double reach_rad) {
    const double low = std::max(range.low_rad, theta_rad - reach_rad);
    const double high = std::min(range.high_rad, theta_rad + reach_rad);
    const auto square_sum = [&](double theta) { return projected_square_sum(flights, order, theta); };
    const auto [place, value] = boost::math::tools::brent_find_minima(square_sum, low, high, refined_bits);
    return {place, value};
}

/// The scan's local minima, its ends included, lowest first.
std::vector<Candidate> minima(const FrequencyScan& scan) {
    std::vector<Candidate> found;
    const auto& sums = scan.square_sum;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const bool falls = i == 0 || sums[i] <= sums[i - 1];
        const bool rises = i + 1 == sums.size() || sums[i] < sums[i + 1];
        if (falls && rises) found.push_back({scan.theta_rad[i], sums[i]});
    }
    std::ranges::sort(found, {}, &Candidate::square_sum);
    return found;
}

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

ScanGrid scan_grid(const FrequencyRange& range, int order) {
    const double step_rad = range.high_rad / std::ceil(range.high_rad * order / turn_between_rad);
    return {step_rad, static_cast<std::size_t>(std::ceil(range.low_rad / step_rad)),
            static_cast<std::size_t>(std::round(range.high_rad / step_rad))};
}

FlightScan scan_flight(const ScaledSamples& samples, int order, const FrequencyRange& range) {
    const auto [step_rad, first, last] = scan_grid(range, order);
    if (const auto* known = samples.scan.get(); known && known->order == order && known->step_rad == step_rad &&
                                                known->first == first && known->square_sum.size() == last - first + 1) {
        auto scan = *known;
        for (double& sum : scan.square_sum) sum *= samples.scan_unit * samples.scan_unit;
        return scan;
    }
    FlightScan scan{order, step_rad, first, {}};
    scan.square_sum.assign(last - first + 1, own_square_sum(std::span(&samples, 1)));
    const auto sums = sum_by_fft(samples, step_rad, 2 * static_cast<std::size_t>(order) * last + 1);
    for (std::size_t i = 0; i < scan.square_sum.size(); ++i)
        scan.square_sum[i] -= explained_square_sum(sums, first + i, order);
    return scan;
}

FrequencyScan scan_frequencies(std::span<const ScaledSamples> flights, int order, const FrequencyRange& range) {
    const auto [step_rad, first, last] = scan_grid(range, order);
    FrequencyScan scan{{}, std::vector<double>(last - first + 1, 0.0), step_rad};
    for (auto i = first; i <= last; ++i) scan.theta_rad.push_back(static_cast<double>(i) * step_rad);
    // A block at a time, because those of thousands of flights would fill the memory.
    constexpr std::size_t block = 64;
    for (std::size_t begin = 0; begin < flights.size(); begin += block) {
        const auto some = flights.subspan(begin, std::min(block, flights.size() - begin));
        std::vector<FlightScan> made(some.size());
        for_each_in_parallel(some.size(), [&](std::size_t i) { made[i] = scan_flight(some[i], order, range); });
        for (const auto& flight : made)
            for (std::size_t i = 0; i < scan.square_sum.size(); ++i) scan.square_sum[i] += flight.square_sum[i];
    }
    return scan;
}

double find_frequency(std::span<const ScaledSamples> flights, int order, const FrequencyRange& range,
                      const FrequencyScan& scan) {
    auto candidates = minima(scan);
    candidates.resize(std::min(candidates.size(), refined_minima));
    const double total = own_square_sum(flights);
    Candidate best;
    for (const auto& candidate : candidates) {
        if (total - candidate.square_sum < hopeful_fraction * (total - best.square_sum)) break;
        const auto fine = refined(flights, order, range, candidate.theta_rad, scan.step_rad);
        if (fine.square_sum < best.square_sum) best = fine;
    }
    return resolve_subharmonic(flights, order, range, best.theta_rad);
}

double resolve_subharmonic(std::span<const ScaledSamples> flights, int order, const FrequencyRange& range,
                           double theta_rad) {
    const double total = own_square_sum(flights);
    const double rounding = std::max(rounding_level * total, std::numeric_limits<double>::min());
    const double best = std::max(rounding, projected_square_sum(flights, order, theta_rad));
    double degrees_of_freedom = -1.0;
    for (const auto& flight : flights) {
        degrees_of_freedom += static_cast<double>(flight.tau.size()) - coefficient_count(order);
    }
    degrees_of_freedom = std::max(1.0, degrees_of_freedom);
    const double variance = best / degrees_of_freedom;
    for (int multiple = order; multiple >= 2; --multiple) {
        const double reach_rad = turn_between_rad / order * multiple;
        if (multiple * theta_rad + reach_rad > range.high_rad) continue;
        const double unrefined = projected_square_sum(flights, order, multiple * theta_rad);
        if (total - unrefined < promising_fraction * (total - best)) continue;
        const auto simpler = refined(flights, order, range, multiple * theta_rad, reach_rad);
        const bool slope = std::abs(simpler.theta_rad - multiple * theta_rad) > 0.9 * reach_rad;
        if (slope) continue;  // the least is where the search ended, not a minimum
        const int lost_harmonics = order - order / multiple;
        const double lacking = 2.0 * static_cast<double>(flights.size()) * lost_harmonics;
        const double worse = std::max(rounding, simpler.square_sum) - best;
        const boost::math::fisher_f distribution(lacking, degrees_of_freedom);
        const double by_chance =
            lacking * variance * boost::math::quantile(boost::math::complement(distribution, harmonic_significance));
        if (worse <= by_chance && worse - lacking * variance <= negligible_fraction * (total - best)) {
            return simpler.theta_rad;
        }
    }
    return theta_rad;
}

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
