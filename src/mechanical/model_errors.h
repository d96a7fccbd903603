#pragma once

#include "mechanical/fit_records.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/model_fit.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

/// So many points the model file's spread has, from begin to end of the phase.
inline constexpr std::size_t envelope_points = 21;

/// How the flights' own curves differ about their weighted mean at `points` evenly spread parts of the phase
/// (two or more): the envelope of those with a weight, and the standard deviation of one flight
/// (docs/methods.md, Eq. 10). std::nullopt where a single flight counts. This is where a new flight's curve may
/// lie, not how well the mean is known.
std::optional<FlightEnvelope> compute_envelope(const PhaseFit& fit, std::span<const double> weights,
                                               std::size_t points = envelope_points);

/// Standard error [W] of the mean as that of all flights that might have been flown, at point i of the
/// spread: sd / sqrt(effective_flights). Its Student's t has effective_flights - 1 degrees of freedom.
double population_standard_error_w(const FlightEnvelope& spread, std::size_t i);

/// Analyses every phase of a fit and puts errors and spread into its model; nothing else of it changes.
flight::PerPhase<ErrorAnalysis> analyse_model(ModelFit& fit);

/// What is known of a model's curve over one phase, at evenly spread times.
struct CurveBand {
    std::vector<double> time_s;
    std::vector<double> low_95_w;  ///< of the weighted mean of these flights
    std::vector<double> high_95_w;
    std::vector<double> flights_low_w;  ///< envelope of the flights' own curves; empty of a single flight
    std::vector<double> flights_high_w;
};

/// The bands of a fit that was analysed, at 101 times a phase.
flight::PerPhase<CurveBand> curve_bands(const ModelFit& fit, const flight::PerPhase<ErrorAnalysis>& analyses);

/// Every phase's curve with what surrounds it, as CSV: two different questions side by side. Columns: phase, tau,
/// time_s, power_w; standard_error_w, low_95_w, high_95_w: the weighted mean of these flights, given their noise;
/// flights_low_w, flights_high_w, flights_sd_w: the flights' own curves (the paper's grey band); population_low_95_w,
/// population_high_95_w: the mean of all flights like these. The last five are empty where a single flight counts.
std::string curves_csv(const ModelFit& fit, const flight::PerPhase<ErrorAnalysis>& analyses);

}  // namespace flightwatt::mechanical
