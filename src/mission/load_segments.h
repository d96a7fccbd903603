#pragma once

#include "mission/mission.h"

#include <optional>
#include <vector>

namespace flightwatt::mission {

/// What a mission demands from one jump of power to the next: smooth mechanical power and constant computing.
struct Demand {
    flight::Phase phase = flight::Phase::takeoff;
    double phase_begins_s = 0.0;  ///< times are those of the mission
    double from_s = 0.0;
    double to_s = 0.0;
    std::optional<mechanical::FourierModel> mechanical;  ///< in the phase's own time
    double compute_w = 0.0;
    double soc_drop_percent = 0.0;  ///< [points] that the battery loses at once as this begins
};

/// The demands of a mission, in order and without gaps: each begins exactly where the one before ends.
std::vector<Demand> demands_of(const Mission& mission);

double mechanical_w(const Demand& demand, double time_s);
double power_w(const Demand& demand, double time_s);

/// Energies [J] demanded up to `time_s`, a time within the demand.
double mechanical_energy_j(const Demand& demand, double time_s);
double compute_energy_j(const Demand& demand, double time_s);

}  // namespace flightwatt::mission
