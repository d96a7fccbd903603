#pragma once

#include "base/error.h"
#include "base/statistics.h"
#include "helpers/made_up_flights.h"
#include "mechanical/fit/flight_weights.h"
#include "mechanical/fit/phase_fit.h"
#include "mechanical/uncertainty/error_analysis.h"

#include <cmath>
#include <string>
#include <vector>

namespace flightwatt::test {

/// Adds noise to a recorded flight: normal, with that correlation between samples 1.1 s apart.
inline void add_noise(mechanical::PhaseSamples& samples, double noise_w, double autocorrelation, std::mt19937& random) {
    std::normal_distribution<double> normal(0.0, 1.0);
    double state = normal(random);
    for (std::size_t i = 0; i < samples.tau.size(); ++i) {
        if (i > 0) {
            const double gap_s = (samples.tau[i] - samples.tau[i - 1]) * samples.duration_s;
            const double decay = std::pow(autocorrelation, gap_s / 1.1);
            state = decay * state + std::sqrt(1.0 - decay * decay) * normal(random);
        }
        samples.power_w[i] += noise_w * state;
    }
}

/// How the flights are made whose intervals are held against the truth.
struct CoverageCase {
    double noise_w = 0.24;  ///< 20 mA at 12 V, what the real flights of 2020 have
    double autocorrelation = 0.0;
    std::size_t flights = 200;
    std::size_t together = 1;  ///< flights to a fit
    mechanical::Loss loss = mechanical::Loss::none;
    double outliers = 0.0;  ///< part of the samples that are 20 times the noise off
};

struct Coverage {
    double covered = 0.0;           ///< part of the points of the curves that lay in their intervals
    double a0_covered = 0.0;        ///< part of the intervals of a0 that held it
    double mean_error_ratio = 0.0;  ///< mean of (square error / square standard error) over the points
    std::size_t at_bound = 0;       ///< fits
    std::size_t fits = 0;
    std::size_t without_answer = 0;  ///< fits that did not converge, which say so and have no intervals
};

/// Fits flights of the published phase and asks at 41 points of each curve whether the 95 % interval holds
/// the truth.
inline Coverage coverage_of(flight::Phase phase, const CoverageCase& made, unsigned seed) {
    constexpr int points = 41;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const auto truth = published_model().phases[phase];
    Coverage coverage;
    for (std::size_t first = 0; first < made.flights; first += made.together) {
        std::vector<mechanical::PhaseSamples> flights;
        for (std::size_t i = 0; i < made.together; ++i) {
            const double duration_s = truth.duration_s * (0.92 + 0.16 * uniform(random));
            flights.push_back(record(truth, {duration_s, 1.1, 0.0, 0.15}, random, "flight" + std::to_string(i + 1)));
            add_noise(flights.back(), made.noise_w, made.autocorrelation, random);
            for (double& power : flights.back().power_w) {
                if (uniform(random) < made.outliers) power += 20.0 * made.noise_w;
            }
        }
        mechanical::PhaseFit fit;
        try {
            fit = fit_phase(phase, flights, {.loss = made.loss});
        } catch (const NoAnswerError&) {
            ++coverage.without_answer;
            continue;
        }
        const auto weights = flight_weights(fit, phase, {mechanical::Weighting::uniform, {}});
        const auto analysis = analyse_errors(flights, fit, weights);
        const auto mean = average_phase(fit, weights);
        const double half_width = student_t_half_width(analysis.errors.degrees_of_freedom);
        for (int i = 0; i < points; ++i) {
            const double tau = static_cast<double>(i) / (points - 1);
            const double error_w =
                power_w(mean.fourier, tau * mean.duration_s) - power_w(truth.fourier, tau * truth.duration_s);
            const double standard_error_w = curve_standard_error_w(analysis, tau);
            coverage.covered += std::abs(error_w) <= half_width * standard_error_w ? 1.0 : 0.0;
            coverage.mean_error_ratio += std::pow(error_w / standard_error_w, 2);
        }
        const double a0_error_w = mean.fourier.a0_w - truth.fourier.a0_w;
        coverage.a0_covered += std::abs(a0_error_w) <= half_width * analysis.errors.a0_w ? 1.0 : 0.0;
        coverage.at_bound += fit.range.at_bound != mechanical::FrequencyBound::none ? 1 : 0;
        ++coverage.fits;
    }
    const auto fits = static_cast<double>(coverage.fits);
    coverage.covered /= fits * points;
    coverage.mean_error_ratio /= fits * points;
    coverage.a0_covered /= fits;
    return coverage;
}

}  // namespace flightwatt::test
