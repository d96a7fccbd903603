#pragma once

#include "mission/mission.h"
#include "mission/sampling/flight_spreads.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace flightwatt::mission {

/// How many standard normal numbers make a flight.
std::size_t count_normals(const MissionSetup& mission);

/// Flight number `index`'s, of `seed` and `index` alone.
std::vector<double> draw_normals(std::size_t count, std::uint64_t seed, std::uint64_t index);

/// The mission as the flight of these numbers flies it, each of which moves one quantity by so many deviations: of each
/// phase level and duration, of the battery capacity, voltage, resistance, RC resistance and RC time constant, of each
/// component its power and that of each node, of a path the wind's speed and direction. Those that are estimated
/// together move together (docs/methods.md, Eq. 31); a level's deviation counts for the planned duration then, so that
/// a phase's energy moves by the sum of what level and duration do. Levels move a phase's whole curve; where that would
/// take it further below 0 than it was, the curve is scaled to the same mean, down to 0. The knots of an open-circuit
/// voltage move together, each by its own error. An interval has a deviation for each side; a time constant is normal
/// in its logarithm. Durations stop at a tenth of the planned and at ten times it, levels at FlightUncertainty::max_rise_w,
/// what cannot be negative at 0 (or a thousandth).
MissionSetup apply_draw(const MissionSetup& mission, const FlightUncertainty& spreads, std::span<const double> normals);

/// The same onto `flight`, a copy of the mission that may have been another flight before: copying less is faster.
void apply_draw_to(const MissionSetup& mission, const FlightUncertainty& spreads, std::span<const double> normals,
                   MissionSetup& flight);

/// Which of two missions' sources are the same, and deviate alike on the same day.
struct CommonSources {
    bool mechanical = false;
    bool battery = false;
    std::vector<std::optional<std::size_t>> components;  ///< of each of b's the one of a with its profile
};
CommonSources common_sources(const MissionSetup& a, const MissionSetup& b);

/// b's numbers of a flight of which a has the numbers `of_a`: those of what is in common, and `own` ones of the rest.
/// The wind is that of a where both have a path.
std::vector<double> correlated_normals(const MissionSetup& a, const MissionSetup& b, const CommonSources& common,
                                       std::span<const double> of_a, std::vector<double> own);

/// The flight that draw_normals makes.
MissionSetup draw_flight(const MissionSetup& mission, const FlightUncertainty& spreads, std::uint64_t seed,
                         std::uint64_t index);

}  // namespace flightwatt::mission
