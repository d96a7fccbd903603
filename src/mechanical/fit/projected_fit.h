#pragma once

#include "mechanical/fit/phase_samples.h"
#include "mechanical/fit/trigonometric_sums.h"

#include <cstddef>
#include <span>

namespace flightwatt::mechanical {

/// By how much the best series of that order at theta = stride * step lowers the sum of squares of the values
/// that `sums` were made of. Needs the sums up to m = 2 * order * stride. Directions of the basis that the
/// normal equations cannot tell from rounding are left out, so near-collinear bases give less, never
/// nonsense.
double explained_square_sum(const TrigonometricSums& sums, std::size_t stride, int order);

/// The flights' common residual sum of squares at one frequency, each flight with its own best coefficients
/// (variable projection); exact sums, normal equations.
double projected_square_sum(std::span<const ScaledSamples> flights, int order, double theta_rad);

}  // namespace flightwatt::mechanical
