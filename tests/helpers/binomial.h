#pragma once

#include <cmath>
#include <cstddef>

namespace flightwatt::test {

/// Standard error of a share of `count` independent trials.
inline double binomial_error(double share, std::size_t count) {
    return std::sqrt(share * (1.0 - share) / static_cast<double>(count));
}

/// Whether a share of `count` trials may be that of trials which succeed with `least` or more: within three standard
/// errors, beyond which independent trials are once in 700 times.
inline bool is_at_least(double share, double least, std::size_t count) {
    return share >= least - 3.0 * binomial_error(least, count);
}

}  // namespace flightwatt::test
