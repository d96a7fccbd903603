#pragma once

#include "mechanical/fit/flight_weights.h"
#include "mechanical/fit/phase_fit.h"
#include "mechanical/fit/phase_samples.h"
#include "mechanical/mechanical_model.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

struct ModelFitOptions {
    std::string name = "fitted";  ///< of the model
    PhaseFitOptions phases = {};
    WeightOptions weights = {};
    std::optional<Covariate> level_covariate = {};  ///< of the cruise: what its level is to follow
    flight::PerPhase<std::optional<int>> orders =
        {};  ///< where a phase is to have another order than phases.order

    /// The order of one phase.
    int order(flight::Phase phase) const { return orders[phase].value_or(phases.order); }
};

/// One phase as it was fitted and averaged.
struct FittedPhase {
    PhaseModel model;
    PhaseFit fit;
    std::vector<double> weights;  ///< of fit.flights
};

/// Fits and averages one phase (Eqs. 1, 5-7), with its spread and, for the cruise, its airspeed law and the
/// level law that was asked for. Throws NoAnswerError for a level covariate that fewer than 3 flights have,
/// or that does not differ between them, and what fit_phase and flight_weights throw.
FittedPhase fit_phase_model(flight::Phase phase, std::span<const PhaseSamples> flights,
                            const ModelFitOptions& options = {});

/// A model with what it was made of, flight by flight: what an analysis of its errors needs.
struct ModelFit {
    MechanicalModel model;
    flight::PerPhase<std::vector<PhaseSamples>> samples;
    flight::PerPhase<PhaseFit> fits;                ///< flights in the order of the samples
    flight::PerPhase<std::vector<double>> weights;  ///< in that order too
};

/// The flights that have the phase, in their order, under their flights' names.
std::vector<PhaseSamples> samples_of_phase(std::span<const FlightSamples> flights, flight::Phase phase);

/// The mechanical power of a flight from several flights (Eqs. 1-7): each phase is fitted over the flights
/// that have it and averaged with their weights. A phase's rms_w is that of the samples about their own
/// flights' curves. Throws NoAnswerError naming a phase that no flight has, or a flight with too few samples
/// in a phase (samples_needed tells beforehand; such a phase may be left out of the flight), UsageError for a
/// flight given twice and for weights that do not fit the flights, and what fit_phase throws.
MechanicalModel fit_mechanical_model(std::span<const FlightSamples> flights,
                                     const ModelFitOptions& options = {});
ModelFit fit_model(std::span<const FlightSamples> flights, const ModelFitOptions& options = {});

}  // namespace flightwatt::mechanical
