#include "mechanical/uncertainty/residual_correlation.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::mechanical {
namespace {

constexpr double widest_neighbours = 1.5;  ///< samples further apart than so many steps are none

bool are_neighbours(const FlightResiduals& flight, std::size_t j) {
    return flight.tau[j] - flight.tau[j - 1] <= widest_neighbours * flight.step;
}

/// Half the sum of each sample's neighbours: x' (this of x) sums the products of neighbours.
Eigen::MatrixXd neighbour_sums(const FlightResiduals& flight, const Eigen::MatrixXd& rows) {
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(rows.rows(), rows.cols());
    for (Eigen::Index j = 1; j < rows.rows(); ++j) {
        if (!are_neighbours(flight, static_cast<std::size_t>(j))) continue;
        sums.row(j) += 0.5 * rows.row(j - 1);
        sums.row(j - 1) += 0.5 * rows.row(j);
    }
    return sums;
}

double pairs_of(const FlightResiduals& flight) {
    double pairs = 0.0;
    for (std::size_t j = 1; j < flight.tau.size(); ++j) pairs += are_neighbours(flight, j) ? 1.0 : 0.0;
    return pairs;
}

/// What the sum of products of neighbours over the sum of squares is expected to be for noise of that autocorrelation.
double expected_ratio(const FlightResiduals& flight, double autocorrelation) {
    const auto correlation = sample_correlation(flight.tau, flight.step, autocorrelation);
    const auto& used = flight.used_up;
    const Eigen::MatrixXd spread = correlated(correlation, used);
    const Eigen::MatrixXd neighbours = neighbour_sums(flight, used);
    double trace = 0.0;  // of L R
    for (std::size_t j = 1; j < flight.tau.size(); ++j)
        if (are_neighbours(flight, j)) trace += correlation[j];
    const Eigen::MatrixXd within = used.transpose() * spread;
    const double products = trace - 2.0 * neighbours.cwiseProduct(spread).sum() +
                            (used.transpose() * neighbours).cwiseProduct(within).sum();
    return products / (static_cast<double>(flight.tau.size()) - within.trace());
}

}  // namespace

std::vector<double> sample_correlation(std::span<const double> tau, double step, double autocorrelation) {
    std::vector<double> correlation(tau.size(), 0.0);
    for (std::size_t j = 1; j < tau.size(); ++j) {
        correlation[j] = std::pow(autocorrelation, (tau[j] - tau[j - 1]) / step);
    }
    return correlation;
}

Eigen::MatrixXd correlated(std::span<const double> correlation, const Eigen::MatrixXd& rows) {
    Eigen::MatrixXd before = rows;
    for (Eigen::Index j = 1; j < rows.rows(); ++j) {
        before.row(j) += correlation[static_cast<std::size_t>(j)] * before.row(j - 1);
    }
    Eigen::MatrixXd after = rows;
    for (Eigen::Index j = rows.rows() - 1; j > 0; --j) {
        after.row(j - 1) += correlation[static_cast<std::size_t>(j)] * after.row(j);
    }
    return before + after - rows;
}

double effective_samples(std::span<const double> correlation) {
    const auto count = static_cast<double>(correlation.size());
    double earlier = 0.0;  // the correlations of sample j with all before it
    double sum = count;
    for (const double decay : correlation) {
        earlier = decay * (1.0 + earlier);
        sum += 2.0 * earlier;
    }
    return count * count / sum;
}

double estimate_autocorrelation(std::span<const FlightResiduals> flights) {
    double found = 0.0;
    double telling_pairs = 0.0;
    std::vector<double> pairs;
    for (const auto& flight : flights) {
        pairs.push_back(pairs_of(flight));
        const double square_sum = flight.residual_w.squaredNorm();
        if (square_sum <= 0.0) continue;
        const double products = flight.residual_w.dot(neighbour_sums(flight, flight.residual_w).col(0));
        found += pairs.back() * products / square_sum;
        telling_pairs += pairs.back();
    }
    if (telling_pairs <= 0.0) return 0.0;
    const auto lacking = [&](double autocorrelation) {
        double expected = 0.0;
        for (std::size_t i = 0; i < flights.size(); ++i) {
            if (flights[i].residual_w.squaredNorm() <= 0.0) continue;
            expected += pairs[i] * expected_ratio(flights[i], autocorrelation);
        }
        return found - expected;
    };
    if (lacking(0.0) <= 0.0) return 0.0;
    double low = 0.0;
    double high = highest_autocorrelation;
    if (lacking(high) >= 0.0) return high;
    while (high - low > 1e-6) {
        const double middle = (low + high) / 2.0;
        (lacking(middle) > 0.0 ? low : high) = middle;
    }
    return (low + high) / 2.0;
}

NoiseLevel noise_level(const FlightResiduals& flight, double autocorrelation) {
    const auto count = static_cast<double>(flight.tau.size());
    const auto correlation = sample_correlation(flight.tau, flight.step, autocorrelation);
    const Eigen::MatrixXd spread = correlated(correlation, flight.used_up);
    const Eigen::MatrixXd within = flight.used_up.transpose() * spread;
    const double trace = count - within.trace();
    const auto squares = sample_correlation(flight.tau, flight.step, autocorrelation * autocorrelation);
    const double square_trace =
        count * count / effective_samples(squares) - 2.0 * spread.squaredNorm() + within.squaredNorm();
    const double degrees_of_freedom = std::max(1.0, trace * trace / std::max(square_trace, 1e-300));
    return {flight.residual_w.squaredNorm() / std::max(trace, 1e-300), degrees_of_freedom};
}

}  // namespace flightwatt::mechanical
