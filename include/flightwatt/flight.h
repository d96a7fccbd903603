#pragma once

#include "flightwatt/log.h"

#include <optional>
#include <string>
#include <vector>

/// Flights of a log, with the energy of their phases.
///
/// A flight (sortie) is between two rests on the ground. Its take-off ends where it first holds a height, its landing
/// begins where it leaves the height for the ground; what is between is cruise.
///
///     for (const auto& flight : flightwatt::find_flights(log))
///         for (const auto& part : flight.parts)
///             std::printf("%s %.0f s %.2f Wh\n", flightwatt::name_of(part.phase), part.end_s - part.start_s, part.energy_wh);
namespace flightwatt {

enum class Phase { takeoff, cruise, landing };

/// Returns "takeoff", "cruise" or "landing".
const char* name_of(Phase phase);

/// A phase of a flight as it was measured.
struct FlownPhase {
    Phase phase = Phase::takeoff;
    double start_s = 0.0;  ///< in the log's own seconds
    double end_s = 0.0;
    double energy_wh = 0.0;                   ///< integral of the measured power; 0 for a log without power
    double mean_power_w = 0.0;                ///< energy over duration
    std::optional<double> counter_energy_wh;  ///< by the counter on board, where it has one
    bool complete = true;                     ///< false: the log begins or ends in it
};

/// A flight from lift-off to touchdown.
struct Flight {
    std::string name;  ///< of the log, with "#2" ... for its further flights
    std::vector<FlownPhase> parts;
    double energy_wh() const;   ///< Returns the sum over the parts.
    double duration_s() const;  ///< Returns the time from the begin of the first to the end of the last part.
};

/// Returns the flights of a log in the order of time; none if it has no altitude or never flew.
std::vector<Flight> find_flights(const Log& log);

}  // namespace flightwatt
