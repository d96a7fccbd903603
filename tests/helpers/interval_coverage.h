#pragma once

#include "base/error.h"
#include "base/statistics.h"
#include "helpers/made_up_flights.h"
#include "mechanical/fit/error_analysis.h"
#include "mechanical/fit/flight_weights.h"
#include "mechanical/fit/phase_fit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
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
};

struct Coverage {
    double covered = 0.0;          ///< part of the points of the curves that were in their intervals
    double a0_covered = 0.0;       ///< part of the intervals of a0 that held it
    double half_width_w = 0.0;     ///< of the curve's intervals: mean over the curve, median of the fits
    double a0_half_width_w = 0.0;  ///< median of the fits
    double curve_error_w = 0.0;    ///< root mean square over the curve, median of the fits
    double worst_curve_error_w = 0.0;
    std::size_t fits = 0;
    std::size_t without_answer = 0;  ///< fits that did not converge, which state so and have no intervals
};

/// Fits flights of the published phase and asks at 41 points of each curve whether the 95 % interval holds
/// the truth.
inline Coverage coverage_of(flight::Phase phase, const CoverageCase& made, unsigned seed) {
    constexpr int points = 41;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const auto truth = published_model().phases[phase];
    std::vector<double> taus;
    for (int i = 0; i < points; ++i) taus.push_back(static_cast<double>(i) / (points - 1));
    Coverage coverage;
    std::vector<double> half_widths_w;
    std::vector<double> a0_half_widths_w;
    std::vector<double> curve_errors_w;
    for (std::size_t first = 0; first < made.flights; first += made.together) {
        std::vector<mechanical::PhaseSamples> flights;
        for (std::size_t i = 0; i < made.together; ++i) {
            const double duration_s = truth.duration_s * (0.92 + 0.16 * uniform(random));
            flights.push_back(record(truth, {duration_s, 1.1, 0.0, 0.15}, random, "flight" + std::to_string(i + 1)));
            add_noise(flights.back(), made.noise_w, made.autocorrelation, random);
        }
        mechanical::PhaseFit fit;
        try {
            fit = fit_phase(phase, flights);
        } catch (const NoResultError&) {
            ++coverage.without_answer;
            continue;
        }
        const auto weights = flight_weights(fit, mechanical::Weighting::uniform);
        const auto analysis = analyse_errors(flights, fit, weights);
        const auto mean = average_phase(fit, weights);
        const double freedom = analysis.errors.degrees_of_freedom;
        double width_w = 0.0;
        double square_w2 = 0.0;
        for (const double tau : taus) {
            const double true_w = power_w(truth.fourier, tau * truth.duration_s);
            const double found_w = power_w(mean.fourier, tau * mean.duration_s);
            const auto [low_w, high_w] =
                mechanical::student_t_interval(found_w, curve_standard_error_w(analysis, tau), freedom);
            coverage.covered += low_w <= true_w && true_w <= high_w ? 1.0 : 0.0;
            width_w += (high_w - low_w) / points;
            square_w2 += std::pow(found_w - true_w, 2) / points;
        }
        const auto a0 = mechanical::student_t_interval(mean.fourier.a0_w, analysis.errors.a0_w, freedom);
        coverage.a0_covered += a0.low <= truth.fourier.a0_w && truth.fourier.a0_w <= a0.high ? 1.0 : 0.0;
        half_widths_w.push_back(width_w / 2.0);
        a0_half_widths_w.push_back((a0.high - a0.low) / 2.0);
        curve_errors_w.push_back(std::sqrt(square_w2));
        ++coverage.fits;
    }
    const auto fits = static_cast<double>(coverage.fits);
    coverage.covered /= fits * points;
    coverage.a0_covered /= fits;
    if (coverage.fits == 0) return coverage;
    coverage.worst_curve_error_w = *std::max_element(curve_errors_w.begin(), curve_errors_w.end());
    coverage.half_width_w = median(std::move(half_widths_w));
    coverage.a0_half_width_w = median(std::move(a0_half_widths_w));
    coverage.curve_error_w = median(std::move(curve_errors_w));
    return coverage;
}

/// How far the curves of single flights are from the truth, sampled every 1.1 s with 15 % lost and 1 W of noise.
struct RegularSeries {
    double worst_curve_error_w = 0.0;  ///< root mean square over a fine grid: between the samples too
    std::size_t without_answer = 0;
};

inline RegularSeries coverage_of_regular(flight::Phase phase, std::size_t fits, unsigned seed) {
    constexpr std::size_t points = 4000;
    const auto truth = published_model().phases[phase];
    const auto true_w = mechanical::curve_w(truth.fourier, truth.duration_s, points);
    RegularSeries found;
    for (std::size_t fit = 0; fit < fits; ++fit) {
        std::mt19937 random(seed + static_cast<unsigned>(fit));
        const auto samples = record(truth, {truth.duration_s, 1.1, 1.0, 0.15}, random);
        try {
            const auto curve = fit_phase(phase, std::vector{samples}).flights.front();
            const auto fitted_w = mechanical::curve_w(curve.fourier, curve.duration_s, points);
            double square_w2 = 0.0;
            for (std::size_t i = 0; i < points; ++i) square_w2 += std::pow(fitted_w[i] - true_w[i], 2) / points;
            found.worst_curve_error_w = std::max(found.worst_curve_error_w, std::sqrt(square_w2));
        } catch (const NoResultError&) {
            ++found.without_answer;
        }
    }
    return found;
}

}  // namespace flightwatt::test
