#pragma once

#include "flight/load_flight.h"
#include "mechanical/validation.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

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
