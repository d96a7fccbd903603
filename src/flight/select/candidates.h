#pragma once

#include "flight/flight_data.h"

#include <string_view>

namespace flightwatt::flight {

/// Returns whether the track comes from a message of the log, so that its unit is known; a column of a user's CSV may
/// have any.
bool comes_from_message(const Track& track);

/// Returns the candidate without outliers.
ChosenTrack cleaned(const FlightSeries& series, const Track& candidate);

/// Returns the first candidate of a name that varies, else the first with values, without outliers. Only candidates for
/// which accept(track) is true are considered.
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

/// Returns the first candidate of a name that varies, else the first with values, without outliers.
inline ChosenTrack first_that_varies(const FlightSeries& series, std::string_view name) {
    return first_that_varies(series, name, [](const Track&) { return true; });
}

}  // namespace flightwatt::flight
