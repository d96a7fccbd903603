#pragma once

#include "mechanical/fit/phase_samples.h"
#include "mechanical/mechanical_model.h"

#include <optional>
#include <span>

namespace flightwatt::mechanical {

/// A stationary deviation with exponential correlation (Ornstein-Uhlenbeck):
/// covariance(t, t + lag) = sd^2 exp(-lag / correlation_s) (docs/methods.md, Eqs. 17 and 18).
struct DriftProcess {
    double sd_w = 0.0;
    double correlation_s = 1.0;
};

/// Variance [W^2] of the mean over `duration_s` (docs/methods.md, Eq. 17).
double variance_of_mean_w2(const DriftProcess& drift, double duration_s);

/// Covariance [W^2] of the means over two durations, the second of which follows the first.
double covariance_of_means_w2(const DriftProcess& drift, double first_s, double second_s);

/// The spread of `flights` about the model's phase; std::nullopt for fewer than 2. level_sd_w: sample standard
/// deviation of the flights' mean powers. The drift is what the model's curve, put at each flight's own level, leaves
/// of the power in blocks of 30 s (a tenth of the shortest phase, if that is less): their variance and the correlation
/// of neighbours, corrected for what a flight's own level took of them; the correlation lasts no longer than a phase.
/// Where the phases' halves differ by more than such a drift explains, their difference sets its size.
std::optional<VarianceComponents> estimate_variance_components(const PhaseModel& model,
                                                               std::span<const PhaseSamples> flights);

}  // namespace flightwatt::mechanical
