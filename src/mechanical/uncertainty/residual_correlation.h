#pragma once

#include <span>
#include <vector>

namespace flightwatt::mechanical {

/// How alike the noise of samples is, r^(|tau_j - tau_k| / step) where r is the autocorrelation of samples one step
/// apart: that between sample j - 1 and j; the first is 0. A gap is thus what it is, time for the noise to be
/// forgotten. `tau` must rise (equal times are allowed); step > 0; r in [0, 1).
std::vector<double> sample_correlation(std::span<const double> tau, double step, double autocorrelation);

/// How many independent samples tell the mean as well as these: n^2 over the sum of all correlations. Without
/// gaps and for many samples that is n (1 - r) / (1 + r).
double effective_samples(std::span<const double> correlation);

}  // namespace flightwatt::mechanical
