#pragma once

#include "flight/flight_series.h"
#include "flight/segmentation.h"
#include "mechanical/baselines.h"
#include "mechanical/phase_samples.h"

#include <optional>
#include <span>
#include <string_view>

namespace flightwatt {

/// How long the cruise is watched for what is known early.
inline constexpr double early_s = 60.0;

/// "height_m" and so on, as --covariate and the models of a validation are called.
std::string_view to_string(Covariate covariate);
std::optional<Covariate> covariate_from(std::string_view name);

/// What a log tells of a sortie before its cruise and early in it; absent where it was not measured.
///   height_m                   the height held above the ground, as it would have been planned
///   initial_voltage_v          median voltage with an idle motor, up to 120 s before lift-off
///   wind_m_per_s, airspeed_m_per_s, ground_speed_m_per_s   means over the first early_s of the cruise
///   airspeed_cubed_m3_per_s3   mean cube of the airspeed over that time
Covariates covariates_of(const FlightSeries& series, const Sortie& sortie);

/// The mean power of a cruise, foretold by one covariate from other flights (those that have it):
///   airspeed_cubed_m3_per_s3   AirspeedLaw, one constant
///   the others                 a line: least squares with a ridge that weighs as one more flight, of mean
///   power,
///                              one standard deviation of the covariate off; beyond what the flights showed
///                              the covariate counts as their nearest, for a line through so few flights
///                              does not reach further
/// The spread has n - 2 degrees of freedom: none is given for 2 flights. std::nullopt if the flight lacks the
/// covariate, fewer than 2 others have it, or it is the same in all of them.
std::optional<ConstantPower> power_by_covariate(std::span<const PhaseSamples> others,
                                                const PhaseSamples& flight, Covariate covariate);

}  // namespace flightwatt
