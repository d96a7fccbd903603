#pragma once

#include "mechanical/fit_records.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/phase_samples.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

struct ModelFitOptions {
    std::string name = "fitted";  ///< of the model
    PhaseFitOptions phases = {};
    Weighting weighting = Weighting::agreement;
};

/// One phase as it was fitted and averaged.
struct FittedPhase {
    PhaseModel model;
    PhaseFit fit;
    std::vector<double> weights;        ///< of fit.flights
    std::vector<PhaseSamples> samples;  ///< of fit.flights
};

/// Fits and averages one phase (Eqs. 1, 5-7) of the flights with min_samples or more, with its spread. Where the samples
/// determine no series, the phase has the mean power of all flights (PhaseModel::power, with the reason). Throws
/// NoResultError for no flights, or power that overflows.
FittedPhase fit_phase_model(flight::Phase phase, std::span<const PhaseSamples> flights,
                            const ModelFitOptions& options = {});

/// A model with its fits and samples, flight by flight, for the analysis of its errors.
struct ModelFit {
    MechanicalModel model;
    flight::PerPhase<std::vector<PhaseSamples>> samples;
    flight::PerPhase<PhaseFit> fits;                ///< flights in the order of the samples
    flight::PerPhase<std::vector<double>> weights;  ///< in that order too
};

/// The flights that have the phase, in their order, under their flights' names.
std::vector<PhaseSamples> samples_of_phase(std::span<const FlightSamples> flights, flight::Phase phase);

/// Stores each flight's frequency scan with its samples (PhaseSamples::scan), for fits to most of these flights. Phases
/// that cannot be fitted have none.
void cache_scans(std::span<FlightSamples> flights, const ModelFitOptions& options);

/// The mechanical power of a flight from several flights (Eqs. 1-7): each phase is fitted over the flights that have it
/// and averaged with their weights (fit_phase_model). A phase's rms_w is that of the samples about their own flights'
/// curves. Throws NoResultError naming a phase that no flight has, and UsageError for a flight given twice.
ModelFit fit_model(std::span<const FlightSamples> flights, const ModelFitOptions& options = {});

/// The series of the model's order and frequency which is nearest (least squares) to `power_w` at the parts `tau`
/// of the phase; std::nullopt if the frequency is too low for these to determine one.
std::optional<FourierModel> fit_series(const PhaseModel& model, std::span<const double> tau,
                                       std::span<const double> power_w);

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
