#include "mechanical/phase_curve.h"

#include "base/units.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/least_squares.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::mechanical {

std::size_t points_of_curve(const FourierModel& model, double duration_s) {
    const double turns = model.omega_rad_per_s * duration_s / units::rad_per_turn;
    const double swings = turns * static_cast<double>(model.cos_w.size());
    return std::max<std::size_t>(1000, static_cast<std::size_t>(std::ceil(16.0 * swings)));
}

std::vector<double> curve_w(const FourierModel& model, double duration_s, std::size_t points) {
    std::vector<double> curve(points);
    for (std::size_t i = 0; i < points; ++i) {
        const double tau = (static_cast<double>(i) + 0.5) / static_cast<double>(points);
        curve[i] = power_w(model, tau * duration_s);
    }
    return curve;
}

double curve_rms_difference_w(const PhaseModel& a, const PhaseModel& b) {
    const std::size_t points =
        std::max(points_of_curve(a.fourier, a.duration_s), points_of_curve(b.fourier, b.duration_s));
    const auto curve_a = curve_w(a.fourier, a.duration_s, points);
    const auto curve_b = curve_w(b.fourier, b.duration_s, points);
    double sum = 0.0;
    for (std::size_t i = 0; i < points; ++i) sum += std::pow(curve_a[i] - curve_b[i], 2);
    return std::sqrt(sum / static_cast<double>(points));
}

std::optional<FourierModel> nearest_series(std::span<const double> tau, std::span<const double> power_w,
                                           int order, double omega_rad_per_s, double duration_s) {
    const Eigen::Map<const Eigen::VectorXd> values(power_w.data(), static_cast<Eigen::Index>(power_w.size()));
    const auto fit = solve_least_squares(fourier_basis(tau, order, omega_rad_per_s * duration_s), values);
    if (!fit) return std::nullopt;
    FourierModel series{omega_rad_per_s, fit->coefficients[0], {}, {}};
    for (Eigen::Index n = 1; n <= order; ++n) {
        series.cos_w.push_back(fit->coefficients[2 * n - 1]);
        series.sin_w.push_back(fit->coefficients[2 * n]);
    }
    return series;
}

}  // namespace flightwatt::mechanical
