#include "flight/flown_path.h"

#include "base/error.h"
#include "flight/chosen_track.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::flight {
namespace {

constexpr double place_every_s = 30.0;
constexpr double look_every_s = 0.5;  // faster than airspeed is logged

std::vector<double> times_of_places(const PhaseSpan& phase) {
    const double start_s = phase.start.time_s;
    const double duration_s = phase.end.time_s - start_s;
    const auto parts = static_cast<std::size_t>(std::max(1.0, std::round(duration_s / place_every_s)));
    std::vector<double> times_s;
    for (std::size_t i = 0; i <= parts; ++i)
        times_s.push_back(start_s + duration_s * static_cast<double>(i) / static_cast<double>(parts));
    return times_s;
}

/// A track at the times; throws where the log has none.
std::vector<double> required_at(const FlightSeries& series, const char* name, const std::vector<double>& times_s) {
    auto values = chosen_at(series, name, times_s);
    if (values.empty()) {
        throw InputError({series.file}, std::string("has no ") + name + ", which a path needs",
                         "a path as it was flown takes airspeed, altitude and position");
    }
    return values;
}

/// The root of the mean cube from one time to another.
double mean_airspeed(const Track& airspeed, double from_s, double to_s) {
    const auto looks = static_cast<std::size_t>(std::ceil((to_s - from_s) / look_every_s));
    double sum = 0.0;
    for (std::size_t k = 0; k < looks; ++k) {
        const double part = (static_cast<double>(k) + 0.5) / static_cast<double>(looks);
        sum += std::pow(std::max(0.0, value_at(airspeed, from_s + part * (to_s - from_s))), 3);
    }
    return std::cbrt(sum / static_cast<double>(looks));
}

}  // namespace

FlownPath flown_path(const FlightSeries& series, const PhaseSpan& phase) {
    const auto times_s = times_of_places(phase);
    required_at(series, "airspeed_m_per_s", {times_s.front()});
    const auto airspeed = chosen_track(series, "airspeed_m_per_s");
    const auto altitude_m = required_at(series, "altitude_m", times_s);
    FlownPath path;
    path.is_geographic = chosen_track(series, "east_m").empty() && !chosen_track(series, "latitude_deg").empty();
    const auto first = required_at(series, path.is_geographic ? "latitude_deg" : "east_m", times_s);
    const auto second = required_at(series, path.is_geographic ? "longitude_deg" : "north_m", times_s);
    for (std::size_t i = 0; i < times_s.size(); ++i) {
        FlownPlace place{first[i], second[i], altitude_m[i]};
        if (!path.is_geographic) {
            place.east_m -= first.front();
            place.north_m -= second.front();
        }
        if (i > 0) {
            place.duration_s = times_s[i] - times_s[i - 1];
            place.airspeed_m_per_s = mean_airspeed(airspeed, times_s[i - 1], times_s[i]);
        }
        path.places.push_back(place);
    }
    return path;
}

}  // namespace flightwatt::flight
