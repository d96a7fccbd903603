#include "flight/flown_path.h"

#include "base/error.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double interval_s = 30.0;
constexpr double track_every_s = 1.0;
constexpr double airspeed_step_s = 0.5;  // shorter than airspeed intervals of logs

constexpr double tolerance_m = 3.0;  // about the error of satellite navigation

/// Edges of intervals of about 30 s.
std::vector<double> interval_edges(const PhaseSpan& phase) {
    const double start_s = phase.start.time_s;
    const double duration_s = phase.end.time_s - start_s;
    const auto parts = static_cast<std::size_t>(std::max(1.0, std::round(duration_s / interval_s)));
    std::vector<double> times_s(parts + 1);
    for (std::size_t i = 0; i <= parts; ++i)
        times_s[i] = start_s + duration_s * static_cast<double>(i) / static_cast<double>(parts);
    return times_s;
}

/// A track at the times; throws InputError if the log has none.
std::vector<double> required_at(const FlightData& data, const Track& track, const char* name,
                                const std::vector<double>& times_s) {
    if (!track.empty()) return resample(track, times_s);
    throw InputError({data.file}, fmt::format("has no {}", name), "a flown path needs airspeed, altitude and position");
}

/// Cube root of the mean cube between two times.
double mean_airspeed(const Track& airspeed, double from_s, double to_s) {
    const auto steps = static_cast<std::size_t>(std::ceil((to_s - from_s) / airspeed_step_s));
    double sum = 0.0;
    for (std::size_t k = 0; k < steps; ++k) {
        const double fraction = (static_cast<double>(k) + 0.5) / static_cast<double>(steps);
        sum += std::pow(std::max(0.0, value_at(airspeed, from_s + fraction * (to_s - from_s))), 3);
    }
    return std::cbrt(sum / static_cast<double>(steps));
}

/// The ground track at times, in both coordinates.
struct GroundTrack {
    std::vector<double> time_s;
    std::vector<double> first;  ///< east_m or latitude_deg
    std::vector<double> second;
    double metres_per_first = 1.0;
    double metres_per_second = 1.0;
};

/// Distance of a point of the track from the straight line between two others.
double distance_from_line_m(const GroundTrack& track, std::size_t from, std::size_t to, std::size_t at) {
    const auto x = [&](std::size_t i) { return (track.first[i] - track.first[from]) * track.metres_per_first; };
    const auto y = [&](std::size_t i) { return (track.second[i] - track.second[from]) * track.metres_per_second; };
    const double length2 = x(to) * x(to) + y(to) * y(to);
    const double part = length2 > 0.0 ? std::clamp((x(at) * x(to) + y(at) * y(to)) / length2, 0.0, 1.0) : 0.0;
    return std::hypot(x(at) - part * x(to), y(at) - part * y(to));
}

/// The straight way between two points of the track.
double length_m(const GroundTrack& track, std::size_t from, std::size_t to) {
    return std::hypot((track.first[to] - track.first[from]) * track.metres_per_first,
                      (track.second[to] - track.second[from]) * track.metres_per_second);
}

/// The points between two that straight lines need to stay within tolerance_m of the track (Douglas and Peucker 1973),
/// appended in order.
void add_bends(const GroundTrack& track, std::size_t from, std::size_t to, std::vector<std::size_t>& bends) {
    std::size_t farthest = from;
    double max_m = tolerance_m;
    for (std::size_t i = from + 1; i < to; ++i) {
        const double distance_m = distance_from_line_m(track, from, to, i);
        if (!(distance_m > max_m)) continue;
        max_m = distance_m;
        farthest = i;
    }
    if (farthest == from) return;
    add_bends(track, from, farthest, bends);
    bends.push_back(farthest);
    add_bends(track, farthest, to, bends);
}

/// The track at about every second, including both ends.
GroundTrack ground_track(const FlightData& data, bool is_geographic, double from_s, double to_s) {
    GroundTrack track;
    const auto steps = static_cast<std::size_t>(std::max(1.0, std::round((to_s - from_s) / track_every_s)));
    track.time_s.resize(steps + 1);
    for (std::size_t i = 0; i <= steps; ++i)
        track.time_s[i] = from_s + (to_s - from_s) * static_cast<double>(i) / static_cast<double>(steps);
    track.first = is_geographic ? required_at(data, data.latitude_deg, "latitude_deg", track.time_s)
                                : required_at(data, data.east_m, "east_m", track.time_s);
    track.second = is_geographic ? required_at(data, data.longitude_deg, "longitude_deg", track.time_s)
                                 : required_at(data, data.north_m, "north_m", track.time_s);
    if (is_geographic) {
        track.metres_per_first = units::metre_per_degree;  // affects only the tolerance
        track.metres_per_second = units::metre_per_degree * std::cos(track.first.front() / units::degree_per_rad);
    }
    return track;
}

}  // namespace

FlownPath flown_path(const FlightData& data, const PhaseSpan& phase) {
    const auto edges_s = interval_edges(phase);
    if (!data.is_rotorcraft()) required_at(data, data.airspeed_m_per_s, "airspeed_m_per_s", {edges_s.front()});
    const auto altitude_m = required_at(data, data.altitude_m, "altitude_m", edges_s);
    FlownPath path;
    path.is_geographic = data.east_m.empty() && !data.latitude_deg.empty();
    for (std::size_t part = 0; part + 1 < edges_s.size(); ++part) {
        const double start_s = edges_s[part];
        const double duration_s = edges_s[part + 1] - start_s;
        const auto track = ground_track(data, path.is_geographic, start_s, edges_s[part + 1]);
        if (part == 0) path.waypoints.push_back({track.first.front(), track.second.front(), altitude_m.front()});
        const double climb_m_per_s = (altitude_m[part + 1] - altitude_m[part]) / duration_s;
        const double airspeed =
            data.is_rotorcraft() ? 0.0 : mean_airspeed(data.airspeed_m_per_s, start_s, edges_s[part + 1]);
        std::vector<std::size_t> chosen;
        add_bends(track, 0, track.time_s.size() - 1, chosen);
        chosen.push_back(track.time_s.size() - 1);
        std::size_t before = 0;
        for (const auto i : chosen) {
            const double done = (track.time_s[i] - start_s) / duration_s;
            const double way_s = track.time_s[i] - track.time_s[before];
            const double over_ground = std::hypot(length_m(track, before, i) / way_s, climb_m_per_s);
            path.waypoints.push_back({track.first[i], track.second[i],
                                      std::lerp(altitude_m[part], altitude_m[part + 1], done), way_s,
                                      data.is_rotorcraft() ? over_ground : airspeed});
            before = i;
        }
    }
    if (path.is_geographic) return path;
    const auto origin = path.waypoints.front();
    for (auto& point : path.waypoints) {
        point.east_m -= origin.east_m;
        point.north_m -= origin.north_m;
    }
    return path;
}

}  // namespace flightwatt::flight
