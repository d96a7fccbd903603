#pragma once

#include "mechanical/fit/phase_fit.h"
#include "mechanical/fit/phase_samples.h"

#include <span>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

/// A sample whose robust weight is below 0.5.
struct DownWeightedSample {
    std::string flight;
    double log_time_s = 0.0;  ///< on the log's own clock
    double residual_w = 0.0;  ///< power less the flight's own curve
    double weight = 1.0;      ///< what it counted, less than a half
};

/// The samples that counted less than half of a sample on the curve (0.7 % do with normal
/// noise), those that counted least first. None for a plain fit. `flights` are those
/// that were fitted, in their order.
std::vector<DownWeightedSample> down_weighted_samples(std::span<const PhaseSamples> flights,
                                                      const PhaseFit& fit);

}  // namespace flightwatt::mechanical
