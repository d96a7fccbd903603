#include "mechanical/fit/frequency_posterior.h"

#include "helpers/interval_coverage.h"
#include "mechanical/fit/frequency_likelihood.h"
#include "mechanical/fit/least_squares.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

FrequencyPosterior posterior_of(const std::vector<PhaseSamples>& flights, flight::Phase phase) {
    const auto fit = fit_phase(phase, flights);
    std::vector<ScaledSamples> scaled;
    for (const auto& samples : flights) scaled.push_back({samples.tau, samples.power_w, ""});
    const std::vector weights(flights.size(), 1.0 / static_cast<double>(flights.size()));
    return frequency_posterior(scaled, weights, {3, fit.range, fit.theta_rad});
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
    EXPECT_NEAR(again.nodes.front().coefficients(0), posterior.nodes.front().coefficients(0), 1e-3);
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

/// Mean and standard deviation of the frequency.
std::pair<double, double> moments(const std::vector<std::pair<double, double>>& weighted) {
    double sum = 0.0;
    double mean = 0.0;
    double squares = 0.0;
    for (const auto& [weight, place] : weighted) {
        sum += weight;
        mean += weight * place;
        squares += weight * place * place;
    }
    mean /= sum;
    return {mean, std::sqrt(squares / sum - mean * mean)};
}

TEST(FrequencyPosterior, OfManyFlightsIsThatOfAFineGrid) {
    for (const double autocorrelation : {0.0, 0.4}) {
        const auto flights = many_flights(autocorrelation);
        const FrequencyRange range{3.142, 24.0};  // below half of the sampling
        const auto found = find_frequency(flights, 3, range, scan_frequencies(flights, 3, range));
        const std::vector weights(flights.size(), 1.0 / static_cast<double>(flights.size()));
        std::vector<std::pair<double, double>> weighted;
        for (const auto& node : frequency_posterior(flights, weights, {3, range, found}).nodes)
            weighted.emplace_back(node.weight, node.theta_rad);
        const auto [mean_rad, sd_rad] = moments(weighted);
        // The same by brute force.
        std::vector<double> logs;
        std::vector<std::pair<double, double>> grid;
        for (int i = -15; i <= 15; ++i) {
            const double theta_rad = mean_rad + i * sd_rad / 3.0;
            std::vector<FrequencyProjection> at;
            for (const auto& flight : flights) at.push_back(project_at_frequency(flight, 3, theta_rad).value());
            std::vector<double> of_r;
            for (double r = 0.0; r <= 0.6; r += 0.02) {
                of_r.push_back(0.0);
                for (const auto& flight : at) of_r.back() += restricted_likelihood(flight, r).log_likelihood;
            }
            logs.push_back(log_sum_exp(of_r) - 2.0 * std::log(theta_rad));
            grid.emplace_back(std::exp(logs.back() - logs.front()), theta_rad);
        }
        const auto [grid_mean_rad, grid_sd_rad] = moments(grid);
        EXPECT_NEAR(mean_rad, grid_mean_rad, 0.05 * grid_sd_rad);
        EXPECT_NEAR(sd_rad / grid_sd_rad, 1.0, 0.05);
        EXPECT_NEAR(mean_rad, found, 4.0 * sd_rad);
    }
}

}  // namespace
}  // namespace flightwatt::mechanical
