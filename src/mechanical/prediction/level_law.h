#pragma once

#include "mechanical/fit/phase_samples.h"
#include "mechanical/prediction/covariate.h"
#include "mechanical/validation/baselines.h"

#include <cstddef>
#include <optional>
#include <span>

namespace flightwatt::mechanical {

/// How a phase's mean power follows one covariate v, from several flights:
///     power = mean_power_w + slope_w (v - mean) / sd
/// For airspeed_cubed the line goes through the origin (AirspeedLaw, drag in level flight) and the spread is
/// a part of the power; for the others the line is least squares with a ridge that weighs as one more flight.
struct LevelLaw {
    Covariate covariate = Covariate::height;
    std::size_t flights = 0;
    double mean = 0.0;  ///< of the flights' covariates, in the covariate's unit; so are sd, least and most
    double sd = 0.0;
    double least = 0.0;
    double most = 0.0;
    double mean_power_w = 0.0;
    double slope_w = 0.0;                 ///< per standard deviation of the covariate
    std::optional<double> residual_sd_w;  ///< of a flight about the line, at the mean; absent for 2 flights
};

/// Of fewer, a line's spread is not known.
inline constexpr std::size_t least_flights_of_law = 3;

/// The power that a law lets expect at one value.
struct LawLevel {
    double power_w = 0.0;
    std::optional<double> sd_w;  ///< of a flight about it, the law's own error left out
    double law_variance = 0.0;   ///< of the law's own error, in sd_w^2
    double freedom = 0.0;        ///< of sd_w
    bool within_flights = true;  ///< the value is one that the flights showed
};

/// The law of `flights` (those that have the covariate); std::nullopt if fewer than 2 have it, it is the same
/// in all of them, or their power is 0.
std::optional<LevelLaw> level_law(std::span<const PhaseSamples> flights, Covariate covariate);

/// Beyond what the flights showed a line counts as at their nearest, for a line through so few flights does
/// not reach further; a law through the origin does.
LawLevel level_at(const LevelLaw& law, double value);

/// The same as one constant power, the law's own error in its spread.
ConstantPower constant_power(const LawLevel& level);

}  // namespace flightwatt::mechanical
