#pragma once

#include "flight/flight_series.h"
#include "telemetry/telemetry_log.h"

#include <vector>

namespace flightwatt::flight {

/// Every candidate of every track that the sender's messages tell, in the order of track_names() and of
/// preference. `definitions_assumed`: there was no .log.
std::vector<Track> logged_tracks(const telemetry::SenderLog& sender, bool definitions_assumed);

}  // namespace flightwatt::flight
