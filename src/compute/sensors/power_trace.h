#pragma once

#include "compute/profile_outcome.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// Reads a recording of power:
///   - CSV with columns time_s and power_w
///   - powprofiler layer 1 (flags 100, ...), in steps of `interval_s`
/// Throws InputError for another format, times that do not rise, or a missing interval.
PowerTrace read_power_trace(const std::filesystem::path& path, std::optional<double> interval_s);

/// CSV of time_s and power_w, after `comments`.
std::string to_csv(const PowerTrace& trace, const std::vector<std::string>& comments);

/// Jitter over the intervals within the runs; all 0 without an interval.
SamplingJitter jitter_of(const std::vector<PowerTrace>& runs);

/// Mean power of a run of `duration_s`, weighted by the time since the previous sample (the first: the median
/// interval). Standard error of a stationary series: s / sqrt(n) times sqrt(1 + 2 sum of autocorrelations), summed in
/// pairs while positive (Geyer, Practical Markov Chain Monte Carlo, 1992), at least s / sqrt(n); NaN for a single
/// sample. `run` is not empty.
PowerEstimate estimate_run(const PowerTrace& run, double duration_s);

/// Mean of the repeats' means and durations. The standard error is the larger of that between repeats (sd / sqrt(R),
/// for R > 1; of two or three repeats often near 0 by chance) and that of their own errors. `repeats` is not empty.
PowerEstimate combine_repeats(const std::vector<PowerEstimate>& repeats);

}  // namespace flightwatt::compute
