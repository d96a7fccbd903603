#pragma once

#include "mission/sampling/flight_draws.h"
#include "mission/sampling/student.h"

namespace flightwatt::mission {

/// What the flights of a mission are left with, at one probability.
struct LandingQuantile {
    double left_percent = 0.0;    ///< so much or more; negative where that many fail: see Landing
    double margin_percent = 0.0;  ///< what the flight as stated is left with above that
    double sd_percent = 0.0;      ///< of the flights, to first order: see FailureProbability
};

/// How many flights of a mission land with less than its reserve.
struct FailureProbability {
    double below = 0.0;
    double standard_error = 0.0;  ///< of `below`, as it is computed
    double resolution = 0.0;      ///< of `below`: one flight of those drawn; 0 by lines
    double sd_percent = 0.0;      ///< the flights' unit of Student's t, to first order
    double degrees_of_freedom = infinite_dof;
    double stated_spare_percent = 0.0;  ///< what the flight as stated keeps above the reserve

    /// What flights keep above the reserve with `probability`, if they go by Student's t; not negative just where as
    /// many keep the reserve.
    double spare_percent(double probability) const;
};

/// The chance that flights of `mission`, drawn as flight_of says, land with less than its reserve, by line sampling
/// (docs/methods.md, Eq. 34): no Gaussian is fitted, and what is not linear is flown. Exact to a tenth of the standard
/// error of 20,000 flights; where flights fail at once, as at a cut-off, to what it takes to know on which side of 1 -
/// `probability` it is, or to what 512 lines or 20,000 flights tell: see `standard_error`. Where lines tell less than
/// flights drawn at random, it is by such flights. Flights are drawn independently of any --samples. Throws
/// std::invalid_argument for a probability not from 0.5 to below 1.
FailureProbability failure_probability(const Mission& mission, const FlightUncertainty& spreads, double probability);

/// The same from few lines, 64 or 128: on which side of 1 - `probability` it is, but for missions near that or whose
/// flights seldom fail. For a search whose answer failure_probability then checks.
FailureProbability approximate_failure_probability(const Mission& mission, const FlightUncertainty& spreads,
                                                   double probability);

/// The state of charge that the same flights land with or above with `probability`, by the same lines. Throws as
/// failure_probability does.
LandingQuantile landing_quantile(const Mission& mission, const FlightUncertainty& spreads, double probability);

}  // namespace flightwatt::mission
