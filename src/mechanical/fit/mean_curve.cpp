#include "mechanical/fit/mean_curve.h"

#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/frequency_posterior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

namespace flightwatt::mechanical {
namespace {

/// In standard deviations of the mean curve, root mean squares over the phase.
constexpr double least_difference = 0.25;
constexpr double nearness = 0.1;

/// Curves that differ by less than this part of their size differ by rounding.
constexpr double rounding_of_curve = 1e-7;

/// How much harmonics count against nearness, largest first; the last is rounding.
constexpr std::array ridges{1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-12};

constexpr double between_points = 1e-3;  ///< of a curve's range

constexpr std::size_t most_candidates = 60;
constexpr double low_step_rad = 0.25;
constexpr double low_end_rad = 12.0;  ///< two periods: there series are alike that differ in frequency

/// The flights' curves over the phase, at the middles of equal parts of it: points x flights [W].
struct CurveGrid {
    std::vector<double> tau;
    Eigen::MatrixXd mean;
    Eigen::MatrixXd least_squares;
    Eigen::VectorXd floor_w;  ///< a flight: 0, or less if less was measured
    double sd_w = 0.0;        ///< of the mean of the flights' curves, root mean square over the phase
};

std::size_t points_of(const PhaseFit& fit, const FrequencyPosterior& posterior) {
    const double highest_rad = std::max(fit.theta_rad, posterior.nodes.back().theta_rad);
    auto curve = fit.flights.front().fourier;
    curve.omega_rad_per_s = highest_rad;
    return points_of_curve(curve, 1.0);
}

CurveGrid curve_grid(std::span<const PhaseSamples> flights, const PhaseFit& fit, const FrequencyPosterior& posterior) {
    const auto points = points_of(fit, posterior);
    const auto order = static_cast<int>(fit.flights.front().fourier.cos_w.size());
    const auto rows = static_cast<Eigen::Index>(points);
    const auto columns = static_cast<Eigen::Index>(flights.size());
    CurveGrid grid{{}, Eigen::MatrixXd::Zero(rows, columns), Eigen::MatrixXd(rows, columns), Eigen::VectorXd(columns)};
    for (std::size_t i = 0; i < points; ++i) {
        grid.tau.push_back((static_cast<double>(i) + 0.5) / static_cast<double>(points));
    }
    const auto at_found = fourier_basis(grid.tau, order, fit.theta_rad);
    for (Eigen::Index i = 0; i < columns; ++i) {
        const auto flight = static_cast<std::size_t>(i);
        grid.least_squares.col(i) = at_found * coefficients_of(fit.flights[flight].fourier);
        grid.floor_w(i) = std::min(0.0, *std::ranges::min_element(flights[flight].power_w));
    }
    double second_moment = 0.0;
    for (auto first = posterior.nodes.begin(); first != posterior.nodes.end();) {
        const auto last = std::find_if(first, posterior.nodes.end(),
                                       [&](const auto& node) { return node.theta_rad != first->theta_rad; });
        const auto basis = fourier_basis(grid.tau, order, first->theta_rad);
        const Eigen::MatrixXd gram = basis.transpose() * basis / static_cast<double>(points);
        Eigen::MatrixXd coefficients = Eigen::MatrixXd::Zero(basis.cols(), columns);
        for (; first != last; ++first) {
            for (Eigen::Index i = 0; i < columns; ++i) {
                coefficients.col(i) += first->weight * first->coefficients[static_cast<std::size_t>(i)];
            }
            const double freedom = std::max(3.0, first->degrees_of_freedom);
            second_moment += first->weight * (first->mean.dot(gram * first->mean) +
                                              freedom / (freedom - 2.0) * gram.cwiseProduct(first->scale).sum());
        }
        grid.mean += basis * coefficients;
    }
    const double square_of_mean = grid.mean.rowwise().mean().squaredNorm() / static_cast<double>(points);
    grid.sd_w = std::sqrt(std::max(0.0, second_moment - square_of_mean));
    return grid;
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
    weights.resize(std::min(weights.size(), most_candidates));
    std::vector<double> frequencies{fit.theta_rad};
    for (const auto& [weight, theta_rad] : weights) frequencies.push_back(theta_rad);
    for (double theta_rad = fit.range.low_rad; theta_rad < std::min(low_end_rad, fit.range.high_rad);
         theta_rad += low_step_rad) {
        frequencies.push_back(theta_rad);
    }
    return frequencies;
}

/// With the largest ridge that leaves a series near enough; if none does, the nearest.
NearSeries near_series(const CurveGrid& grid, const Eigen::MatrixXd& wanted, int order,
                       const std::vector<double>& frequencies) {
    NearSeries best;
    for (const double ridge : ridges) {
        best = {};
        for (const double theta_rad : frequencies) {
            auto near = nearest_at(grid, wanted, order, theta_rad, ridge);
            if (near.penalised_w2 < best.penalised_w2) best = std::move(near);
        }
        if (best.distance_w2 <= std::pow(nearness * grid.sd_w, 2)) break;
    }
    return best;
}

/// Bends a flight's curve up where it falls below its floor, with ever more weight on these places; what is left of it
/// after that is lifted.
void hold_above(const CurveGrid& grid, Eigen::Ref<Eigen::VectorXd> coefficients, double theta_rad, double floor_w) {
    constexpr int most_rounds = 12;
    const auto order = static_cast<int>(coefficients.size() - 1) / 2;
    const auto basis = fourier_basis(grid.tau, order, theta_rad);
    const Eigen::VectorXd found = basis * coefficients;
    if (found.minCoeff() >= floor_w) return;
    // A little higher, for what lies between the points.
    floor_w += between_points * (found.maxCoeff() - found.minCoeff());
    const Eigen::VectorXd wanted = found.cwiseMax(floor_w);
    Eigen::VectorXd weights = Eigen::VectorXd::Ones(basis.rows());
    for (int round = 0; round < most_rounds; ++round) {
        const Eigen::VectorXd curve = basis * coefficients;
        if (curve.minCoeff() >= floor_w) return;
        for (Eigen::Index i = 0; i < curve.size(); ++i)
            if (curve(i) < floor_w) weights(i) *= 3.0;
        Eigen::MatrixXd normal = basis.transpose() * weights.asDiagonal() * basis;
        normal.diagonal().tail(coefficients.size() - 1).array() += 1e-6 * static_cast<double>(basis.rows());
        coefficients = normal.ldlt().solve(basis.transpose() * weights.cwiseProduct(wanted));
    }
    const double lacking = floor_w - (basis * coefficients).minCoeff();
    if (lacking > 0.0) coefficients(0) += lacking;
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
    fit.range.at_bound = FrequencyBound::none;  // of a mean over frequencies none stands at a bound
    fit.rms_w = std::sqrt(square_sum / static_cast<double>(fit.samples));
}

}  // namespace

void settle_curves(std::span<const PhaseSamples> flights, PhaseFit& fit) {
    const auto order = static_cast<int>(fit.flights.front().fourier.cos_w.size());
    if (order == 0) return;
    std::vector<ScaledSamples> values;
    for (std::size_t i = 0; i < flights.size(); ++i) values.push_back(fitted_values(flights[i], fit.flights[i], fit));
    const std::vector<double> weights(flights.size(), 1.0 / static_cast<double>(flights.size()));
    const auto posterior = frequency_posterior(values, {order, fit.range, fit.theta_rad, weights});
    const auto grid = curve_grid(flights, fit, posterior);
    const Eigen::VectorXd apart = (grid.mean - grid.least_squares).rowwise().mean();
    const double difference_w = std::sqrt(apart.squaredNorm() / static_cast<double>(apart.size()));
    const double size_w = std::sqrt(grid.mean.squaredNorm() / static_cast<double>(grid.mean.size()));
    fit.mean_curve = difference_w > std::max(least_difference * grid.sd_w, rounding_of_curve * size_w);
    const Eigen::MatrixXd& curves = fit.mean_curve ? grid.mean : grid.least_squares;
    const bool negative = falls_below(curves, grid.floor_w);
    if (!fit.mean_curve && !negative) return;
    Eigen::MatrixXd wanted = curves;
    for (Eigen::Index i = 0; i < wanted.cols(); ++i) wanted.col(i) = wanted.col(i).cwiseMax(grid.floor_w(i));
    auto near = near_series(grid, wanted, order, candidates(posterior, fit));
    const auto basis = fourier_basis(grid.tau, order, near.theta_rad);
    fit.not_negative = negative || falls_below(basis * near.coefficients, grid.floor_w);
    for (Eigen::Index i = 0; i < wanted.cols(); ++i) {
        hold_above(grid, near.coefficients.col(i), near.theta_rad, grid.floor_w(i));
    }
    take_series(fit, flights, near);
}

}  // namespace flightwatt::mechanical
