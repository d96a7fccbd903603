#pragma once

#include "mechanical/fit/phase_samples.h"
#include "mechanical/mechanical_model.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// The frequency all flights share and each flight's own coefficients, at the least common sum of squares
/// near where the search began.
struct JointFit {
    double theta_rad = 0.0;
    std::vector<Eigen::VectorXd> coefficients;  ///< a0, a1, b1, ... a flight, in scaled values
    std::vector<double> square_sum;             ///< a flight
};

/// Levenberg-Marquardt (Ceres) over theta and all coefficients at once, from `start_rad`, within the range.
/// Throws NoAnswerError if it does not converge, or if a flight's samples do not determine its coefficients.
JointFit refine_jointly(std::span<const ScaledSamples> flights, int order, const FrequencyRange& range,
                        double start_rad);

}  // namespace flightwatt::mechanical
