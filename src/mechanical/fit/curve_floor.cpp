// Curves that do not fall below 0 W.

#include "base/statistics.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/phase_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/QR>

namespace flightwatt::mechanical {
namespace {

constexpr double between_points = 1e-3;  ///< of a curve's range

/// 0, or the lowest mean power over a fifth of the phase that is negative by more than chance (95 %): shorter negative
/// power is noise.
double min_power_w(const PhaseSamples& samples) {
    constexpr std::size_t min_samples = 3;
    std::array<std::vector<double>, 5> fifths_w;
    for (std::size_t i = 0; i < samples.tau.size(); ++i)
        fifths_w.at(std::min<std::size_t>(4, static_cast<std::size_t>(5.0 * samples.tau[i])))
            .push_back(samples.power_w[i]);
    double min_w = 0.0;
    for (const auto& power_w : fifths_w) {
        if (power_w.size() < min_samples) continue;
        const auto size = static_cast<double>(power_w.size());
        min_w =
            std::min(min_w, mean(power_w) + student_t_half_width(size - 1.0) * sample_sd(power_w) / std::sqrt(size));
    }
    return min_w;
}

/// Alternating projections onto the curves above the limit, the series, and those of the same mean power; the harmonics
/// of the result are scaled by the rest.
void lift_above(const Eigen::MatrixXd& basis, Eigen::VectorXd& coefficients, double min_w) {
    constexpr int rounds = 50;
    const double mean_w = std::max((basis * coefficients).mean(), min_w);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(basis);
    for (int round = 0; round < rounds; ++round) {
        coefficients = qr.solve((basis * coefficients).cwiseMax(min_w));
        coefficients(0) += mean_w - (basis * coefficients).mean();
    }
    const double lowest_w = (basis * coefficients).minCoeff();
    if (lowest_w >= min_w) return;
    const double fraction = (mean_w - min_w) / (mean_w - lowest_w);
    coefficients *= fraction;
    coefficients(0) += (1.0 - fraction) * mean_w;
}

/// The curve's basis at the middles of equal parts of the phase, which resolve it.
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
        const Eigen::VectorXd curve = basis * coefficients;
        if (curve.minCoeff() < floor_w) {
            // A little higher than the floor, for what is between the points.
            lift_above(basis, coefficients, floor_w + between_points * (curve.maxCoeff() - curve.minCoeff()));
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
