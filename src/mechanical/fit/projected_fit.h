#pragma once

#include "mechanical/fit/phase_samples.h"

#include <complex>
#include <span>
#include <vector>

namespace flightwatt::mechanical {

/// Sums over one flight's samples at the frequencies 0, step, 2 step, ... [rad per unit of tau]:
///     weight[m] = sum exp(i m step tau)         value[m] = sum value exp(i m step tau)
/// Every inner product of Fourier columns is made of them, since products of cosines are cosines of sums.
struct TrigonometricSums {
    std::vector<std::complex<double>> weight;
    std::vector<std::complex<double>> value;
};

/// The sums for m = 0 .. count - 1, sample by sample: samples x count operations, exact to rounding.
TrigonometricSums sum_directly(const ScaledSamples& samples, double step_rad, std::size_t count);

/// The same, all at once: the samples are spread on a fine grid with a Gaussian, transformed by FFT, and the
/// Gaussian divided out (Greengard and Lee, SIAM Review 46, 2004). Relative to the sum of absolute values the
/// error is below 1e-11.
TrigonometricSums sum_by_fft(const ScaledSamples& samples, double step_rad, std::size_t count);

/// By how much the best series of that order at theta = stride * step lowers the sum of squares of the values
/// that `sums` were made of. Needs the sums up to m = 2 * order * stride. Directions of the basis that the
/// normal equations cannot tell from rounding do not count: near-collinear bases give less, never nonsense.
double explained_square_sum(const TrigonometricSums& sums, std::size_t stride, int order);

/// The flights' common residual sum of squares at one frequency, each flight with its own best coefficients
/// (variable projection); exact sums, normal equations.
double projected_square_sum(std::span<const ScaledSamples> flights, int order, double theta_rad);

}  // namespace flightwatt::mechanical
