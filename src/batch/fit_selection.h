#pragma once

#include "batch/flight_record.h"
#include "flight/load_flight.h"
#include "mechanical/measured_flight.h"

#include <cstddef>
#include <string>

namespace flightwatt::batch {

/// Why a batch uses nothing of the flight: its power record, its folder or --exclude; empty if it does.
std::string exclusion_of(const FlightRecord& record, const flight::LoadOptions& options);

/// What a fit of a batch takes of a flight. Takes the samples out of the record: of thousands of flights they
/// are kept until the fit, once.
mechanical::MeasuredFlights select_for_fit(FlightRecord& record, std::size_t needed_samples,
                                           const flight::LoadOptions& options);

}  // namespace flightwatt::batch
