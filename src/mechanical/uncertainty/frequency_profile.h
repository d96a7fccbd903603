#pragma once

#include "mechanical/fit/phase_fit.h"
#include "mechanical/fit/phase_samples.h"
#include "mechanical/uncertainty/error_analysis.h"

#include <span>
#include <vector>

namespace flightwatt::mechanical {

/// How the flights' common residual grows as the frequency leaves its best value, all coefficients following.
struct FrequencyProfile {
    std::vector<double> theta_rad;  ///< omega * duration, rising
    std::vector<double> rms_w;      ///< of all residuals at each
    double low_rad = 0.0;           ///< the 95 % interval of theta
    double high_rad = 0.0;
    bool low_is_open = false;  ///< the interval ends where the admissible range does, not where the data say so
    bool high_is_open = false;
};

/// The profile about the frequency found, over twice the interval or as far as the range goes. The interval is that of
/// the analysis, all minima included, and holds the frequency found; it says when the data leave the frequency open. A
/// robust fit's profile is that of least squares. Order 0 and data without a frequency have an open interval and no
/// points.
FrequencyProfile frequency_profile(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                                   const ErrorAnalysis& analysis);

}  // namespace flightwatt::mechanical
