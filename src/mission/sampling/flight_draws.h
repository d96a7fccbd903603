#pragma once

#include "mission/mission.h"

#include <cstdint>
#include <string>
#include <vector>

namespace flightwatt::mission {

/// How the flights of a mission differ, from what the mission states and else from what its models know.
struct FlightSpreads {
    PerPhase<double> level_sd_w;  ///< of a phase's mean mechanical power
    PerPhase<double> duration_sd_s;
    std::vector<std::string> drawn;      ///< what is drawn, and what that rests on
    std::vector<std::string> not_drawn;  ///< what is taken as it is, for want of a spread
};

/// Levels: as level_deviation. Durations: duration_sd_s, or what the model's flights show, with the same factor and in
/// proportion to the mission's duration. Computing: compute_sd_percent, or the standard errors of the profile's nodes.
/// Battery: capacity_sd_percent, and the 95 % intervals of its file.
FlightSpreads find_spreads(const MissionSetup& mission);

/// The mission as flight number `index` flies it: all normal, independent of each other, and of `seed` and `index`
/// alone. Levels move a phase's whole curve; a component's nodes move together, unless they have standard errors of
/// their own, as the knots of an open-circuit voltage do; an interval has a deviation for each side; a time constant is
/// normal in its logarithm. Durations stop at a tenth of the planned, what cannot be negative at 0 (or a thousandth).
MissionSetup draw_flight(const MissionSetup& mission, const FlightSpreads& spreads, std::uint64_t seed,
                         std::uint64_t index);

}  // namespace flightwatt::mission
