// The curves of a phase whose samples leave the frequency open.

#include "base/statistics.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/frequency_likelihood.h"
#include "mechanical/fit/frequency_posterior.h"
#include "mechanical/fit/phase_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>

namespace flightwatt::mechanical {
namespace {

/// The highest harmonic turns by no more than this over the phase between frequencies that are as good as one; so fine
/// is the scan for the frequency, too.
constexpr double turn_of_one_frequency_rad = 1.0;

/// In standard deviations of the mean curve, root mean squares over the phase.
constexpr double min_difference = 0.25;
constexpr double nearness = 0.1;

/// Curves that differ by less than this part of their size differ by rounding.
constexpr double rounding_of_curve = 1e-7;

/// Negative power lasts this part of the phase, or it is noise: so long noise lasts at most (frequency_posterior.h).
constexpr double part_of_negative_power = 0.2;

/// How much harmonics count against nearness, largest first; the last is rounding.
constexpr std::array ridges{1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-12};

constexpr double between_points = 1e-3;  ///< of a curve's range

constexpr std::size_t max_candidates = 60;
constexpr double low_step_rad = 0.25;
constexpr double low_end_rad = 12.0;  ///< two periods: there series are alike that differ in frequency

/// The flights' curves over the phase, at the middles of equal parts of it: points x flights [W].
struct CurveGrid {
    std::vector<double> tau;
    Eigen::MatrixXd mean;
    Eigen::MatrixXd least_squares;
    Eigen::VectorXd floor_w;  ///< a flight
    Eigen::VectorXd min_w;    ///< of its samples
    Eigen::VectorXd max_w;
    double sd_w = 0.0;  ///< of the mean of the flights' curves, root mean square over the phase
};

/// 0, or the least mean power over a part of the phase that is below 0 by more than chance (95 %).
double min_power_w(const PhaseSamples& samples) {
    const auto sorted = sort_by_time({samples.tau, samples.power_w, samples.flight});
    constexpr std::size_t min_samples = 3;
    double min_w = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    std::size_t first = 0;
    for (std::size_t last = 0; last < sorted.tau.size(); ++last) {
        sum += sorted.value[last];
        squares += sorted.value[last] * sorted.value[last];
        // The shortest stretch that ends here and is long enough.
        while (sorted.tau[last] - sorted.tau[first + (first < last ? 1 : 0)] >= part_of_negative_power) {
            sum -= sorted.value[first];
            squares -= sorted.value[first] * sorted.value[first];
            ++first;
        }
        const std::size_t count = last - first + 1;
        if (sorted.tau[last] - sorted.tau[first] < part_of_negative_power || count < min_samples) continue;
        const auto size = static_cast<double>(count);
        const double mean_w = sum / size;
        if (mean_w >= 0.0) continue;
        const double sd_w = std::sqrt(std::max(0.0, squares / size - mean_w * mean_w) * size / (size - 1.0));
        min_w = std::min(min_w, mean_w + student_t_half_width(size - 1.0) * sd_w / std::sqrt(size));
    }
    return min_w;
}

std::size_t points_up_to(double max_rad, const PhaseFit& fit) {
    auto curve = fit.flights.front().fourier;
    curve.omega_rad_per_s = max_rad;
    return curve_point_count(curve, 1.0);
}

/// Without means: fine enough for frequencies up to `max_rad`.
CurveGrid curve_grid(std::span<const PhaseSamples> flights, const PhaseFit& fit, double max_rad) {
    const auto points = points_up_to(max_rad, fit);
    const auto order = static_cast<int>(fit.flights.front().fourier.cos_w.size());
    const auto rows = static_cast<Eigen::Index>(points);
    const auto columns = static_cast<Eigen::Index>(flights.size());
    CurveGrid grid{{},
                   Eigen::MatrixXd::Zero(rows, columns),
                   Eigen::MatrixXd(rows, columns),
                   Eigen::VectorXd(columns),
                   Eigen::VectorXd(columns),
                   Eigen::VectorXd(columns)};
    for (std::size_t i = 0; i < points; ++i) {
        grid.tau.push_back((static_cast<double>(i) + 0.5) / static_cast<double>(points));
    }
    const auto at_found = fourier_basis(grid.tau, order, fit.theta_rad);
    for (Eigen::Index i = 0; i < columns; ++i) {
        const auto flight = static_cast<std::size_t>(i);
        grid.least_squares.col(i) = at_found * coefficients_of(fit.flights[flight].fourier);
        const auto [least, most] = std::ranges::minmax(flights[flight].power_w);
        grid.min_w(i) = least;
        grid.max_w(i) = most;
        grid.floor_w(i) = min_power_w(flights[flight]);
    }
    return grid;
}

void add_mean(CurveGrid& grid, const FrequencyPosterior& posterior, int order) {
    const auto points = grid.tau.size();
    const auto columns = grid.mean.cols();
    const std::vector<double> equal(posterior.nodes.front().flights.size(), 1.0 / static_cast<double>(columns));
    const auto nodes = mean_curve_nodes(posterior, equal);
    double second_moment = 0.0;
    for (std::size_t k = 0; k < nodes.size();) {
        const double theta_rad = nodes[k].theta_rad;
        const auto basis = fourier_basis(grid.tau, order, theta_rad);
        const Eigen::MatrixXd gram = basis.transpose() * basis / static_cast<double>(points);
        Eigen::MatrixXd coefficients = Eigen::MatrixXd::Zero(basis.cols(), columns);
        for (; k < nodes.size() && nodes[k].theta_rad == theta_rad; ++k) {
            const auto& node = nodes[k];
            for (Eigen::Index i = 0; i < columns; ++i) {
                const auto& flight = posterior.nodes[k].flights[static_cast<std::size_t>(i)];
                coefficients.col(i) += node.weight * flight.coefficients;
            }
            const double freedom = std::max(3.0, node.degrees_of_freedom);
            second_moment += node.weight * (node.coefficients.dot(gram * node.coefficients) +
                                            freedom / (freedom - 2.0) * gram.cwiseProduct(node.scale).sum());
        }
        grid.mean += basis * coefficients;
    }
    const double square_of_mean = grid.mean.rowwise().mean().squaredNorm() / static_cast<double>(points);
    grid.sd_w = std::sqrt(std::max(0.0, second_moment - square_of_mean));
}

bool falls_below(const Eigen::MatrixXd& curves, const Eigen::VectorXd& floor_w) {
    return ((curves.rowwise() - floor_w.transpose()).array() < 0.0).any();
}

/// A series for each flight, with one frequency.
struct NearSeries {
    double theta_rad = 0.0;
    Eigen::MatrixXd coefficients;                                  ///< coefficients x flights
    double distance_w2 = std::numeric_limits<double>::infinity();  ///< mean square, all flights
    double penalised_w2 = std::numeric_limits<double>::infinity();
};

NearSeries nearest_at(const CurveGrid& grid, const Eigen::MatrixXd& wanted, int order, double theta_rad, double ridge) {
    const auto points = static_cast<double>(grid.tau.size());
    const auto basis = fourier_basis(grid.tau, order, theta_rad);
    Eigen::MatrixXd normal = basis.transpose() * basis / points;
    normal.diagonal().tail(normal.cols() - 1).array() += ridge;
    NearSeries near{theta_rad, normal.ldlt().solve(basis.transpose() * wanted / points)};
    const auto flights = static_cast<double>(wanted.cols());
    near.distance_w2 = (basis * near.coefficients - wanted).squaredNorm() / points / flights;
    near.penalised_w2 =
        near.distance_w2 + ridge * near.coefficients.bottomRows(normal.rows() - 1).squaredNorm() / flights;
    return near;
}

/// The frequencies with most weight, that of least squares, and low ones.
std::vector<double> candidates(const FrequencyPosterior& posterior, const PhaseFit& fit) {
    std::vector<std::pair<double, double>> weights;  // weight, frequency
    for (const auto& node : posterior.nodes) {
        if (weights.empty() || weights.back().second != node.theta_rad) weights.emplace_back(0.0, node.theta_rad);
        weights.back().first += node.weight;
    }
    std::ranges::stable_sort(weights, std::greater(), &std::pair<double, double>::first);
    weights.resize(std::min(weights.size(), max_candidates));
    std::vector<double> frequencies{fit.theta_rad};
    for (const auto& [weight, theta_rad] : weights) frequencies.push_back(theta_rad);
    double theta_rad = fit.range.low_rad;
    while (theta_rad < std::min(low_end_rad, fit.range.high_rad)) {
        frequencies.push_back(theta_rad);
        theta_rad += low_step_rad;
    }
    return frequencies;
}

/// Whether each flight's constant is a power that it may have had: constants of low frequencies may cancel each other.
bool is_plausible(const NearSeries& near, const CurveGrid& grid) {
    for (Eigen::Index i = 0; i < near.coefficients.cols(); ++i) {
        const double a0_w = near.coefficients(0, i);
        const double range_w = grid.max_w(i) - grid.min_w(i);
        if (a0_w < std::max(grid.floor_w(i), grid.min_w(i) - range_w) || a0_w > grid.max_w(i) + range_w) return false;
    }
    return true;
}

/// With the largest ridge that leaves a series near enough; if none does, the nearest. Of series with plausible
/// constants, as long as there are some.
NearSeries near_series(const CurveGrid& grid, int order, const std::vector<double>& frequencies) {
    NearSeries nearest;
    NearSeries implausible;
    for (const double ridge : ridges) {
        NearSeries best;
        for (const double theta_rad : frequencies) {
            auto near = nearest_at(grid, grid.mean, order, theta_rad, ridge);
            auto& kept = is_plausible(near, grid) ? best : implausible;
            if (near.penalised_w2 < kept.penalised_w2) kept = std::move(near);
        }
        if (best.distance_w2 < nearest.distance_w2) nearest = best;
        if (nearest.distance_w2 <= std::pow(nearness * grid.sd_w, 2)) break;
    }
    return std::isfinite(nearest.distance_w2) ? nearest : implausible;
}

/// Bends a flight's curve up where it falls below its floor, with ever more weight on these places and on the mean
/// power, which stays; what is left of it after that is taken by smaller harmonics.
void clamp_to_floor(const CurveGrid& grid, Eigen::Ref<Eigen::VectorXd> coefficients, double theta_rad, double floor_w) {
    constexpr int max_rounds = 12;
    constexpr double weight_of_mean = 1e3;
    const auto order = static_cast<int>(coefficients.size() - 1) / 2;
    const auto basis = fourier_basis(grid.tau, order, theta_rad);
    const auto points = static_cast<double>(basis.rows());
    const Eigen::VectorXd found = basis * coefficients;
    if (found.minCoeff() >= floor_w) return;
    // A little higher, for what lies between the points.
    floor_w += between_points * (found.maxCoeff() - found.minCoeff());
    const double mean_w = std::max(found.mean(), floor_w);
    const Eigen::VectorXd wanted = found.cwiseMax(floor_w);
    const Eigen::RowVectorXd mean_row = basis.colwise().mean();
    Eigen::VectorXd weights = Eigen::VectorXd::Ones(basis.rows());
    for (int round = 0; round < max_rounds && (basis * coefficients).minCoeff() < floor_w; ++round) {
        const Eigen::VectorXd curve = basis * coefficients;
        for (Eigen::Index i = 0; i < curve.size(); ++i)
            if (curve(i) < floor_w) weights(i) *= 3.0;
        const double of_mean = weight_of_mean * weights.sum();
        Eigen::MatrixXd normal = basis.transpose() * weights.asDiagonal() * basis;
        normal += of_mean * mean_row.transpose() * mean_row;
        normal.diagonal().tail(coefficients.size() - 1).array() += 1e-6 * points;
        coefficients = normal.ldlt().solve(basis.transpose() * weights.cwiseProduct(wanted) +
                                           of_mean * mean_w * mean_row.transpose());
    }
    coefficients(0) += mean_w - mean_row.dot(coefficients);
    const double min_w = (basis * coefficients).minCoeff();
    if (min_w >= floor_w) return;
    const double kept = (mean_w - floor_w) / (mean_w - min_w);
    coefficients *= kept;
    coefficients(0) += (1.0 - kept) * mean_w;
}

void clamp_to_floor(const CurveGrid& grid, NearSeries& near) {
    for (Eigen::Index i = 0; i < near.coefficients.cols(); ++i) {
        clamp_to_floor(grid, near.coefficients.col(i), near.theta_rad, grid.floor_w(i));
    }
}

/// Of the series above the floors with plausible constants the nearest to the mean; std::nullopt if there is none.
std::optional<NearSeries> near_series_above(const CurveGrid& grid, int order, const std::vector<double>& frequencies) {
    constexpr double ridge = 1e-4;
    std::optional<NearSeries> nearest;
    for (const double theta_rad : frequencies) {
        auto near = nearest_at(grid, grid.mean, order, theta_rad, ridge);
        clamp_to_floor(grid, near);
        if (!is_plausible(near, grid)) continue;
        near.distance_w2 = (fourier_basis(grid.tau, order, theta_rad) * near.coefficients - grid.mean).squaredNorm();
        if (!nearest || near.distance_w2 < nearest->distance_w2) nearest = std::move(near);
    }
    return nearest;
}

void take_series(PhaseFit& fit, std::span<const PhaseSamples> flights, const NearSeries& near) {
    fit.theta_rad = near.theta_rad;
    double square_sum = 0.0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        auto& flight = fit.flights[i];
        const Eigen::VectorXd own = near.coefficients.col(static_cast<Eigen::Index>(i));
        flight.fourier = series_of(own, near.theta_rad / flight.duration_s);
        const auto order = static_cast<int>(flight.fourier.cos_w.size());
        const Eigen::VectorXd curve = fourier_basis(flights[i].tau, order, near.theta_rad) * own;
        const double own_sum = (curve - as_vector(flights[i].power_w)).squaredNorm();
        flight.rms_w = std::sqrt(own_sum / static_cast<double>(flight.samples));
        square_sum += own_sum;
    }
    if (fit.is_frequency_averaged)
        fit.range.at_bound = FrequencyBound::none;  // no frequency of a mean stands at a bound
    fit.rms_w = std::sqrt(square_sum / static_cast<double>(fit.samples));
}

/// Whether frequencies may be at which the highest harmonic turns otherwise.
bool is_open(const FrequencyPosterior& posterior, int order, double found_rad) {
    if (is_autocorrelation_at_limit(posterior)) return false;
    const auto [low_rad, high_rad] = frequency_interval(posterior);
    const double apart_rad = std::max(high_rad, found_rad) - std::min(low_rad, found_rad);
    return order * apart_rad > turn_of_one_frequency_rad;
}

/// Whether the mean over frequencies is another curve than that of least squares.
bool is_another(const CurveGrid& grid) {
    const Eigen::VectorXd apart = (grid.mean - grid.least_squares).rowwise().mean();
    const double difference_w = std::sqrt(apart.squaredNorm() / static_cast<double>(apart.size()));
    const double size_w = std::sqrt(grid.mean.squaredNorm() / static_cast<double>(grid.mean.size()));
    return difference_w > std::max(min_difference * grid.sd_w, rounding_of_curve * size_w);
}

/// Whether no curve falls below its floor.
bool stays_above(std::span<const PhaseSamples> flights, const PhaseFit& fit) {
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const auto& fourier = fit.flights[i].fourier;
        const double duration_s = fit.flights[i].duration_s;
        const auto points = curve_point_count(fourier, duration_s);
        const double floor_w = min_power_w(flights[i]);
        for (std::size_t k = 0; k < points; ++k) {
            const double part = (static_cast<double>(k) + 0.5) / static_cast<double>(points);
            if (power_w(fourier, part * duration_s) < floor_w) return false;
        }
    }
    return true;
}

}  // namespace

