#pragma once

#include "flight/select.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

/// Selected tracks by name, for tests of what is selected.
namespace flightwatt::flight {

inline Track select_track(const FlightSeries& series, std::string_view name) {
    return select_tracks(series).*std::ranges::find(track_members(), name, &TrackMember::name)->track;
}

inline Track power_track(const FlightSeries& series) { return select_tracks(series).power_w; }

inline std::vector<double> sample_selected_track(const FlightSeries& series, std::string_view name,
                                                 const std::vector<double>& time_s) {
    return resample(select_track(series, name), time_s);
}

inline std::vector<std::string> warnings_of(const FlightSeries& series) {
    return texts_of(selection_diagnostics(select_tracks(series)));
}

}  // namespace flightwatt::flight
