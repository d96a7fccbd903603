#pragma once

#include "mechanical/fit/phase_samples.h"

#include <complex>
#include <cstddef>
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

}  // namespace flightwatt::mechanical
