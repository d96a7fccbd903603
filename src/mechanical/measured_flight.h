#pragma once

#include "flight/flight_phases.h"
#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "mechanical/flight_bins.h"
#include "mechanical/flight_progress.h"
#include "mechanical/phase_samples.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

/// The power measured over one phase, whatever is fitted of it: straight lines between the samples, as statistics and
/// fit have them.
struct PhasePower {
    std::vector<double> time_s;  ///< since the phase began: rises from 0 to the phase's duration
    std::vector<double> power_w;
    flight::PhaseStatistics statistics;
};

/// One flight as the validation needs it: what may be fitted, and the measured truth of the same phases.
struct MeasuredFlight {
    FlightSamples samples;
    flight::PerPhase<std::optional<double>> energy_wh;          ///< integral of the measured power
    flight::PerPhase<std::optional<double>> counter_energy_wh;  ///< what the on-board counter said
    std::optional<FlightProgress> flown;                        ///< only for a validation in flight
    BinnedFlight motion = {};                                   ///< as it was flown
    std::vector<FlightBin> remaining_cruise = {};               ///< of `motion`'s kind, from `flown` to the landing
    flight::PerPhase<std::optional<PhasePower>> power = {};     ///< of its complete phases
};

/// What is not fitted, and why.
struct Exclusion {
    std::string flight;
    std::optional<flight::Phase> phase;  ///< absent: the whole flight
    std::string reason;
};

/// "NAME: landing is excluded from the fit: REASON".
std::string to_string(const Exclusion& exclusion);

/// What a sortie is called in a fit: NAME, and NAME#2 from the second on.
std::string sortie_name(const std::string& flight, std::size_t sortie);

/// What a fit or a validation takes from one log: the power samples of complete phases, each on its own normalised
/// time, less those at its ends that have the power of the neighbouring phase (PhaseSamples::edge_samples), and their
/// measured energy (phase_statistics; of all samples). Their power itself is kept where the edges are known, too few
/// samples or not. Every sortie counts as a flight. Phases that are incomplete, have fewer samples than needed, or
/// begin or end in a gap longer than a quarter of them (so that their time is not known) are excluded, and reported.
struct MeasuredFlights {
    std::vector<MeasuredFlight> flights;
    std::vector<Exclusion> exclusions;
    std::vector<std::size_t> sorties;  ///< of each flight, counted from 0
};

MeasuredFlights extract_flights(const flight::FlightSeries& series, const flight::FlightPhases& phases,
                                std::size_t needed_samples);

/// The same of a flight that may be excluded as a whole.
MeasuredFlights extract_flights(const flight::LoadedFlight& loaded, std::size_t needed_samples);

/// Excludes the phases that have fewer samples, and flights of which none is left.
void exclude_short_phases(MeasuredFlights& measured, std::size_t needed_samples);

}  // namespace flightwatt::mechanical
