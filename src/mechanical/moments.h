#pragma once

#include <cmath>
#include <numeric>
#include <span>

namespace flightwatt::mechanical {

/// Of values that are not empty.
inline double mean_of(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Sample standard deviation (n - 1) of 2 values or more.
inline double sample_sd(std::span<const double> values) {
    const double mean = mean_of(values);
    double square_sum = 0.0;
    for (const double value : values) square_sum += (value - mean) * (value - mean);
    return std::sqrt(square_sum / static_cast<double>(values.size() - 1));
}

}  // namespace flightwatt::mechanical
