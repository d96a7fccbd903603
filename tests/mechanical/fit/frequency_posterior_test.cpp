#include "mechanical/fit/frequency_posterior.h"

#include "helpers/interval_coverage.h"
#include "mechanical/fit/frequency_likelihood.h"
#include "mechanical/fit/least_squares.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

TEST(DensityNodes, ResolveAPeakThatOneStartIsOn) {
    for (const double sd : {0.3, 0.01, 1e-5}) {
        const auto density = [&](double x) { return -0.5 * std::pow((x - 5.03) / sd, 2); };
        const auto nodes = refine_density_nodes(density, {3.0, 4.0, 5.0, 5.03, 6.0});
        EXPECT_NEAR(std::exp(log_sum_exp(log_masses(nodes))) / (sd * std::sqrt(2.0 * std::numbers::pi)), 1.0, 0.03)
            << sd;
        EXPECT_LT(nodes.size(), 120U);
    }
}

TEST(NodeLikelihood, IsThatOfTheWholeMatrices) {
    std::mt19937 random(1);
    auto samples = test::record(test::published_model().phases[flight::Phase::landing], {60.0, 1.1, 0.5, 0.3}, random);
    const ScaledSamples scaled{samples.tau, samples.power_w, ""};
    constexpr double r = 0.6;
    constexpr double theta_rad = 4.1;
    const auto flight = project_at_frequency(scaled, 3, theta_rad).value();
    const auto evidence = restricted_likelihood(flight, r);
    const auto gaps = normalised_gaps(scaled);
    const auto count = static_cast<Eigen::Index>(gaps.size());
    Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
        double apart = 0.0;
        for (Eigen::Index j = i + 1; j < count; ++j) {
            apart += gaps[static_cast<std::size_t>(j)];
            correlation(i, j) = correlation(j, i) = std::pow(r, apart);
        }
    }
    const auto basis = fourier_basis(samples.tau, 3, theta_rad);
    const Eigen::MatrixXd inverse = correlation.inverse();
    const Eigen::MatrixXd information = basis.transpose() * inverse * basis;
    const auto values = as_vector(samples.power_w);
    const Eigen::VectorXd coefficients = information.inverse() * basis.transpose() * inverse * values;
    const Eigen::VectorXd left = values - basis * coefficients;
    const double square_sum = left.dot(inverse * left);
    EXPECT_NEAR(evidence.square_sum, square_sum, 1e-8 * square_sum);
    EXPECT_LT((flight.from_orthonormal * evidence.coordinates - coefficients).norm(), 1e-6 * coefficients.norm());
    const Eigen::MatrixXd covariance =
        flight.from_orthonormal * evidence.covariance() * flight.from_orthonormal.transpose();
    EXPECT_LT((covariance - information.inverse()).norm(), 1e-6 * covariance.norm());
    const double ratio = information.determinant() / (basis.transpose() * basis).determinant();
    const double freedom = static_cast<double>(count) - 7.0;
    EXPECT_NEAR(evidence.log_likelihood,
                -0.5 * (std::log(correlation.determinant()) + std::log(ratio) + freedom * std::log(square_sum)), 1e-6);
    const auto whitened = whitened_sum(samples.power_w, gaps, r);
    EXPECT_NEAR(whitened.square_sum, values.dot(inverse * values), 1e-8 * whitened.square_sum);
    EXPECT_NEAR(whitened.log_determinant, std::log(correlation.determinant()), 1e-8);
}

FrequencyPosterior posterior_of(const std::vector<PhaseSamples>& flights, flight::Phase phase) {
    const auto fit = fit_phase(phase, flights, {.curve = CurveEstimator::least_squares});
    std::vector<ScaledSamples> scaled;
    for (const auto& samples : flights) scaled.push_back({samples.tau, samples.power_w, ""});
    return frequency_posterior(scaled, {3, fit.range, fit.theta_rad});
}

TEST(FrequencyPosterior, OfPreciseFlightsIsAtTheTruth) {
    for (const auto phase : flight::all_phases) {
        const auto posterior = posterior_of(test::record_flights(phase, 2, 0.01, 1), phase);
        double sum = 0.0;
        for (const auto& node : posterior.nodes) sum += node.weight;
        const double truth_rad = test::theta_rad(test::published_model().phases[phase]);
        const auto [low_rad, high_rad] = frequency_interval(posterior);
        EXPECT_LE(low_rad, truth_rad) << to_string(phase);
        EXPECT_GE(high_rad, truth_rad) << to_string(phase);
        EXPECT_LT(high_rad - low_rad, 0.3) << to_string(phase);
        EXPECT_NEAR(sum, 1.0, 1e-9);
    }
}

