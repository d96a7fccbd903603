#pragma once

#include "flight/flight_series.h"
#include "flight/segmentation.h"
#include "mechanical/covariate.h"

namespace flightwatt::mechanical {

/// How long the cruise is watched for what is known early.
inline constexpr double early_s = 60.0;

/// What a log tells of a sortie before its cruise and early in it; absent where it was not measured.
///   height_m                   the height held above the ground, as it would have been planned
///   initial_voltage_v          median voltage with an idle motor, up to 120 s before lift-off
///   time_to_cruise_s           from lift-off to the cruise: the time since take-off when its level is set.
///   Time
///                              within the cruise is none: the curve itself is a function of it
///   wind_m_per_s, airspeed_m_per_s, ground_speed_m_per_s   means over the first early_s of the cruise
///   airspeed_cubed_m3_per_s3   mean cube of the airspeed over that time
Covariates covariates_of(const flight::FlightSeries& series, const flight::Sortie& sortie);

}  // namespace flightwatt::mechanical
