#include "mechanical/fit/trigonometric_sums.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <boost/math/quadrature/gauss.hpp>
#include <unsupported/Eigen/FFT>

namespace flightwatt::mechanical {
namespace {

using Complex = std::complex<double>;

/// Points of the grid that a sample is spread over: one a digit on a grid twice as fine as the highest frequency needs.
constexpr int kernel_points = 14;
constexpr double kernel_beta = 2.30 * kernel_points;
constexpr std::size_t oversampling = 2;

/// Fewer sums are quicker one by one.
constexpr std::size_t min_transformed = 64;

/// The kernel at -1 <= z <= 1.
double kernel_at(double z) { return std::exp(kernel_beta * (std::sqrt(std::max(0.0, 1.0 - z * z)) - 1.0)); }

TrigonometricSums sums_one_by_one(const PhaseSamples& samples, double step_rad, std::size_t count) {
    TrigonometricSums sums{std::vector<Complex>(count), std::vector<Complex>(count)};
    for (std::size_t i = 0; i < samples.tau.size(); ++i) {
        const auto step = std::polar(1.0, step_rad * samples.tau[i]);
        Complex turned = 1.0;
        for (std::size_t m = 0; m < count; ++m) {
            sums.weight[m] += turned;
            sums.value[m] += samples.power_w[i] * turned;
            turned = {turned.real() * step.real() - turned.imag() * step.imag(),
                      turned.real() * step.imag() + turned.imag() * step.real()};
        }
    }
    return sums;
}

/// The integral of the kernel times cos(m step z) for m = 0 .. count - 1.
std::vector<double> kernel_transform(double step_rad, std::size_t count) {
    using Quadrature = boost::math::quadrature::gauss<double, 30>;
    std::vector<double> transform(count);
    for (std::size_t node = 0; node < Quadrature::abscissa().size(); ++node) {
        for (const double sign : {-1.0, 1.0}) {
            const double z = (1.0 + sign * Quadrature::abscissa()[node]) / 2.0;  // both halves of the kernel are equal
            const double weight = Quadrature::weights()[node] * kernel_at(z);
            const auto step = std::polar(1.0, step_rad * z);
            Complex turned = weight;
            for (auto& value : transform) {
                value += turned.real();
                turned = {turned.real() * step.real() - turned.imag() * step.imag(),
                          turned.real() * step.imag() + turned.imag() * step.real()};
            }
        }
    }
    return transform;
}

/// The grid over a turn, and what a transform of it has to be divided by.
class SpreadingGrid {
  public:
    explicit SpreadingGrid(std::size_t count)
        : points_(std::bit_ceil(oversampling * std::max<std::size_t>(count, kernel_points))),
          spacing_rad_(2.0 * std::numbers::pi / static_cast<double>(points_)),
          middle_(count / 2),
          transform_(kernel_transform(half_width_rad(), count - middle_ + 1)) {
        fourier_.SetFlag(Eigen::FFT<double>::Unscaled);
    }

    /// Sums for m = 0 .. count - 1.
    TrigonometricSums sums(const PhaseSamples& samples, double step_rad, std::size_t count) {
        std::vector<Complex> weight(points_);
        std::vector<Complex> value(points_);
        for (std::size_t i = 0; i < samples.tau.size(); ++i)
            spread(step_rad * samples.tau[i], samples.power_w[i], weight, value);
        return {transformed(weight, count), transformed(value, count)};
    }

  private:
    double half_width_rad() const { return 0.5 * kernel_points * spacing_rad_; }

    /// The frequencies are counted from their middle, where the kernel's transform is largest.
    void spread(double angle_rad, double power_w, std::vector<Complex>& weight, std::vector<Complex>& value) const {
        const auto shifted = std::polar(1.0, static_cast<double>(middle_) * angle_rad);
        const double at = angle_rad / spacing_rad_;
        const auto first = static_cast<long>(std::ceil(at - 0.5 * kernel_points));
        for (long point = first; point < first + kernel_points; ++point) {
            const auto index = static_cast<std::size_t>(point + static_cast<long>(points_)) % points_;
            const auto part = shifted * kernel_at((static_cast<double>(point) - at) / (0.5 * kernel_points));
            weight[index] += part;
            value[index] += power_w * part;
        }
    }

    std::vector<Complex> transformed(const std::vector<Complex>& grid, std::size_t count) {
        std::vector<Complex> all(points_);
        fourier_.inv(all.data(), grid.data(), static_cast<Eigen::Index>(points_));
        std::vector<Complex> sums(count);
        for (std::size_t m = 0; m < count; ++m) {
            const auto distance = m > middle_ ? m - middle_ : middle_ - m;
            const auto index = (m + points_ - middle_) % points_;
            sums[m] = all[index] * (spacing_rad_ / (half_width_rad() * transform_[distance]));
        }
        return sums;
    }

    std::size_t points_;
    double spacing_rad_;
    std::size_t middle_;
    std::vector<double> transform_;  ///< of the kernel
    Eigen::FFT<double> fourier_;
};

}  // namespace

TrigonometricSums trigonometric_sums(const PhaseSamples& samples, double step_rad, std::size_t count) {
    if (count < min_transformed) return sums_one_by_one(samples, step_rad, count);
    return SpreadingGrid(count).sums(samples, step_rad, count);
}

}  // namespace flightwatt::mechanical
