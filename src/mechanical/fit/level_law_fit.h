#pragma once

#include "mechanical/fit/phase_samples.h"
#include "mechanical/level_law.h"

#include <optional>
#include <span>

namespace flightwatt::mechanical {

/// The law of `flights` (those that have the covariate), each counting the same; std::nullopt if fewer than 2
/// have it, it is the same in all of them, or, for airspeed_cubed, their power is 0 on average. For
/// airspeed_cubed the flights' values are means over the whole phase, not over its beginning.
std::optional<LevelLaw> fit_level_law(std::span<const PhaseSamples> flights, Covariate covariate);

/// The constant power that the law of `others` lets expect of a flight with `value`; std::nullopt if the
/// value is unknown, or the law is. For 2 others a line has no spread.
std::optional<ConstantPower> power_by_covariate(std::span<const PhaseSamples> others, Covariate covariate,
                                                const std::optional<double>& value);

}  // namespace flightwatt::mechanical
