#pragma once

#include "mechanical/physical/flight_bins.h"
#include "mechanical/physical_model.h"

#include <span>

namespace flightwatt::mechanical {

/// The mean power of what is still to fly, where its motion is known.
struct PosteriorPower {
    double mean_w = 0.0;          ///< not below 0
    double model_w = 0.0;         ///< what the model says without regard to this flight
    double level = 0.0;           ///< this flight's own level as it was learned: a part of the power
    double parameter_sd_w = 0.0;  ///< of level and coefficients, and
    double parameter_degrees_of_freedom = 1.0;
    double drift_sd_w = 0.0;  ///< of what will drift
    double drift_degrees_of_freedom = 1.0;
};

/// What was flown moves level and coefficients as far as they are uncertain (Bayes' rule for normal errors), and the
/// last drift dies away (docs/methods.md, Power from airspeed and climb). `ahead`: means of the terms over the next
/// `remaining_s` seconds, more than 0. The model has a level spread; bins of `flown` lie before `now_s`, on one clock.
PosteriorPower predict_posterior_power(const PhysicalModel& model, std::span<const FlightBin> flown, double now_s,
                                       const TermValues& ahead, double remaining_s);

}  // namespace flightwatt::mechanical
