#pragma once

#include "mission/sampling/landing_distribution.h"

#include <cstddef>
#include <vector>

namespace flightwatt::mission {

/// Draws the flights of variations of one mission as draw_landings_until_known() does, many times faster: most flights
/// are estimated, and those near the reserve or the quantile simulated. below() and quantile_percent(probability) are
/// exact; other flights, and the standard deviation, are estimates.
class LandingSearch {
  public:
    explicit LandingSearch(double probability) : probability_(probability) {}

    LandingDistribution landings(const Mission& mission, const FlightUncertainty& uncertainty);

  private:
    void estimate_until(std::size_t flights, const MissionSetup& mission, const FlightDraw& draw, double moved_percent);

    double probability_;
    // Estimates of a variation are used again for those that land with about the same charge.
    std::vector<double> estimated_percent_;  ///< by number of the flight; not a number: it may fail before it is empty
    double error_percent_ = 0.0;
    double of_stated_percent_ = 0.0;  ///< landing of that variation as stated
};

}  // namespace flightwatt::mission
