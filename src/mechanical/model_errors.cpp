#include "base/csv.h"
#include "base/statistics.h"
#include "mechanical/fit/phase_fit.h"
#include "mechanical/model_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace flightwatt::mechanical {
namespace {

/// `points` fractions of a phase, from 0 to 1.
std::vector<double> even_fractions(std::size_t points) {
    std::vector<double> fractions(points);
    for (std::size_t i = 0; i < points; ++i) fractions[i] = static_cast<double>(i) / static_cast<double>(points - 1);
    return fractions;
}

/// The bands of one phase at `points` fractions of it.
CurveBand band_of(const ModelFit& fit, flight::Phase phase, const ErrorAnalysis& analysis, std::size_t points) {
    const auto& model = fit.model.phases[phase];
    CurveBand band;
    for (const double tau : even_fractions(points)) {
        band.time_s.push_back(tau * model.duration_s);
        const auto [low, high] =
            student_t_interval(power_w(model.fourier, band.time_s.back()), curve_standard_error_w(analysis, tau),
                               analysis.errors.degrees_of_freedom);
        band.low_95_w.push_back(low);
        band.high_95_w.push_back(high);
    }
    if (auto spread = compute_envelope(fit.fits[phase], fit.weights[phase], points)) {
        band.flights_low_w = std::move(spread->low_w);
        band.flights_high_w = std::move(spread->high_w);
        band.flights_sd_w = std::move(spread->standard_deviation_w);
    }
    return band;
}

}  // namespace

std::optional<FlightEnvelope> compute_envelope(const PhaseFit& fit, std::span<const double> weights,
                                               std::size_t points) {
    const double squares = std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0);
    if (weights.size() < 2) return std::nullopt;
    FlightEnvelope spread;
    spread.effective_flights = 1.0 / squares;
    for (const double tau : even_fractions(points)) {
        std::vector<double> powers;
        for (const auto& flight : fit.flights) powers.push_back(power_w(flight.fourier, tau * flight.duration_s));
        const double mean = std::inner_product(weights.begin(), weights.end(), powers.begin(), 0.0);
        double square_sum = 0.0;
        for (std::size_t k = 0; k < powers.size(); ++k) square_sum += weights[k] * std::pow(powers[k] - mean, 2);
        const auto [low, high] = std::ranges::minmax(powers);
        spread.low_w.push_back(low);
        spread.high_w.push_back(high);
        spread.standard_deviation_w.push_back(std::sqrt(square_sum / (1.0 - squares)));
    }
    return spread;
}

flight::PerPhase<ErrorAnalysis> analyse_model(ModelFit& fit) {
    flight::PerPhase<ErrorAnalysis> analyses;
    for (const auto phase : flight::all_phases) {
        analyses[phase] = analyse_errors(fit.samples[phase], fit.fits[phase], fit.weights[phase]);
        const auto& [theta_rad, range, flights, rms_w, samples, r, freedom, rivals, clamped] = fit.fits[phase];
        const auto size = coefficient_count(static_cast<int>(flights.front().fourier.cos_w.size()));
        if (samples > flights.size() * static_cast<std::size_t>(size))  // else they determine no residual
            fit.model.phases[phase].errors = analyses[phase].errors;
        fit.model.phases[phase].spread = compute_envelope(fit.fits[phase], fit.weights[phase]);
    }
    return analyses;
}

flight::PerPhase<CurveBand> curve_bands(const ModelFit& fit, const flight::PerPhase<ErrorAnalysis>& analyses) {
    constexpr std::size_t points = 101;
    flight::PerPhase<CurveBand> bands;
    for (const auto phase : flight::all_phases) bands[phase] = band_of(fit, phase, analyses[phase], points);
    return bands;
}

std::string curves_csv(const ModelFit& fit, const flight::PerPhase<ErrorAnalysis>& analyses) {
    constexpr int digits = 6;
    CsvWriter csv({"phase", "tau", "time_s", "power_w", "standard_error_w", "low_95_w", "high_95_w", "flights_low_w",
                   "flights_high_w", "flights_sd_w", "population_low_95_w", "population_high_95_w"},
                  digits);
    for (const auto phase : flight::all_phases) {
        const auto& model = fit.model.phases[phase];
        const auto band =
            band_of(fit, phase, analyses[phase], curve_point_count(model.fourier, model.duration_s) / 5 + 1);
        const double half_width = student_t_half_width(analyses[phase].errors.degrees_of_freedom);
        const auto& weights = fit.weights[phase];
        const double flights = 1.0 / std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0);
        for (std::size_t i = 0; i < band.time_s.size(); ++i) {
            const double power = power_w(model.fourier, band.time_s[i]);
            const auto of_flights = [&](const std::vector<double>& values) {
                return values.empty() ? std::nullopt : std::optional(values[i]);
            };
            std::optional<Interval> population;  // the mean of all flights like these, of which these are a sample
            if (const auto sd_w = of_flights(band.flights_sd_w))
                population = student_t_interval(power, *sd_w / std::sqrt(flights), flights - 1.0);
            csv.add(to_string(phase), band.time_s[i] / model.duration_s, band.time_s[i], power,
                    (band.high_95_w[i] - power) / half_width, band.low_95_w[i], band.high_95_w[i],
                    of_flights(band.flights_low_w), of_flights(band.flights_high_w), of_flights(band.flights_sd_w),
                    population ? std::optional(population->low) : std::nullopt,
                    population ? std::optional(population->high) : std::nullopt);
        }
    }
    return csv.text();
}

}  // namespace flightwatt::mechanical
