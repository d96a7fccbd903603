#pragma once

#include "mission/sampling/flight_draws.h"

namespace flightwatt::mission {

/// What the flights of a mission are left with, at one probability.
struct LandingQuantile {
    double left_percent = 0.0;    ///< so much or more; negative where that many fail: see Landing
    double margin_percent = 0.0;  ///< what the flight as stated is left with above that
    double sd_percent = 0.0;      ///< of the flights, to first order
};

/// The state of charge that flights of `mission`, drawn as flight_of says, land with or above with `probability`, by
/// line sampling (docs/methods.md, Eq. 34): no Gaussian is fitted, and what is not linear is flown. The probability of
/// that state of charge is met within a tenth of the standard error that 20,000 flights have. Flights are drawn
/// independently of any --samples. Throws std::invalid_argument for a probability not from 0.5 to below 1.
LandingQuantile landing_quantile(const Mission& mission, const FlightSpreads& spreads, double probability);

}  // namespace flightwatt::mission
