#include "mechanical/uncertainty/student_mixture.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

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

double degrees_of_freedom(std::span<const MeanCurveNode> nodes) {
    double sum = 0.0;
    for (const auto& node : nodes) sum += node.weight * node.degrees_of_freedom;
    return std::max(1.0, sum);
}

}  // namespace flightwatt::mechanical
