#pragma once

namespace flightwatt::mechanical {

/// A stationary deviation with exponential correlation (Ornstein-Uhlenbeck):
/// covariance(t, t + lag) = sd^2 exp(-lag / correlation_s) (docs/methods.md, Eqs. 17 and 18).
struct Drift {
    double sd_w = 0.0;
    double correlation_s = 1.0;
};

/// Variance [W^2] of the mean over `duration_s` (docs/methods.md, Eq. 17).
double variance_of_mean_w2(const Drift& drift, double duration_s);

/// Covariance [W^2] of the means over two stretches, the second of which follows the first.
double covariance_of_means_w2(const Drift& drift, double first_s, double second_s);

}  // namespace flightwatt::mechanical
