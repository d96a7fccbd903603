#pragma once

#include "batch/flight_record.h"
#include "mechanical/flight_samples.h"

#include <cstddef>
#include <set>
#include <string>

namespace flightwatt::batch {

/// A series that was read back from its CSV has no airspeed any more; the record has what a fit takes of it.
void restore_airspeed(const FlightRecord& record, mechanical::FlightSamples& flight);

/// What a batch fits of a flight: nothing if its power record is absurd or its folder is not to be fitted,
/// unless `keep` names it. The samples hold no more memory than they need: of thousands of flights they are
/// kept until the fit.
mechanical::FlightSelection select_for_fit(const flight::FlightSeries& series,
                                           const flight::FlightPhases& phases, const FlightRecord& record,
                                           std::size_t needed_samples, const std::set<std::string>& keep);

}  // namespace flightwatt::batch
