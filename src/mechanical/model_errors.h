#pragma once

#include "mechanical/fit_records.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/model_fit.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

/// Number of points of the model file's envelope, from begin to end of the phase.
inline constexpr std::size_t envelope_points = 21;

/// Variability of the flights' own curves about their weighted mean at `points` evenly spread fractions of the phase
/// (two or more): the envelope of those with a weight, and the standard deviation of one flight (docs/methods.md, Eq.
/// 10). std::nullopt where a single flight counts. This is the range of a new flight's curve, not the error of the
/// mean.
std::optional<FlightEnvelope> compute_envelope(const PhaseFit& fit, std::span<const double> weights,
                                               std::size_t points = envelope_points);

/// Analyses every phase of a fit and puts errors and spread into its model; nothing else of it changes.
flight::PerPhase<ErrorAnalysis> analyse_model(ModelFit& fit);

/// 95 % interval of a model's curve over one phase, and the flights' envelope, at evenly spread times.
struct CurveBand {
    std::vector<double> time_s;
    std::vector<double> low_95_w;  ///< of the weighted mean of these flights
    std::vector<double> high_95_w;
    std::vector<double> flights_low_w;  ///< envelope of the flights' own curves; empty of a single flight
    std::vector<double> flights_high_w;
    std::vector<double> flights_sd_w = {};  ///< of one flight about the mean
};

/// The bands of a fit that was analysed, at 101 times a phase.
flight::PerPhase<CurveBand> curve_bands(const ModelFit& fit, const flight::PerPhase<ErrorAnalysis>& analyses);

/// Every phase's curve as CSV (docs/formats.md): with the interval of the weighted mean of these flights, the flights'
/// own curves (the paper's grey band), and the interval of the mean of all flights like these. The last two are empty
/// where a single flight counts.
std::string curves_csv(const ModelFit& fit, const flight::PerPhase<ErrorAnalysis>& analyses);

}  // namespace flightwatt::mechanical
