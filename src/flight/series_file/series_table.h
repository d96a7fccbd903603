#pragma once

#include "base/atomic_file.h"
#include "flight/flight_series.h"

#include <cstddef>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// The rows of a series file without their heads: one for each time at which any track has a value, with a cell for
/// each track. The pieces are made on `max_threads` at most (0: on every core) and come in order.
void write_series_rows(const std::vector<Track>& tracks, const TextSink& sink, std::size_t max_threads);

}  // namespace flightwatt::flight
