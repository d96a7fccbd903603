#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace flightwatt::mechanical {

/// The median of the gaps between samples, as a part of the phase; 0 if all samples are at one time.
inline double median_gap(std::vector<double> tau) {
    std::sort(tau.begin(), tau.end());
    std::vector<double> gaps;
    for (std::size_t i = 1; i < tau.size(); ++i) {
        if (tau[i] > tau[i - 1]) gaps.push_back(tau[i] - tau[i - 1]);
    }
    if (gaps.empty()) return 0.0;
    const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
    std::nth_element(gaps.begin(), middle, gaps.end());
    return *middle;
}

}  // namespace flightwatt::mechanical
