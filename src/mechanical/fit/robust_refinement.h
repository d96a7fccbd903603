#pragma once

#include "mechanical/fit/joint_refinement.h"

#include <span>

namespace flightwatt::mechanical {

struct RobustFit {
    JointFit joint;      ///< square_sum is that of the plain residuals
    double scale = 0.0;  ///< of the noise: 1.4826 times the median of the absolute residuals
};

/// Moves a least-squares fit to the least Huber loss of all flights' residuals (an M-estimate), theta and all
/// coefficients together, sample by sample with Ceres's loss function. The scale of the noise is taken from
/// the residuals anew until it stays. If more than half of the residuals are 0 there is nothing to weigh and the fit stays. Throws NoAnswerError
/// if it does not converge.
RobustFit refine_robustly(std::span<const ScaledSamples> flights, const FrequencyRange& range,
                          const JointFit& start);

}  // namespace flightwatt::mechanical
