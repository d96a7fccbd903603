// Curves that do not fall below 0 W.

#include "base/statistics.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/phase_fit.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/QR>

namespace flightwatt::mechanical {
namespace {

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

}  // namespace

void hold_above_zero(std::span<const PhaseSamples> flights, PhaseFit& fit) {
    constexpr double between_points = 1e-3;  // of a curve's range
    double square_sum = 0.0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        auto& flight = fit.flights[i];
        const auto points = curve_point_count(flight.fourier, flight.duration_s);
        const auto curve = curve_w(flight.fourier, flight.duration_s, points);
        const auto [low_w, high_w] = std::ranges::minmax(curve);
        if (low_w < 0.0 && mean(curve) > 0.0) {  // else the measured power is negative
            std::vector<double> tau(points);     // the middles of equal parts, as curve_w
            for (std::size_t k = 0; k < points; ++k)
                tau[k] = (static_cast<double>(k) + 0.5) / static_cast<double>(points);
            Eigen::VectorXd coefficients = coefficients_of(flight.fourier);
            const auto order = static_cast<int>(flight.fourier.cos_w.size());
            lift_above(fourier_basis(tau, order, fit.theta_rad), coefficients, between_points * (high_w - low_w));
            flight.fourier = series_of(coefficients, flight.fourier.omega_rad_per_s);
            const auto residual = residual_of(flights[i], fit.theta_rad, coefficients);
            flight.rms_w = std::sqrt(residual.squaredNorm() / static_cast<double>(flight.samples));
            fit.is_clamped = true;
        }
        square_sum += flight.rms_w * flight.rms_w * static_cast<double>(flight.samples);
    }
    if (fit.is_clamped) fit.rms_w = std::sqrt(square_sum / static_cast<double>(fit.samples));
}

}  // namespace flightwatt::mechanical
