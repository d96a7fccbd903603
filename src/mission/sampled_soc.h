#pragma once

#include "battery/battery.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace flightwatt::mission {

/// State of charge at one part of the mission, over the flights.
struct SocBand {
    double time_s = 0.0;  ///< of the mission as planned
    double p05_percent = 0.0;
    double p50_percent = 0.0;
    double p95_percent = 0.0;
};

inline constexpr std::array<int, 5> shown_quantiles_percent{5, 25, 50, 75, 95};

/// How flights that were drawn end. Flights that run empty, are cut off or ask for more than the battery can
/// deliver have the state of charge of that moment, and land below the reserve whatever that is, also if it
/// is 0.
struct SampledFlights {
    std::string mission;
    std::size_t samples = 0;
    std::uint64_t seed = 0;
    double reserve_soc_percent = 0.0;
    double final_soc_mean_percent = 0.0;
    double final_soc_sd_percent = 0.0;
    std::array<double, shown_quantiles_percent.size()> final_soc_quantiles_percent{};
    double probability_depleted = 0.0;                      ///< empty before the end
    double probability_battery_failure = 0.0;               ///< that, or cut off, or beyond the power limit
    double probability_below_reserve = 0.0;                 ///< the share of the flights
    double probability_below_reserve_standard_error = 0.0;  ///< sqrt(p (1 - p) / samples)
    battery::Interval probability_below_reserve_95;         ///< Wilson's score interval (1927)
    std::vector<std::string> drawn;
    std::vector<std::string> not_drawn;
    std::vector<SocBand> bands;
};

}  // namespace flightwatt::mission
