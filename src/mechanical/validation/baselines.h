#pragma once

#include "mechanical/fit/phase_samples.h"
#include "mechanical/level_law.h"
#include "mechanical/prediction/energy_estimate.h"

#include <cstddef>
#include <optional>
#include <span>

/// Baseline predictors for the validation: the power of a phase is a constant.
namespace flightwatt::mechanical {

/// The mean of the flights' mean powers, s^2 (1 + 1/n). `flights` must not be empty.
ConstantPower constant_mean(std::span<const PhaseSamples> flights);

/// One flight's mean power for another: 2 s^2, s that of all `flights`.
ConstantPower power_of_flight(std::span<const PhaseSamples> flights, std::size_t index);

EnergyEstimate energy_of(const ConstantPower& power, double duration_s);

/// The flight whose durations are nearest to `duration_s`: the least sum of squared log ratios over the
/// phases that both have, divided by their number. std::nullopt if none has a phase in common.
std::optional<std::size_t> nearest_flight(std::span<const FlightSamples> flights,
                                          const flight::PerPhase<std::optional<double>>& duration_s);

}  // namespace flightwatt::mechanical