void average_over_frequencies(std::span<const PhaseSamples> flights, PhaseFit& fit) {
    const auto order = static_cast<int>(fit.flights.front().fourier.cos_w.size());
    if (order == 0 || is_constant(flights)) return;
    std::vector<ScaledSamples> values;
    for (std::size_t i = 0; i < flights.size(); ++i)
        values.push_back(sort_by_time(pseudo_observations(flights[i], fit.flights[i], fit)));
    const bool is_settled = is_frequency_determined(values, order, fit.range, fit.theta_rad, fit.scan.get());
    if (is_settled && stays_above(flights, fit)) return;
    NearSeries near{fit.theta_rad, Eigen::MatrixXd(coefficient_count(order), std::ssize(flights))};
    for (Eigen::Index i = 0; i < near.coefficients.cols(); ++i) {
        near.coefficients.col(i) = coefficients_of(fit.flights[static_cast<std::size_t>(i)].fourier);
    }
    if (is_settled) {
        clamp_to_floor(curve_grid(flights, fit, fit.theta_rad), near);
        fit.is_clamped = true;
        take_series(fit, flights, near);
        return;
    }
    auto posterior = frequency_posterior(values, {order, fit.range, fit.theta_rad, fit.scan.get()});
    auto grid = curve_grid(flights, fit, std::max(fit.theta_rad, posterior.nodes.back().theta_rad));
    add_mean(grid, posterior, order);
    fit.is_frequency_averaged =
        is_open(posterior, order, fit.theta_rad) &&
        (is_another(grid) || falls_below(grid.least_squares, grid.floor_w) || !is_plausible(near, grid));
    if (fit.is_frequency_averaged) near = near_series(grid, order, candidates(posterior, fit));
    const auto basis = fourier_basis(grid.tau, order, near.theta_rad);
    fit.is_clamped = falls_below(basis * near.coefficients, grid.floor_w);
    if (fit.is_clamped) {
        const auto above =
            fit.is_frequency_averaged ? near_series_above(grid, order, candidates(posterior, fit)) : std::nullopt;
        if (above) near = *above;
        clamp_to_floor(grid, near);
    }
    if (fit.is_frequency_averaged || fit.is_clamped) take_series(fit, flights, near);
    fit.posterior = std::make_shared<const FrequencyPosterior>(std::move(posterior));
}

}  // namespace flightwatt::mechanical
