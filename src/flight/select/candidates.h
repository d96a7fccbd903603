#pragma once

#include "flight/flight_data.h"

#include <string_view>

namespace flightwatt::flight {

/// Whether a message of the log has the track, whose unit is then known; a column of a user's CSV may have any.
bool comes_from_message(const Track& track);

/// The candidate without outliers.
ChosenTrack cleaned(const FlightSeries& series, const Track& candidate);

/// The first candidate of that name that varies, else the first with values; without outliers. `accept`: nullptr, or
/// which candidates count.
template <typename Accept>
ChosenTrack first_that_varies(const FlightSeries& series, std::string_view name, const Accept& accept) {
    ChosenTrack constant;
    for (const auto& track : series.tracks) {
        if (track.name != name || track.empty() || !track.device.empty() || !accept(track)) continue;
        if (is_constant(track) && !constant.empty()) continue;
        auto found = cleaned(series, track);
        found.notes.insert(found.notes.begin(), constant.notes.begin(), constant.notes.end());
        if (!is_constant(found)) return found;
        if (found.empty()) {
            constant.notes = std::move(found.notes);
        } else if (constant.empty()) {
            constant = std::move(found);
        }
    }
    return constant;
}

inline ChosenTrack first_that_varies(const FlightSeries& series, std::string_view name) {
    return first_that_varies(series, name, [](const Track&) { return true; });
}

}  // namespace flightwatt::flight
