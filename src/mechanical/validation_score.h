#pragma once

#include "mechanical/validation.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

/// How one model did over the flights, in one phase or in the whole.
struct ModelScore {
    std::size_t flights = 0;
    double mean_absolute_error_wh = 0.0;
    std::optional<double> mean_absolute_error_percent;  ///< of the measured energy; none for landing
    double bias_wh = 0.0;                               ///< mean of predicted - measured
    std::optional<double> coverage_95;  ///< part of the flights within the interval; none without intervals
};

/// The phase's score, or the whole flight's without a phase: the sum over the phases that were predicted.
/// std::nullopt if the model predicted it for none of the flights, or not for all that another predicted.
std::optional<ModelScore> score_of(std::span<const ValidatedFlight> flights, const std::string& model,
                                   std::optional<flight::Phase> phase);

/// A flight's measured and predicted energy in a phase, or in the whole; std::nullopt where it was not
/// predicted.
struct PredictedEnergy {
    double measured_wh = 0.0;
    EnergyEstimate estimate;
};
std::optional<PredictedEnergy> predicted_energy(const ValidatedFlight& flight, const std::string& model,
                                                std::optional<flight::Phase> phase);

/// The models that predicted anything, in the order in which they are shown.
std::vector<std::string> model_names(std::span<const ValidatedFlight> flights);

}  // namespace flightwatt::mechanical
