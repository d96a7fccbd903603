#include "mechanical/fit/student_t.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/toms748_solve.hpp>

namespace flightwatt::mechanical {
namespace {

constexpr double spacing = 0.02;     ///< of asinh(t)
constexpr std::size_t points = 700;  ///< to t = 6e5

double cdf_of(const StudentMixture& mixture, const StudentCdf& cdf, double value) {
    double sum = 0.0;
    for (std::size_t i = 0; i < mixture.weight.size(); ++i) {
        const double apart = value - mixture.location[i];
        const double part = mixture.scale[i] > 0.0 ? cdf(apart / mixture.scale[i]) : apart < 0.0 ? 0.0 : 1.0;
        sum += mixture.weight[i] * part;
    }
    return sum;
}

double quantile_of(const StudentMixture& mixture, const StudentCdf& cdf, double probability) {
    double low = mixture.location[0];
    double high = low;
    double widest = 0.0;
    for (std::size_t i = 0; i < mixture.location.size(); ++i) {
        low = std::min(low, mixture.location[i] - mixture.scale[i]);
        high = std::max(high, mixture.location[i] + mixture.scale[i]);
        widest = std::max(widest, mixture.scale[i]);
    }
    if (high <= low) return low;
    const auto behind = [&](double value) { return cdf_of(mixture, cdf, value) - probability; };
    constexpr int max_doublings = 60;
    const double width = high - low;
    for (int i = 0; i < max_doublings && behind(low) > 0.0; ++i) low -= std::ldexp(width, i);
    for (int i = 0; i < max_doublings && behind(high) < 0.0; ++i) high += std::ldexp(width, i);
    std::uintmax_t max_steps = 60;
    const auto close = [&](double a, double b) { return std::abs(b - a) <= 1e-5 * widest; };
    const auto [below, above] = boost::math::tools::toms748_solve(behind, low, high, close, max_steps);
    return (below + above) / 2.0;
}

constexpr double inner_fraction = 0.6827;
constexpr double outer_fraction = 0.95;
constexpr double min_degrees_of_freedom = 1.0;
constexpr double max_degrees_of_freedom = 200.0;
constexpr int bisections = 60;

/// Where |value| lies below with that probability.
double half_width(std::span<const double> sds, std::span<const double> weights, double part) {
    double low = 0.0;
    double high = 20.0 * *std::ranges::max_element(sds);
    for (int i = 0; i < bisections; ++i) {
        const double middle = 0.5 * (low + high);
        double outside = 0.0;
        for (std::size_t n = 0; n < sds.size(); ++n)
            if (sds[n] > 0.0) outside += weights[n] * std::erfc(middle / sds[n] / std::numbers::sqrt2);
        (outside > 1.0 - part ? low : high) = middle;
    }
    return high;
}

}  // namespace

StudentCdf::StudentCdf(double degrees_of_freedom) {
    const boost::math::students_t distribution(std::max(1.0, degrees_of_freedom));
    for (std::size_t i = 0; i < points; ++i) {
        upper_.push_back(boost::math::cdf(distribution, std::sinh(static_cast<double>(i) * spacing)));
    }
}

double StudentCdf::operator()(double t) const {
    const double place = std::asinh(std::abs(t)) / spacing;
    const auto before = static_cast<std::size_t>(place);
    double value = 1.0;
    if (before + 1 < points) {
        const double rest = place - static_cast<double>(before);
        value = (1.0 - rest) * upper_[before] + rest * upper_[before + 1];
    }
    return t < 0.0 ? 1.0 - value : value;
}

double mixture_mean(const StudentMixture& mixture) {
    double sum = 0.0;
    for (std::size_t i = 0; i < mixture.weight.size(); ++i) sum += mixture.weight[i] * mixture.location[i];
    return sum;
}

double mixture_sd(const StudentMixture& mixture, double degrees_of_freedom) {
    const double freedom = std::max(3.0, degrees_of_freedom);
    const double mean = mixture_mean(mixture);
    double sum = 0.0;
    for (std::size_t i = 0; i < mixture.weight.size(); ++i) {
        const double within = mixture.scale[i] * mixture.scale[i] * freedom / (freedom - 2.0);
        sum += mixture.weight[i] * (within + std::pow(mixture.location[i] - mean, 2));
    }
    return std::sqrt(sum);
}

Interval mixture_interval(const StudentMixture& mixture, const StudentCdf& cdf) {
    const double tail = (1.0 - confidence_level) / 2.0;
    return {quantile_of(mixture, cdf, tail), quantile_of(mixture, cdf, 1.0 - tail)};
}

StudentT fit_student_t(std::span<const double> sds, std::span<const double> weights) {
    const double inner = half_width(sds, weights, inner_fraction);
    const double outer = half_width(sds, weights, outer_fraction);
    if (!(outer > 0.0)) return {0.0, max_degrees_of_freedom};
    double low = std::log(min_degrees_of_freedom);
    double high = std::log(max_degrees_of_freedom);
    for (int i = 0; i < bisections; ++i) {
        const double middle = std::exp(0.5 * (low + high));
        const double ratio =
            student_t_half_width(middle, outer_fraction) / student_t_half_width(middle, inner_fraction);
        // The tails are the wider the fewer the degrees of freedom.
        (ratio * inner > outer ? low : high) = std::log(middle);
    }
    const double degrees_of_freedom = std::exp(low);
    return {outer / student_t_half_width(degrees_of_freedom, outer_fraction), degrees_of_freedom};
}

}  // namespace flightwatt::mechanical
