#pragma once

namespace flightwatt::mechanical {

/// A stationary deviation with exponential correlation (Ornstein-Uhlenbeck):
/// covariance(t, t + lag) = sd^2 exp(-lag / correlation_s).
struct Drift {
    double sd_w = 0.0;
    double correlation_s = 1.0;
};

/// Variance [W^2] of the mean over `duration_s`: 2 sd^2 (c/T)^2 (T/c - 1 + exp(-T/c)); sd^2 for T -> 0.
double variance_of_mean_w2(const Drift& drift, double duration_s);

/// Covariance [W^2] of the means over two stretches, the second of which follows the first.
double covariance_of_means_w2(const Drift& drift, double first_s, double second_s);

}  // namespace flightwatt::mechanical
