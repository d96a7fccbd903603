#pragma once

#include "flight/flight_phases.h"
#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "mechanical/flight_bins.h"
#include "mechanical/flight_progress.h"
#include "mechanical/phase_samples.h"

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

/// The power measured over one phase: straight lines between all its samples.
struct PhasePower {
    std::vector<double> time_s;  ///< since the phase began: rises from 0 to the phase's duration
    std::vector<double> power_w;
    flight::PhaseStatistics statistics;
};

/// One flight for fit and validation: its samples, and the measured energy of the same phases.
struct MeasuredFlight {
    FlightSamples samples;
    bool only_hovers = false;                                   ///< a VTOL that is never on its wing
    flight::PerPhase<std::optional<double>> energy_wh;          ///< integral of the measured power
    flight::PerPhase<std::optional<double>> counter_energy_wh;  ///< by the on-board counter
    std::optional<FlightProgress> flown;                        ///< only for a validation in flight
    BinnedFlight motion = {};                                   ///< as it was flown
    std::vector<FlightBin> remaining = {};                      ///< of `motion`'s kind, from `flown` on
    flight::PerPhase<std::optional<PhasePower>> power = {};     ///< of its complete phases
};

/// A flight or phase that is not fitted, and why.
struct Exclusion {
    std::string flight;
    std::optional<flight::Phase> phase;  ///< absent: the whole flight
    std::string reason;
};

/// "NAME: landing is excluded from the fit: REASON".
std::string to_string(const Exclusion& exclusion);

/// The name of a sortie: NAME, and NAME#2 from the second on.
std::string sortie_name(const std::string& flight, std::size_t sortie);

/// Returns whether a name is that of a sortie of the flight.
bool is_sortie_of(const std::string& sortie, const std::string& flight);

/// The voltage that 1 % of the log's samples exceed: single samples may be damaged.
std::optional<double> pack_voltage_v(const flight::FlightData& data);

/// The flights of one log, a sortie each: power samples of complete phases on their own normalised time, without those
/// at the ends that have the neighbouring phase's power (PhaseSamples::edge_samples), and the measured energy of all
/// samples. Excluded are phases that are incomplete, have no sample, or begin or end in a gap longer than a
/// quarter of them; their power is included where the edges are known.
struct MeasuredFlights {
    std::vector<MeasuredFlight> flights;
    std::vector<Exclusion> exclusions;
    std::vector<std::size_t> sorties;  ///< of each flight, counted from 0
};

MeasuredFlights extract_flights(const flight::FlightData& data, const flight::FlightPhases& phases);

/// The same of a flight that may be excluded as a whole.
MeasuredFlights extract_flights(const flight::LoadedFlight& loaded);

/// Returns the reason why a VTOL's flight that only hovers is not fitted with flights on the wing.
std::string hover_reason();

/// Removes the flights of a VTOL that only hover from those of an aircraft, unless all do: a mean of hover and wing
/// flight predicts neither. Flights of logs named in `keep` stay. Returns the removed ones with the reason.
std::vector<Exclusion> exclude_hover(std::vector<MeasuredFlight>& flights, const std::set<std::string>& keep = {});

}  // namespace flightwatt::mechanical
