#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/statistics/univariate_statistics.hpp>

namespace flightwatt {
namespace {

/// Where an interval of that probability about 0 ends.
constexpr double upper_tail(double probability) { return 0.5 + probability / 2.0; }

}  // namespace

double mean(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double sample_variance(std::span<const double> values) {
    return boost::math::statistics::sample_variance(values.begin(), values.end());
}

double sample_sd(std::span<const double> values) { return std::sqrt(sample_variance(values)); }

double median(std::vector<double> values) { return boost::math::statistics::median(values.begin(), values.end()); }

double median_high(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double quantile(std::span<const double> sorted, double probability) {
    const double place = static_cast<double>(sorted.size() - 1) * probability;
    const auto below = static_cast<std::size_t>(place);
    if (below + 1 >= sorted.size()) return sorted.back();
    return std::lerp(sorted[below], sorted[below + 1], place - static_cast<double>(below));
}

double quantile_of(std::vector<double> values, double probability) {
    std::ranges::sort(values);
    return quantile(values, probability);
}

double normal_quantile(double probability) {
    return boost::math::quantile(boost::math::normal_distribution<double>(), probability);
}

double normal_half_width() { return normal_quantile(upper_tail(confidence_level)); }

double student_t_half_width(double degrees_of_freedom, double probability) {
    const boost::math::students_t_distribution<double> distribution(std::max(1.0, degrees_of_freedom));
    return boost::math::quantile(distribution, upper_tail(probability));
}

std::vector<std::vector<std::size_t>> make_folds(std::size_t count, std::size_t most) {
    std::vector<std::vector<std::size_t>> folds(std::min(count, most));
    for (std::size_t i = 0; i < count && !folds.empty(); ++i) folds[i % folds.size()].push_back(i);
    return folds;
}

}  // namespace flightwatt
