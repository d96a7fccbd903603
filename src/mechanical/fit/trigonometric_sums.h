#pragma once

#include "mechanical/phase_samples.h"

#include <complex>
#include <cstddef>
#include <vector>

/// Sums of nonuniform samples at equally spaced frequencies, by a fast Fourier transform (Eigen's): each sample is spread
/// over the nearest points of a grid by a smooth kernel, whose own transform is divided out afterwards (the kernel
/// exp(beta sqrt(1 - z^2)) of Barnett, Magland and af Klinteberg, SIAM J. Sci. Comput. 2019).
namespace flightwatt::mechanical {

/// Sums over one flight's samples at the frequencies 0, step, 2 step, ... [rad per unit of tau]:
///     weight[m] = sum exp(i m step tau)         value[m] = sum power exp(i m step tau)
/// Every inner product of Fourier columns is made of them, since products of cosines are cosines of sums.
struct TrigonometricSums {
    std::vector<std::complex<double>> weight;
    std::vector<std::complex<double>> value;
};

/// Returns the sums for m = 0 .. count - 1; step must be below pi, tau from 0 to 1. Relative to the sum of absolute values
/// their error is below 1e-11.
TrigonometricSums trigonometric_sums(const PhaseSamples& samples, double step_rad, std::size_t count);

}  // namespace flightwatt::mechanical
