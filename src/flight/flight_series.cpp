#include "flight/flight_series.h"

#include <algorithm>

namespace flightwatt::flight {
namespace {

Track cut_track(const Track& track, double until_s) {
    const auto end = std::upper_bound(track.time_s.begin(), track.time_s.end(), until_s);
    const auto count = end - track.time_s.begin();
    return {track.name,
            track.source,
            track.device,
            track.since_s,
            {track.time_s.begin(), end},
            {track.value.begin(), track.value.begin() + count}};
}

void cut_skipped(std::vector<telemetry::SkippedLines>& skipped, double until_s) {
    for (auto& skip : skipped) {
        std::erase_if(skip.lines, [&](const auto& at) { return at.time_s > until_s; });
    }
    std::erase_if(skipped, [](const auto& skip) { return skip.lines.empty(); });
    std::sort(skipped.begin(), skipped.end(),
              [](const auto& a, const auto& b) { return a.first_line() < b.first_line(); });
}

}  // namespace

const std::vector<std::string>& track_names() {
    static const std::vector<std::string> names{"altitude_m",
                                                "throttle_percent",
                                                "voltage_v",
                                                "current_a",
                                                "power_w",
                                                "charge_ah",
                                                "energy_wh",
                                                "east_m",
                                                "north_m",
                                                "ground_speed_m_per_s",
                                                "airspeed_m_per_s",
                                                "wind_speed_m_per_s",
                                                "wind_east_m_per_s",
                                                "wind_north_m_per_s",
                                                "latitude_deg",
                                                "longitude_deg",
                                                "heading_deg",
                                                "course_deg",
                                                "climb_m_per_s",
                                                "roll_deg",
                                                "mode",
                                                "block",
                                                "takeoff",
                                                "ground_altitude_m"};
    return names;
}

void replace_track(FlightSeries& series, Track track) {
    const auto is_same = [&](const Track& other) { return other.name == track.name; };
    const auto at = std::find_if(series.tracks.begin(), series.tracks.end(), is_same) - series.tracks.begin();
    std::erase_if(series.tracks, is_same);
    series.tracks.insert(series.tracks.begin() + at, std::move(track));
}

FlightSeries cut_series(const FlightSeries& series, double until_s) {
    FlightSeries cut = series;
    cut.tracks.clear();
    for (const auto& track : series.tracks) {
        if (track.since_s <= until_s) cut.tracks.push_back(cut_track(track, until_s));
    }
    std::erase_if(cut.assumed_definitions,
                  [&](const auto& definition) { return definition.since_s > until_s; });
    cut_skipped(cut.skipped, until_s);
    if (cut.clock_restart && cut.clock_restart->known_s > until_s) cut.clock_restart.reset();
    return cut;
}

}  // namespace flightwatt::flight
