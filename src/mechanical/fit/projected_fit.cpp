#include "mechanical/fit/projected_fit.h"

#include "mechanical/fit/fourier_basis.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace flightwatt::mechanical {
namespace {

/// A pivot below this part of its diagonal is rounding: the sums are good to 11 digits.
constexpr double smallest_pivot = 1e-9;

constexpr std::size_t max_columns = 2 * mechanical::max_order + 1;

/// The inner product of two columns of the basis: column 0 is cos(0), 2n - 1 is cos(n .), 2n is sin(n .).
double inner_product(const TrigonometricSums& sums, std::size_t stride, std::size_t a, std::size_t b) {
    const std::size_t n = (std::max(a, b) + 1) / 2;
    const std::size_t k = (std::min(a, b) + 1) / 2;
    const auto& sum = sums.weight[(n + k) * stride];
    const auto& difference = sums.weight[(n - k) * stride];
    const bool a_is_sine = a > 0 && a % 2 == 0;
    const bool b_is_sine = b > 0 && b % 2 == 0;
    if (a_is_sine && b_is_sine) return (difference.real() - sum.real()) / 2.0;
    if (!a_is_sine && !b_is_sine) return (difference.real() + sum.real()) / 2.0;
    const bool sine_is_higher = (a_is_sine ? a : b) == std::max(a, b);
    return (sum.imag() + (sine_is_higher ? difference.imag() : -difference.imag())) / 2.0;
}

double square_sum(std::span<const double> values) {
    double sum = 0.0;
    for (const double value : values) sum += value * value;
    return sum;
}

}  // namespace

double explained_square_sum(const TrigonometricSums& sums, std::size_t stride, int order) {
    const auto columns = 2 * static_cast<std::size_t>(order) + 1;
    // L D L^T of the Gram matrix, row by row, with the right-hand side carried along: the sum explained is
    // sum z_j^2 / d_j with L z = rhs.
    std::array<std::array<double, max_columns>, max_columns> lower;
    std::array<double, max_columns> inverse_pivot{};
    std::array<double, max_columns> z{};
    double explained = 0.0;
    for (std::size_t row = 0; row < columns; ++row) {
        auto& scaled = lower[row];  // L_row,k d_k until its turn
        for (std::size_t column = 0; column < row; ++column) {
            double entry = inner_product(sums, stride, row, column);
            for (std::size_t k = 0; k < column; ++k) entry -= scaled[k] * lower[column][k];
            scaled[column] = entry;
        }
        const double diagonal = inner_product(sums, stride, row, row);
        const auto& rhs = sums.value[(row + 1) / 2 * stride];
        double pivot = diagonal;
        z[row] = row > 0 && row % 2 == 0 ? rhs.imag() : rhs.real();
        for (std::size_t k = 0; k < row; ++k) {
            const double factor = scaled[k] * inverse_pivot[k];
            pivot -= scaled[k] * factor;
            z[row] -= factor * z[k];
            scaled[k] = factor;
        }
        inverse_pivot[row] = pivot > smallest_pivot * diagonal ? 1.0 / pivot : 0.0;
        explained += z[row] * z[row] * inverse_pivot[row];
    }
    return explained;
}

double projected_square_sum(std::span<const ScaledSamples> flights, int order, double theta_rad) {
    double sum = 0.0;
    for (const auto& flight : flights) {
        const auto sums = sum_directly(flight, theta_rad, 2 * static_cast<std::size_t>(order) + 1);
        sum += std::max(0.0, square_sum(flight.value) - explained_square_sum(sums, 1, order));
    }
    return sum;
}

}  // namespace flightwatt::mechanical
