#pragma once

#include "mechanical/fit/phase_samples.h"
#include "mechanical/prediction/energy_estimate.h"

#include <cstddef>
#include <optional>
#include <span>

namespace flightwatt::mechanical {

/// What any user would think of first, to hold the model against. A phase's power is one constant.
struct ConstantPower {
    double mean_w = 0.0;
    std::optional<double> sd_w;  ///< of a flight's mean power about it, its own error included
    double freedom = 0.0;
};

/// The mean of the flights' mean powers, s^2 (1 + 1/n). `flights` must not be empty.
ConstantPower constant_mean(std::span<const PhaseSamples> flights);

/// One flight's mean power for another: 2 s^2, s that of all `flights`.
ConstantPower power_of_flight(std::span<const PhaseSamples> flights, std::size_t index);

/// The airspeed law (AirspeedLaw) at the airspeed flown; std::nullopt if it is unknown, or the law is.
std::optional<ConstantPower> power_at_airspeed(std::span<const PhaseSamples> flights,
                                               const std::optional<double>& airspeed_cubed_m3_per_s3);

EnergyEstimate energy_of(const ConstantPower& power, double duration_s);

/// The flight whose durations are nearest to `duration_s`: the least sum of squared log ratios over the
/// phases that both have, divided by their number. std::nullopt if none has a phase in common.
std::optional<std::size_t> nearest_flight(std::span<const FlightSamples> flights,
                                          const flight::PerPhase<std::optional<double>>& duration_s);

}  // namespace flightwatt::mechanical
