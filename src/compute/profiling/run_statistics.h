#pragma once

#include "compute/profile_outcome.h"

#include <vector>

namespace flightwatt::compute {

/// Jitter over all the runs; intervals of one run only. All 0 with no interval.
SamplingJitter jitter_of(const std::vector<PowerTrace>& runs);

/// Mean power of a run of `duration_s`: each sample weighs as much as the time since the one before (the
/// first: as the median interval), so that samples that come late do not count for less. The standard error
/// is that of a stationary series: s / sqrt(n) times sqrt(1 + 2 sum of autocorrelations), summed in pairs as
/// long as these are positive (Geyer, Practical Markov Chain Monte Carlo, 1992), and at least the
/// uncorrelated s / sqrt(n); NaN for a single sample. `run` must not be empty.
PowerEstimate estimate_run(const PowerTrace& run, double duration_s);

/// The repeats of a configuration: mean of their means and durations. The standard error is the larger of
/// that between the repeats (sd / sqrt(R), for R > 1) and that of their own errors: of two or three repeats
/// the first alone is often near 0 by chance. `repeats` must not be empty.
PowerEstimate combine_repeats(const std::vector<PowerEstimate>& repeats);

}  // namespace flightwatt::compute
