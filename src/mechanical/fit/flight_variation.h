#pragma once

#include "mechanical/mechanical_model.h"
#include "mechanical/phase_samples.h"

#include <cstddef>
#include <optional>
#include <span>

/// How the flights of one phase differ.
namespace flightwatt::mechanical {

/// The spread of `flights` about the model's phase; std::nullopt for fewer than 2. level_sd_w: sample standard
/// deviation of the flights' mean powers. The drift is what the model's curve, put at each flight's own level, leaves
/// of the power in blocks of 30 s (a tenth of the shortest phase, if that is less): their variance and the correlation
/// of neighbours, corrected for what a flight's own level took of them; the correlation lasts no longer than a phase.
/// Where the phases' halves differ by more than such a drift explains, their difference sets its size.
std::optional<VarianceComponents> estimate_variance_components(const PhaseModel& model,
                                                               std::span<const PhaseSamples> flights);

/// The mean of the flights' mean powers, s^2 (1 + 1/n). `flights` must not be empty.
ConstantPower constant_mean(std::span<const PhaseSamples> flights);

/// One flight's mean power for another: 2 s^2, s that of all `flights`.
ConstantPower single_flight_power(std::span<const PhaseSamples> flights, std::size_t index);

/// Among the flights that have the phase, counted from 0, the one whose durations are nearest to those of
/// `other`: the least sum of squared log ratios over the phases that both have, divided by their number.
/// std::nullopt if none has a phase in common.
std::optional<std::size_t> nearest_flight(std::span<const FlightSamples> flights, flight::Phase phase,
                                          const FlightSamples& other);

}  // namespace flightwatt::mechanical
