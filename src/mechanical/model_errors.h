#pragma once

#include "mechanical/model_fit.h"
#include "mechanical/uncertainty/error_analysis.h"
#include "mechanical/uncertainty/frequency_profile.h"

#include <string>

namespace flightwatt::mechanical {

/// What is known of a phase's errors beyond what the model keeps.
struct PhaseErrorReport {
    ErrorAnalysis analysis;
    FrequencyProfile profile;
};

/// Analyses every phase of a fit and puts errors and spread into its model; nothing else of it changes.
flight::PerPhase<PhaseErrorReport> add_errors(ModelFit& fit);

/// Every phase's curve with what surrounds it, as CSV: two different questions side by side. Columns: phase,
/// tau, time_s, power_w; standard_error_w, low_95_w, high_95_w: the weighted mean of these flights, given
/// their noise; flights_low_w, flights_high_w, flights_sd_w: the flights' own curves (the paper's grey band);
/// population_low_95_w, population_high_95_w: the mean of all flights like these. The last five are empty
/// where a single flight counts.
std::string curves_csv(const ModelFit& fit, const flight::PerPhase<PhaseErrorReport>& reports);

}  // namespace flightwatt::mechanical
