#pragma once

#include "mission/sampling/flight_draws.h"

#include <cstddef>
#include <vector>

namespace flightwatt::mission {

/// What drawn flights of a mission are left with.
struct LandingDistribution {
    std::vector<double> left_percent;  ///< rising; negative where the battery failed: FlightOutcome::remaining_percent
    double nominal_percent = 0.0;      ///< of the flight as stated
    double reserve_percent = 0.0;
    double sd_percent = 0.0;  ///< of left_percent; 0 where nothing differs

    /// The part of the flights that lands below the reserve.
    double below() const;
    /// Of `below`, as so many flights are drawn; 0 where nothing differs.
    double standard_error() const;
    /// How finely `below` is known: one flight of those drawn.
    double resolution() const { return 1.0 / static_cast<double>(left_percent.size()); }
    /// The state of charge that `probability` of the flights land with or above.
    double quantile_percent(double probability) const;
    /// That above the reserve: not negative just where as many keep the reserve.
    double spare_percent(double probability) const { return quantile_percent(probability) - reserve_percent; }
    double nominal_spare_percent() const { return nominal_percent - reserve_percent; }
};

inline constexpr std::size_t landing_flights = 20000;  ///< standard error of a probability of 0.95: 0.0015

/// Flies `flights` flights of the mission (sampling/flight_draws.h), with a seed of its own: the same for each call, so
/// that schedules are compared on the same flights, and independent of any --samples.
LandingDistribution draw_landings(const Mission& mission, const FlightUncertainty& uncertainty,
                                  std::size_t flights = landing_flights);

/// The same with as few flights as show on which side of `probability` (0.5 to below 1) the mission is, by four standard
/// errors. Throws std::invalid_argument for another probability.
LandingDistribution draw_landings_until_known(const Mission& mission, const FlightUncertainty& uncertainty,
                                              double probability, std::size_t max_flights = landing_flights);

}  // namespace flightwatt::mission
