#pragma once

#include "mechanical/fit/phase_samples.h"
#include "mechanical/mechanical_model.h"

#include <optional>
#include <span>

namespace flightwatt::mechanical {

/// The spread of `flights` about the model's phase; std::nullopt for fewer than 2.
/// level_sd_w: sample standard deviation of the flights' mean powers. The drift is what the model's curve,
/// put at each flight's own level, leaves of the power in blocks of 30 s (a tenth of the shortest phase, if
/// that is less): their variance and the correlation of neighbours, corrected for what a flight's own level
/// took of them; the correlation lasts no longer than a phase. Where the phases' halves differ by more than
/// such a drift explains, their difference sets its size.
std::optional<LevelSpread> level_spread(const PhaseModel& model, std::span<const PhaseSamples> flights);

}  // namespace flightwatt::mechanical
