#pragma once

#include "flight/load_flight.h"
#include "mechanical/flight_samples.h"
#include "mechanical/validation.h"

#include <vector>

namespace flightwatt::mechanical {

/// What a validation takes from one log: every sortie that select_samples selects, with the measured energy
/// (phase_statistics) of the selected phases.
struct MeasuredFlights {
    std::vector<MeasuredFlight> flights;
    std::vector<Exclusion> exclusions;
    std::vector<std::size_t> sorties;  ///< of each flight, counted from 0
};

MeasuredFlights measure_flights(const flight::FlightSeries& series, const flight::FlightPhases& phases,
                                std::size_t needed_samples);

/// The same of a flight that may be excluded as a whole.
MeasuredFlights measure_flights(const flight::LoadedFlight& loaded, std::size_t needed_samples);

/// Excludes the phases that have fewer samples, and flights of which none is left.
void exclude_short_phases(MeasuredFlights& measured, std::size_t needed_samples);

}  // namespace flightwatt::mechanical
