#include "mechanical/physical/student_t.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flightwatt::mechanical {
namespace {

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
