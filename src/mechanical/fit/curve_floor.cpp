// Curves that do not fall below 0 W.

#include "base/statistics.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/phase_fit.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Cholesky>

namespace flightwatt::mechanical {
namespace {

/// Negative power lasts this part of the phase, or it is noise: so long noise lasts at most (frequency_posterior.h).
constexpr double part_of_negative_power = 0.2;

constexpr double between_points = 1e-3;  ///< of a curve's range

/// 0, or the least mean power over a part of the phase that is below 0 by more than chance (95 %).
double min_power_w(const PhaseSamples& samples) {
    const auto sorted = sort_by_time({samples.tau, samples.power_w, samples.flight});
    constexpr std::size_t min_samples = 3;
    double min_w = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    std::size_t first = 0;
    for (std::size_t last = 0; last < sorted.tau.size(); ++last) {
        sum += sorted.value[last];
        squares += sorted.value[last] * sorted.value[last];
        // The shortest stretch that ends here and is long enough.
        while (sorted.tau[last] - sorted.tau[first + (first < last ? 1 : 0)] >= part_of_negative_power) {
            sum -= sorted.value[first];
            squares -= sorted.value[first] * sorted.value[first];
            ++first;
        }
        const std::size_t count = last - first + 1;
        if (sorted.tau[last] - sorted.tau[first] < part_of_negative_power || count < min_samples) continue;
        const auto size = static_cast<double>(count);
        const double mean_w = sum / size;
        if (mean_w >= 0.0) continue;
        const double sd_w = std::sqrt(std::max(0.0, squares / size - mean_w * mean_w) * size / (size - 1.0));
        min_w = std::min(min_w, mean_w + student_t_half_width(size - 1.0) * sd_w / std::sqrt(size));
    }
    return min_w;
}

/// Bends a curve up where it falls below its floor, with ever more weight on these places and on the mean power, which
/// stays; what is left of it after that is taken by smaller harmonics.
void lift_above(const Eigen::MatrixXd& basis, Eigen::VectorXd& coefficients, double floor_w) {
    constexpr int max_rounds = 12;
    constexpr double weight_of_mean = 1e3;
    const auto points = static_cast<double>(basis.rows());
    const Eigen::VectorXd found = basis * coefficients;
    // A little higher, for what lies between the points.
    floor_w += between_points * (found.maxCoeff() - found.minCoeff());
    const double mean_w = std::max(found.mean(), floor_w);
    const Eigen::VectorXd wanted = found.cwiseMax(floor_w);
    const Eigen::RowVectorXd mean_row = basis.colwise().mean();
    Eigen::VectorXd weights = Eigen::VectorXd::Ones(basis.rows());
    for (int round = 0; round < max_rounds && (basis * coefficients).minCoeff() < floor_w; ++round) {
        const Eigen::VectorXd curve = basis * coefficients;
        for (Eigen::Index i = 0; i < curve.size(); ++i)
            if (curve(i) < floor_w) weights(i) *= 3.0;
        const double of_mean = weight_of_mean * weights.sum();
        Eigen::MatrixXd normal = basis.transpose() * weights.asDiagonal() * basis;
        normal += of_mean * mean_row.transpose() * mean_row;
        normal.diagonal().tail(coefficients.size() - 1).array() += 1e-6 * points;
        coefficients = normal.ldlt().solve(basis.transpose() * weights.cwiseProduct(wanted) +
                                           of_mean * mean_w * mean_row.transpose());
    }
    coefficients(0) += mean_w - mean_row.dot(coefficients);
    const double min_w = (basis * coefficients).minCoeff();
    if (min_w >= floor_w) return;
    const double kept = (mean_w - floor_w) / (mean_w - min_w);
    coefficients *= kept;
    coefficients(0) += (1.0 - kept) * mean_w;
}

/// The curve's basis at the middles of equal parts of the phase that show every swing.
Eigen::MatrixXd fine_basis(const FlightCurve& flight, double theta_rad) {
    const auto points = curve_point_count(flight.fourier, flight.duration_s);
    std::vector<double> tau;
    for (std::size_t i = 0; i < points; ++i)
        tau.push_back((static_cast<double>(i) + 0.5) / static_cast<double>(points));
    return fourier_basis(tau, static_cast<int>(flight.fourier.cos_w.size()), theta_rad);
}

}  // namespace

void hold_above_floor(std::span<const PhaseSamples> flights, PhaseFit& fit) {
    if (fit.flights.front().fourier.cos_w.empty() || is_constant(flights)) return;
    double square_sum = 0.0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        auto& flight = fit.flights[i];
        const auto basis = fine_basis(flight, fit.theta_rad);
        const double floor_w = min_power_w(flights[i]);
        Eigen::VectorXd coefficients = coefficients_of(flight.fourier);
        if ((basis * coefficients).minCoeff() < floor_w) {
            lift_above(basis, coefficients, floor_w);
            flight.fourier = series_of(coefficients, flight.fourier.omega_rad_per_s);
            const auto order = static_cast<int>(flight.fourier.cos_w.size());
            const Eigen::VectorXd residuals =
                fourier_basis(flights[i].tau, order, fit.theta_rad) * coefficients - as_vector(flights[i].power_w);
            flight.rms_w = std::sqrt(residuals.squaredNorm() / static_cast<double>(flight.samples));
            fit.is_clamped = true;
        }
        square_sum += flight.rms_w * flight.rms_w * static_cast<double>(flight.samples);
    }
    if (fit.is_clamped) fit.rms_w = std::sqrt(square_sum / static_cast<double>(fit.samples));
}

}  // namespace flightwatt::mechanical
