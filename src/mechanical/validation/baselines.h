#pragma once

#include "mechanical/covariate_regression.h"
#include "mechanical/fit/phase_samples.h"
#include "mechanical/prediction.h"

#include <optional>
#include <span>

/// Baseline predictors for the validation: the power of a phase is a constant.
namespace flightwatt::mechanical {

/// The mean of the flights' mean powers, s^2 (1 + 1/n). `flights` must not be empty.
ConstantPower constant_mean(std::span<const PhaseSamples> flights);

/// One flight's mean power for another: 2 s^2, s that of all `flights`.
ConstantPower single_flight_power(std::span<const PhaseSamples> flights, std::size_t index);

/// The constant power that the law of `flights` lets expect of another with `value`; std::nullopt if the value
/// is unknown, or the law is. For 2 flights a line has no spread.
std::optional<ConstantPower> power_by_covariate(std::span<const PhaseSamples> flights, Covariate covariate,
                                                const std::optional<double>& value);

EnergyEstimate energy_of(const ConstantPower& power, double duration_s);

/// Among the flights that have the phase, counted from 0, the one whose durations are nearest to those of
/// `other`: the least sum of squared log ratios over the phases that both have, divided by their number.
/// std::nullopt if none has a phase in common.
std::optional<std::size_t> nearest_flight(std::span<const FlightSamples> flights, flight::Phase phase,
                                          const FlightSamples& other);

}  // namespace flightwatt::mechanical
