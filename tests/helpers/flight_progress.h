#pragma once

#include "flight/segment.h"
#include "flight/select.h"
#include "mechanical/flight_progress.h"

#include <cstddef>

namespace flightwatt::test {

/// The progress of a flight at a time of its log, from the log up to then alone.
inline mechanical::FlightProgress progress_at(const flight::FlightSeries& series, double until_s,
                                              std::size_t sortie = 0) {
    const auto known = select_tracks(truncate_series(series, until_s));
    const auto sorties = segment(known).sorties;
    return mechanical::progress_of(known, sortie < sorties.size() ? &sorties[sortie] : nullptr, until_s);
}

}  // namespace flightwatt::test
