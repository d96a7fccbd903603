#include "flight/cut_series.h"

#include "flight/series_file.h"

#include <algorithm>

namespace flightwatt::flight {
namespace {

std::size_t count_until(const std::vector<double>& time_s, double until_s) {
    return static_cast<std::size_t>(std::upper_bound(time_s.begin(), time_s.end(), until_s) - time_s.begin());
}

void cut_track(Track& track, double until_s) {
    const auto count = count_until(track.time_s, until_s);
    track.time_s.resize(count);
    track.value.resize(count);
}

}  // namespace

FlightSeries cut_series(const FlightSeries& series, double until_s) {
    FlightSeries cut = series;
    const auto count = count_until(series.time_s, until_s);
    cut.time_s.resize(count);
    for (const auto& channel : series_channels()) {
        auto& values = cut.*channel.values;
        if (!values.empty()) values.resize(count);
    }
    for (auto* track : {&cut.altitude_track, &cut.ground_speed_track, &cut.airspeed_track,
                        &cut.witnesses.mode, &cut.witnesses.block}) {
        cut_track(*track, until_s);
    }
    std::erase_if(cut.witnesses.takeoff_s, [&](double time_s) { return time_s > until_s; });
    return cut;
}

}  // namespace flightwatt::flight
