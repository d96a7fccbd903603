#include "mechanical/model_errors.h"

#include "base/csv.h"
#include "base/statistics.h"
#include "mechanical/fit/error_analysis.h"

#include <algorithm>
#include <array>
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

CurveBand band_of(const PhaseModel& model, const ErrorAnalysis& analysis, const std::vector<double>& taus) {
    CurveBand band;
    for (const double tau : taus) {
        band.time_s.push_back(tau * model.duration_s);
        const auto [low, high] =
            student_t_interval(power_w(model.fourier, band.time_s.back()), curve_standard_error_w(analysis, tau),
                               analysis.errors.degrees_of_freedom);
        band.low_95_w.push_back(low);
        band.high_95_w.push_back(high);
    }
    return band;
}

void add_curve(CsvWriter& csv, const ModelFit& fit, flight::Phase phase, const ErrorAnalysis& analysis) {
    const auto& model = fit.model.phases[phase];
    const auto points = curve_point_count(model.fourier, model.duration_s) / 5 + 1;
    const auto spread = compute_envelope(fit.fits[phase], fit.weights[phase], points);
    const auto taus = even_fractions(points);
    const auto band = band_of(model, analysis, taus);
    const double half_width = student_t_half_width(analysis.errors.degrees_of_freedom);
    for (std::size_t i = 0; i < points; ++i) {
        const double power = power_w(model.fourier, band.time_s[i]);
        const double error = (band.high_95_w[i] - power) / half_width;
        std::array<std::optional<double>, 5> of_flights;
        if (spread) {
            // The mean of all flights like these, of which these are a sample.
            const double flights = spread->effective_flights;
            const double sd_w = spread->standard_deviation_w[i];
            const auto population = student_t_interval(power, sd_w / std::sqrt(flights), flights - 1.0);
            of_flights = {spread->low_w[i], spread->high_w[i], sd_w, population.low, population.high};
        }
        csv.add(to_string(phase), taus[i], band.time_s[i], power, error, band.low_95_w[i], band.high_95_w[i],
                of_flights[0], of_flights[1], of_flights[2], of_flights[3], of_flights[4]);
    }
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
        fit.model.phases[phase].errors = analyses[phase].errors;
        fit.model.phases[phase].spread = compute_envelope(fit.fits[phase], fit.weights[phase]);
    }
    return analyses;
}

flight::PerPhase<CurveBand> curve_bands(const ModelFit& fit, const flight::PerPhase<ErrorAnalysis>& analyses) {
    constexpr std::size_t points = 101;
    flight::PerPhase<CurveBand> bands;
    for (const auto phase : flight::all_phases) {
        auto& band = bands[phase];
        band = band_of(fit.model.phases[phase], analyses[phase], even_fractions(points));
        if (const auto spread = compute_envelope(fit.fits[phase], fit.weights[phase], points)) {
            band.flights_low_w = spread->low_w;
            band.flights_high_w = spread->high_w;
        }
    }
    return bands;
}

std::string curves_csv(const ModelFit& fit, const flight::PerPhase<ErrorAnalysis>& analyses) {
    constexpr int digits = 6;
    CsvWriter csv({"phase", "tau", "time_s", "power_w", "standard_error_w", "low_95_w", "high_95_w", "flights_low_w",
                   "flights_high_w", "flights_sd_w", "population_low_95_w", "population_high_95_w"},
                  digits);
    for (const auto phase : flight::all_phases) add_curve(csv, fit, phase, analyses[phase]);
    return csv.text();
}

}  // namespace flightwatt::mechanical
