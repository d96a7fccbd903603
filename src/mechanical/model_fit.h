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
    std::vector<double> weights;  ///< of fit.flights
};

/// Fits and averages one phase (Eqs. 1, 5-7), with its spread. Throws what fit_phase throws.
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
/// and averaged with their weights. A phase's rms_w is that of the samples about their own flights' curves. Throws
/// NoResultError naming a phase that no flight has, or a flight with too few samples in a phase (min_samples),
/// UsageError for a flight given twice, and as fit_phase.
ModelFit fit_model(std::span<const FlightSamples> flights, const ModelFitOptions& options = {});

/// The series of the model's order and frequency which is nearest (least squares) to `power_w` at the parts `tau`
/// of the phase; std::nullopt if the frequency is too low for these to determine one.
std::optional<FourierModel> fit_series(const PhaseModel& model, std::span<const double> tau,
                                       std::span<const double> power_w);

}  // namespace flightwatt::mechanical
