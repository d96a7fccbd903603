#pragma once

#include "mission/prepared_mission.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::mission {

/// A flight with one of several packs: take-off, the way to a part of the cruise, that part, the way home, landing.
struct PackFlight {
    std::size_t pack = 1;        ///< its number
    MissionVariant mission;      ///< an ordinary one
    double start_s = 0.0;        ///< since the first take-off
    double cruise_from_s = 0.0;  ///< of the cruise flown at once
    double cruise_to_s = 0.0;
    double largest_to_s = 0.0;             ///< from where this pack could still return with its reserve
    std::optional<double> margin_percent;  ///< above the reserve as stated, which the probability takes
    std::string return_from;  ///< element of the path and its completed part; empty: the mission's end, or no path
    std::optional<double> return_east_m;  ///< from the start of the path
    std::optional<double> return_north_m;
    SimulatedFlight flown;
};

/// A mission over several packs, one flight after the other.
struct PackFlights {
    MissionSetup setup;                 ///< of the whole mission
    std::vector<PackFlight> flights;    ///< as many as the packs suffice for
    std::optional<std::size_t> needed;  ///< packs, later ones as the mission's battery; none: no number is enough
    std::optional<double> probability = std::nullopt;  ///< with which each flight keeps the reserve; else as stated
    bool suffice = false;  ///< the whole cruise is flown, and every flight keeps the reserve
    MissionSummary total;  ///< sums, with the time on the ground; the least charge; mean utility in the air
    double on_ground_s = 0.0;
    SocCurve curve;  ///< of all flights, since the first take-off; on the ground between them without power
};

/// Divides a mission with [packs] into the fewest flights that land with the reserve, with the greatest charge that all
/// can keep above it (docs/methods.md, Several packs); plans and simulates each as the ordinary mission that it is. A
/// mission that is yet to be planned is divided by its schedule of least energy demand. With `probability`, that
/// fraction of the drawn flights of each pack keeps the reserve. Throws as prepare_mission.
PackFlights fly_packs(const MissionVariant& mission, const SimulationOptions& steps = {},
                      const std::optional<double>& probability = std::nullopt);

/// For people: packs, times, energy and charge, or what is missing.
std::string describe(const PackFlights& all);

}  // namespace flightwatt::mission