TEST(FrequencyPosterior, FindsTheAutocorrelationOfLongPhases) {
    for (const double truth : {0.0, 0.4, 0.7}) {
        auto flights = test::record_flights(flight::Phase::cruise, 2, 0.0, 2);
        std::mt19937 random(5);
        for (auto& samples : flights) test::add_noise(samples, 0.5, truth, random);
        double mean = 0.0;
        for (const auto& node : posterior_of(flights, flight::Phase::cruise).nodes) {
            mean += node.weight * node.autocorrelation;
        }
        EXPECT_NEAR(mean, truth, 0.08) << truth;
    }
}

TEST(FrequencyPosterior, DoesNotDependOnTheOrderOfTheSamples) {
    auto flights = test::record_flights(flight::Phase::landing, 1, 0.3, 3);
    const auto posterior = posterior_of(flights, flight::Phase::landing);
    std::reverse(flights[0].tau.begin(), flights[0].tau.end());
    std::reverse(flights[0].power_w.begin(), flights[0].power_w.end());
    const auto again = posterior_of(flights, flight::Phase::landing);
    ASSERT_FALSE(posterior.nodes.empty());
    EXPECT_NEAR(again.nodes.front().flights[0].coefficients(0), posterior.nodes.front().flights[0].coefficients(0),
                1e-3);
}

/// As many short flights as tell one frequency together.
std::vector<ScaledSamples> many_flights(double autocorrelation) {
    std::mt19937 random(3);
    const auto takeoff = test::published_model().phases[flight::Phase::takeoff];
    std::vector<ScaledSamples> flights;
    for (int i = 0; i < 120; ++i) {
        auto samples = test::record(takeoff, {50.0, 1.1, 0.0, 0.0}, random);
        test::add_noise(samples, 0.05, autocorrelation, random);
        flights.push_back(sort_by_time({samples.tau, samples.power_w, ""}));
    }
    return flights;
}

/// Mean and standard deviation of a density given at places.
std::pair<double, double> moments(const std::vector<double>& places, const std::vector<double>& density) {
    double sum = 0.0;
    double mean = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double before = i > 0 ? places[i] - places[i - 1] : 0.0;
        const double after = i + 1 < places.size() ? places[i + 1] - places[i] : 0.0;
        const double mass = density[i] * (before + after);
        sum += mass;
        mean += mass * places[i];
        squares += mass * places[i] * places[i];
    }
    mean /= sum;
    return {mean, std::sqrt(squares / sum - mean * mean)};
}

TEST(FrequencyPosterior, OfManyFlightsIsThatOfAFineGrid) {
    for (const double autocorrelation : {0.0, 0.4}) {
        const auto flights = many_flights(autocorrelation);
        ASSERT_GT(sample_count(flights), 5000U);
        const FrequencyRange range{3.142, 24.0};  // below half of the sampling
        const auto found = find_frequency(flights, 3, range, scan_frequencies(flights, 3, range));
        const auto posterior = frequency_posterior(flights, {3, range, found});
        ASSERT_LE(posterior.theta_rad.size(), 11U) << "not told by the normal peak";
        const auto [mean_rad, sd_rad] = moments(posterior.theta_rad, posterior.density);
        // The same by brute force, over a grid that is three times as fine and wide enough.
        std::vector<double> places;
        std::vector<double> logs;
        for (int i = -15; i <= 15; ++i) {
            places.push_back(mean_rad + i * sd_rad / 3.0);
            std::vector<FrequencyProjection> at;
            for (const auto& flight : flights) at.push_back(project_at_frequency(flight, 3, places.back()).value());
            std::vector<double> of_r;
            for (double r = 0.0; r <= 0.6; r += 0.02) {
                of_r.push_back(0.0);
                for (const auto& flight : at) of_r.back() += restricted_likelihood(flight, r).log_likelihood;
            }
            logs.push_back(log_sum_exp(of_r) - 2.0 * std::log(places.back()));
        }
        const double top = *std::ranges::max_element(logs);
        for (double& value : logs) value = std::exp(value - top);
        const auto [grid_mean_rad, grid_sd_rad] = moments(places, logs);
        EXPECT_NEAR(mean_rad, grid_mean_rad, 0.02 * grid_sd_rad);
        EXPECT_NEAR(sd_rad / grid_sd_rad, 1.0, 0.02);
        EXPECT_NEAR(mean_rad, found, 4.0 * sd_rad);
    }
}

}  // namespace
}  // namespace flightwatt::mechanical
