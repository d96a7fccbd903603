#include "mechanical/uncertainty/frequency_profile.h"

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

/// At a bound of the range the density is so much of its peak: the data do not end the interval there.
constexpr double open_density = 0.1;

}  // namespace

FrequencyProfile frequency_profile(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                                   const ErrorAnalysis& analysis) {
    const auto order = static_cast<int>(fit.flights.front().fourier.cos_w.size());
    FrequencyProfile profile{{}, {}, fit.range.low_rad, fit.range.high_rad, true, true};
    if (order == 0 || analysis.errors.frequency_is_fixed) return profile;

    const auto& density = analysis.posterior->density;
    const auto [low, high] = frequency_interval(*analysis.posterior);
    profile.low_rad = std::min(low, fit.theta_rad);
    profile.high_rad = std::max(high, fit.theta_rad);
    const auto& places = analysis.posterior->theta_rad;
    profile.low_is_open = places.front() <= fit.range.low_rad && density.front() >= open_density;
    profile.high_is_open = places.back() >= fit.range.high_rad && density.back() >= open_density;
    const auto square_sum = [&](double theta_rad) { return square_sum_w2(flights, order, theta_rad); };

    const double first = std::max(fit.range.low_rad, 2.0 * profile.low_rad - fit.theta_rad);
    const double last = std::min(fit.range.high_rad, 2.0 * profile.high_rad - fit.theta_rad);
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
