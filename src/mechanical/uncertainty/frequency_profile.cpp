#include "mechanical/uncertainty/frequency_profile.h"

#include "base/statistics.h"
#include "mechanical/fit/fourier_basis.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flightwatt::mechanical {
namespace {

constexpr int points_a_side = 20;

/// The flights' least common sum of squares at one frequency [W^2].
double square_sum_w2(std::span<const PhaseSamples> flights, int order, double theta_rad) {
    double sum = 0.0;
    for (const auto& flight : flights) {
        const auto fit = solve_least_squares(fourier_basis(flight.tau, order, theta_rad), as_vector(flight.power_w));
        if (!fit) return std::numeric_limits<double>::infinity();
        sum += fit->residual_square_sum;
    }
    return sum;
}

struct End {
    double theta_rad = 0.0;
    bool open = false;
};

/// Where the sum of squares crosses `limit` between the best theta and the range's bound, or that bound.
template <typename SquareSum>
End end_of_interval(const SquareSum& square_sum, double best_rad, double step_rad, double bound_rad, double limit) {
    const double direction = bound_rad < best_rad ? -1.0 : 1.0;
    double inside = best_rad;
    double outside = best_rad;
    for (double reach = step_rad;; reach *= 1.5) {
        if (reach >= std::abs(bound_rad - best_rad)) {
            if (square_sum(bound_rad) <= limit) return {bound_rad, true};
            outside = bound_rad;
            break;
        }
        outside = best_rad + direction * reach;
        if (square_sum(outside) > limit) break;
        inside = outside;
    }
    while (std::abs(outside - inside) > 1e-9 * best_rad) {
        const double middle = (inside + outside) / 2.0;
        (square_sum(middle) > limit ? outside : inside) = middle;
    }
    return {inside, false};
}

}  // namespace

FrequencyProfile frequency_profile(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                                   const ErrorAnalysis& analysis) {
    const auto order = static_cast<int>(fit.flights.front().fourier.cos_w.size());
    FrequencyProfile profile{{}, {}, fit.range.low_rad, fit.range.high_rad, true, true};
    if (order == 0 || analysis.free_theta_rad <= 0.0) return profile;

    const auto square_sum = [&](double theta_rad) { return square_sum_w2(flights, order, theta_rad); };
    const double best = square_sum(fit.theta_rad);
    const double half_width = student_t_half_width(analysis.errors.degrees_of_freedom);
    const double limit = best + analysis.theta_information * std::pow(half_width * analysis.free_theta_rad, 2);
    const double step_rad = half_width * analysis.free_theta_rad / 4.0;
    const auto low = end_of_interval(square_sum, fit.theta_rad, step_rad, fit.range.low_rad, limit);
    const auto high = end_of_interval(square_sum, fit.theta_rad, step_rad, fit.range.high_rad, limit);
    profile = {{}, {}, low.theta_rad, high.theta_rad, low.open, high.open};

    const double first = std::max(fit.range.low_rad, 2.0 * low.theta_rad - fit.theta_rad);
    const double last = std::min(fit.range.high_rad, 2.0 * high.theta_rad - fit.theta_rad);
    for (int i = -points_a_side; i <= points_a_side; ++i) {
        const double part = static_cast<double>(i) / points_a_side;
        const double reach = i < 0 ? fit.theta_rad - first : last - fit.theta_rad;
        if (reach <= 0.0 && i != 0) continue;
        const double theta_rad = fit.theta_rad + part * reach;
        profile.theta_rad.push_back(theta_rad);
        profile.rms_w.push_back(std::sqrt(square_sum(theta_rad) / static_cast<double>(fit.samples)));
    }
    return profile;
}

}  // namespace flightwatt::mechanical
