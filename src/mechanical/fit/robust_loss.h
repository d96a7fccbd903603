#pragma once

#include <cmath>
#include <optional>
#include <string_view>

namespace flightwatt::mechanical {

/// How a residual far from the curve counts.
enum class Loss {
    none,   ///< squared
    huber,  ///< squared to 1.345 scales, beyond that as its size
    cauchy  ///< as the logarithm of its size, from about 2.385 scales
};

constexpr std::string_view to_string(Loss loss) {
    return loss == Loss::huber ? "huber" : loss == Loss::cauchy ? "cauchy" : "none";
}

constexpr std::optional<Loss> loss_from(std::string_view name) {
    for (const auto loss : {Loss::none, Loss::huber, Loss::cauchy}) {
        if (name == to_string(loss)) return loss;
    }
    return std::nullopt;
}

/// Where the loss bends, in standard deviations of the noise: 95 % as efficient as least squares if the noise
/// is normal after all (the usual constants of Huber, and of Holland and Welsch).
constexpr double bend_of(Loss loss) { return loss == Loss::huber ? 1.345 : 2.385; }

/// What a sample counts, in (0, 1], at `residual` in scales of the noise: half the loss's slope over it.
inline double sample_weight(Loss loss, double residual) {
    const double bends = std::abs(residual) / bend_of(loss);
    if (loss == Loss::huber) return bends <= 1.0 ? 1.0 : 1.0 / bends;
    if (loss == Loss::cauchy) return 1.0 / (1.0 + bends * bends);
    return 1.0;
}

/// The derivative of residual * sample_weight: how far the fit follows a sample that moves.
inline double sample_influence(Loss loss, double residual) {
    const double bends = std::abs(residual) / bend_of(loss);
    if (loss == Loss::huber) return bends <= 1.0 ? 1.0 : 0.0;
    if (loss == Loss::cauchy) return (1.0 - bends * bends) / std::pow(1.0 + bends * bends, 2);
    return 1.0;
}

}  // namespace flightwatt::mechanical
