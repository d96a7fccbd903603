#include "flight/select/candidates.h"

#include "flight/select/outliers.h"
#include "flight/select/power.h"

#include <cmath>

namespace flightwatt::flight {

bool comes_from_message(const Track& track) { return std::isfinite(track.since_s); }

ChosenTrack cleaned(const FlightSeries& series, const Track& candidate) {
    const bool is_current = candidate.name == "current_a";
    auto choice = remove_outliers(candidate, {}, is_current ? dropout_throttle(series, candidate) : Track{});
    // Contradictions within a message are noted with its power.
    if (candidate.name == "voltage_v" || is_current) erase_times(choice, contradicted_times(series, candidate.source));
    return choice;
}

}  // namespace flightwatt::flight
