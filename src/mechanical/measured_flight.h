#pragma once

#include "flight/flight_series.h"
#include "flight/segmentation.h"
#include "mechanical/flight_samples.h"
#include "mechanical/validation.h"

#include <vector>

namespace flightwatt::mechanical {

/// What a validation takes from one log: every sortie that select_samples selects, with the measured energy
/// (phase_statistics) of the selected phases.
struct MeasuredFlights {
    std::vector<MeasuredFlight> flights;
    std::vector<LeftOut> left_out;
    std::vector<std::size_t> sorties;  ///< of each flight, counted from 0
};

MeasuredFlights measure_flights(const flight::FlightSeries& series, const flight::FlightPhases& phases,
                                std::size_t needed_samples);

}  // namespace flightwatt::mechanical
