#pragma once

#include <cmath>
#include <optional>
#include <string_view>

namespace flightwatt::mechanical {

/// How a residual far from the curve counts.
enum class Loss {
    none,  ///< squared
    huber  ///< squared to 1.345 scales, beyond that as its size
};

constexpr std::string_view to_string(Loss loss) { return loss == Loss::huber ? "huber" : "none"; }

constexpr std::optional<Loss> loss_from(std::string_view name) {
    for (const auto loss : {Loss::none, Loss::huber}) {
        if (name == to_string(loss)) return loss;
    }
    return std::nullopt;
}

/// Where Huber's loss turns from squared to linear, in standard deviations of the noise: 95 % as efficient as
/// least squares if the noise is normal after all.
inline constexpr double tuning_constant = 1.345;

/// What a sample counts, in (0, 1], at `residual` in scales of the noise: half the loss's slope over it.
inline double sample_weight(Loss loss, double residual) {
    const double size = std::abs(residual);
    return loss == Loss::none || size <= tuning_constant ? 1.0 : tuning_constant / size;
}

/// The derivative of residual * sample_weight: how far the fit follows a sample that moves.
inline double sample_influence(Loss loss, double residual) {
    return loss == Loss::none || std::abs(residual) <= tuning_constant ? 1.0 : 0.0;
}

}  // namespace flightwatt::mechanical
