#pragma once

#include "mechanical/fit/phase_samples.h"
#include "mechanical/mechanical_model.h"

#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// How a residual far from the curve counts.
enum class Loss {
    none,  ///< squared
    huber  ///< squared to 1.345 scales, beyond that as its size
};

constexpr std::string_view to_string(Loss loss) { return loss == Loss::huber ? "huber" : "none"; }

constexpr std::optional<Loss> loss_from(std::string_view name) {
    for (const auto loss : {Loss::none, Loss::huber})
        if (name == to_string(loss)) return loss;
    return std::nullopt;
}

/// Where Huber's loss turns from squared to linear, in standard deviations of the noise: 95 % as efficient as
/// least squares if the noise is normal after all.
inline constexpr double huber_threshold = 1.345;

/// What a sample counts, in (0, 1], at `residual` in scales of the noise: half the loss's slope over it.
inline double sample_weight(Loss loss, double residual) {
    const double size = std::abs(residual);
    return loss == Loss::none || size <= huber_threshold ? 1.0 : huber_threshold / size;
}

/// The derivative of residual * sample_weight: how far the fit follows a sample that moves.
inline double sample_influence(Loss loss, double residual) {
    return loss == Loss::none || std::abs(residual) <= huber_threshold ? 1.0 : 0.0;
}

/// The frequency all flights share and each flight's own coefficients.
struct JointFit {
    double theta_rad = 0.0;
    std::vector<Eigen::VectorXd> coefficients;  ///< a0, a1, b1, ... a flight, in scaled values
    std::vector<double> square_sum;             ///< a flight, of the plain residuals
    double noise_scale = 0.0;  ///< 1.4826 times the median of the absolute residuals, for a robust loss
};

/// Levenberg-Marquardt (Ceres) over theta and all coefficients at once, from `start_rad`, within the range:
/// the least common sum of squares near where the search began. Throws NoResultError if it does not converge,
/// or if a flight's samples do not determine its coefficients.
JointFit refine_jointly(std::span<const ScaledSamples> flights, int order, const FrequencyRange& range,
                        double start_rad);

/// Moves a least-squares fit to the least Huber loss of all flights' residuals (an M-estimate), theta and all
/// coefficients together, sample by sample. The scale of the noise is taken from the residuals anew until it
/// stays. If more than half of the residuals are 0 there is nothing to weigh and the fit stays. Throws
/// NoResultError if it does not converge.
JointFit refine_robustly(std::span<const ScaledSamples> flights, const FrequencyRange& range, JointFit fit);

}  // namespace flightwatt::mechanical
