#pragma once

#include "mechanical/mechanical_model.h"
#include "mechanical/phase_samples.h"

#include <optional>
#include <span>

namespace flightwatt::mechanical {

/// Variability of `flights` about the model's phase; std::nullopt for fewer than 2. Between flights: sample standard
/// deviation of their mean powers. Drift: the residuals of the model's curve at each flight's own level, in blocks of
/// 30 s (a tenth of the shortest phase, if that is less): their variance and the correlation of neighbours, corrected
/// for the subtracted level; the correlation lasts no longer than a phase. Where the phases' halves differ by more than
/// such a drift explains, their difference determines its size.
std::optional<VarianceComponents> estimate_variance_components(const PhaseModel& model,
                                                               std::span<const PhaseSamples> flights);

/// The mean of the flights' mean powers, s^2 (1 + 1/n). `flights` must not be empty.
ConstantPower constant_mean(std::span<const PhaseSamples> flights);

}  // namespace flightwatt::mechanical
