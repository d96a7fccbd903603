#include "mechanical/fit/trigonometric_sums.h"

#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include <unsupported/Eigen/FFT>

namespace flightwatt::mechanical {
namespace {

using Complex = std::complex<double>;

/// Cells of the grid that a sample reaches on each side; 12 at twofold oversampling give about 12 digits.
constexpr std::size_t reach = 12;

/// Samples spread on one turn of the circle, its angle being step * tau. Real part: weights; imaginary part:
/// values. One complex transform then serves both.
struct SpreadGrid {
    std::vector<Complex> cells;
    double width = 0.0;  ///< the Gaussian is exp(-angle^2 / (4 width))
};

SpreadGrid spread(const ScaledSamples& samples, double step_rad, std::size_t count) {
    // Modes run from -count to count; twice as many cells keep the Gaussian's images apart.
    const std::size_t cells = std::bit_ceil(std::max<std::size_t>(4 * count, 4 * reach));
    const double modes = 2.0 * static_cast<double>(count);
    const double oversampling = static_cast<double>(cells) / modes;
    const double cell = 2.0 * std::numbers::pi / static_cast<double>(cells);

    SpreadGrid grid;
    grid.cells.assign(cells, Complex(0.0, 0.0));
    grid.width =
        std::numbers::pi * static_cast<double>(reach) / (modes * modes * oversampling * (oversampling - 0.5));
    std::array<double, 2 * reach> fixed_factor{};  // exp(-(offset cell)^2 / (4 width))
    for (std::size_t k = 0; k < fixed_factor.size(); ++k) {
        const double offset = (static_cast<double>(k) - static_cast<double>(reach - 1)) * cell;
        fixed_factor[k] = std::exp(-offset * offset / (4.0 * grid.width));
    }
    for (std::size_t i = 0; i < samples.tau.size(); ++i) {
        const double angle = step_rad * samples.tau[i];
        const auto nearest = static_cast<std::size_t>(angle / cell);
        const double rest = angle - static_cast<double>(nearest) * cell;
        const double ratio = std::exp(rest * cell / (2.0 * grid.width));
        double factor =
            std::exp(-rest * rest / (4.0 * grid.width)) * std::pow(ratio, 1.0 - static_cast<double>(reach));
        const Complex sample(1.0, samples.value[i]);
        for (std::size_t k = 0; k < fixed_factor.size(); ++k) {
            const std::size_t place = (nearest + cells + k - (reach - 1)) & (cells - 1);
            grid.cells[place] += sample * (factor * fixed_factor[k]);
            factor *= ratio;
        }
    }
    return grid;
}

}  // namespace

TrigonometricSums sum_directly(const ScaledSamples& samples, double step_rad, std::size_t count) {
    TrigonometricSums sums{std::vector<Complex>(count), std::vector<Complex>(count)};
    for (std::size_t i = 0; i < samples.tau.size(); ++i) {
        const double angle = step_rad * samples.tau[i];
        const Complex turn(std::cos(angle), std::sin(angle));
        Complex power(1.0, 0.0);
        for (std::size_t m = 0; m < count; ++m) {
            sums.weight[m] += power;
            sums.value[m] += samples.value[i] * power;
            power *= turn;
        }
    }
    return sums;
}

TrigonometricSums sum_by_fft(const ScaledSamples& samples, double step_rad, std::size_t count) {
    const SpreadGrid grid = spread(samples, step_rad, count);
    const std::size_t cells = grid.cells.size();
    std::vector<Complex> modes;
    Eigen::FFT<double>().fwd(modes, grid.cells);

    TrigonometricSums sums{std::vector<Complex>(count), std::vector<Complex>(count)};
    const double scale = std::sqrt(std::numbers::pi / grid.width) / static_cast<double>(cells);
    for (std::size_t m = 0; m < count; ++m) {
        // fwd has exp(-i m angle): conjugate. Real and imaginary input part from the modes m and -m.
        const Complex forward = modes[m];
        const Complex mirrored = std::conj(modes[(cells - m) & (cells - 1)]);
        const double index = static_cast<double>(m);
        const double deconvolution = scale * std::exp(index * index * grid.width);
        sums.weight[m] = deconvolution * std::conj(0.5 * (forward + mirrored));
        sums.value[m] = deconvolution * std::conj(Complex(0.0, -0.5) * (forward - mirrored));
    }
    return sums;
}

}  // namespace flightwatt::mechanical
