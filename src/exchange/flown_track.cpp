#include "exchange/flown_track.h"

#include "base/error.h"
#include "flight/flight_identity.h"
#include "flight/phase_statistics.h"
#include "flight/selected_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>

#include <fmt/chrono.h>

namespace flightwatt::exchange {
namespace {

/// The report's colours of phases.
constexpr flight::PerPhase<const char*> phase_colours{{"#d98200", "#0072b2", "#009e73"}};
constexpr auto ground_colour = "#888888";
constexpr std::size_t classes_of_power = 6;
/// From dark to light (viridis of matplotlib, which is readable without colour vision too).
constexpr std::array<const char*, classes_of_power> power_colours{"#440154", "#414487", "#2a788e",
                                                                  "#22a884", "#7ad151", "#fde725"};
constexpr double half_turn_deg = 180.0;

std::optional<flight::Phase> phase_at(const flight::FlightPhases& phases, double time_s) {
    for (const auto& sortie : phases.sorties)
        for (const auto& span : sortie.phases)
            if (time_s >= span.start.time_s && time_s < span.end.time_s) return span.phase;
    return std::nullopt;
}

void set_clock(FlownTrack& track, const flight::FlightSeries& series) {
    if (series.start_clock_s && *series.start_clock_s > 0.0) {
        track.clock = TrackClock::log;
        track.start_clock_s = *series.start_clock_s;
    } else if (const auto start = flight::start_in_name(series.flight)) {
        track.clock = TrackClock::name;
        track.start_clock_s = static_cast<double>(start->time_since_epoch().count());
    }
}

/// 1, 2 or 5 times a power of ten, and no less than `step`.
double round_step(double step) {
    const double magnitude = std::pow(10.0, std::floor(std::log10(step)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * magnitude >= step) return factor * magnitude;
    return 10.0 * magnitude;
}

/// The width of a class of power.
double power_step_w(const FlownTrack& track) {
    std::vector<double> powers_w;
    for (const auto& point : track.points)
        if (point.power_w) powers_w.push_back(std::max(0.0, *point.power_w));
    if (powers_w.empty()) {
        throw InputError({track.flight}, "measured no power, by which its track could be coloured",
                         "colour it by phase");
    }
    constexpr double most = 0.95;
    const auto place = static_cast<std::ptrdiff_t>(most * static_cast<double>(powers_w.size() - 1));
    std::ranges::nth_element(powers_w, powers_w.begin() + place);
    const double high_w = powers_w[static_cast<std::size_t>(place)];
    return high_w > 0.0 ? round_step(high_w / static_cast<double>(classes_of_power)) : 1.0;
}

struct Drawn {
    std::string name;
    std::string colour;
};

Drawn drawn_by_phase(const TrackPoint& point) {
    if (!point.phase) return {"ground", ground_colour};
    return {std::string(to_string(*point.phase)), phase_colours[*point.phase]};
}

Drawn drawn_by_power(const TrackPoint& point, double step_w) {
    if (!point.power_w) return {"no power measured", ground_colour};
    const double steps = std::clamp(std::floor(*point.power_w / step_w), 0.0, double{classes_of_power - 1});
    const auto number = static_cast<std::size_t>(steps);
    const double low_w = steps * step_w;
    if (number + 1 == classes_of_power) return {fmt::format("{:g} W and more", low_w), power_colours[number]};
    return {fmt::format("{:g} to {:g} W", low_w, low_w + step_w), power_colours.at(number)};
}

bool crosses_antimeridian(const TrackPoint& from, const TrackPoint& to) {
    return std::abs(from.longitude_deg - to.longitude_deg) > half_turn_deg;
}

std::optional<double> mean_power_w(const FlownTrack& track, const TrackSegment& part) {
    std::vector<double> time_s;
    std::vector<double> power_w;
    for (std::size_t i = part.first; i <= part.last; ++i) {
        if (!track.points[i].power_w) continue;
        time_s.push_back(track.points[i].time_s);
        power_w.push_back(*track.points[i].power_w);
    }
    if (time_s.empty()) return std::nullopt;
    const double duration_s = time_s.back() - time_s.front();
    if (!(duration_s > 0.0)) return power_w.front();
    return flight::integrated(time_s, power_w, time_s.front(), time_s.back()) / duration_s;
}

}  // namespace

FlownTrack flown_track(const flight::FlightSeries& series, const flight::FlightPhases& phases) {
    const auto latitude = select_track(series, "latitude_deg");
    const auto longitude = sample_selected_track(series, "longitude_deg", latitude.time_s);
    if (latitude.time_s.size() < 2 || longitude.empty()) {
        const bool in_metres = !select_track(series, "east_m").empty();
        throw InputError({series.file},
                         in_metres ? "has positions in metres alone, from an origin that it does not tell"
                                   : "has no positions, of which a track is made",
                         "expected GPS, GPS_INT or GPS_LLA messages, or latitude_deg and longitude_deg in a series");
    }
    FlownTrack track{series.flight, flight::describe_aircraft(series.aircraft_id, series.aircraft_name), {}};
    set_clock(track, series);
    const auto altitude = sample_selected_track(series, "altitude_m", latitude.time_s);
    const auto power = sample_selected_track(series, "power_w", latitude.time_s);
    for (std::size_t i = 0; i < latitude.time_s.size(); ++i) {
        TrackPoint point{latitude.time_s[i], longitude[i], latitude.value[i]};
        if (!altitude.empty()) point.altitude_m = altitude[i];
        if (!power.empty()) point.power_w = power[i];
        point.phase = phase_at(phases, point.time_s);
        track.points.push_back(point);
    }
    return track;
}

std::string utc_text(const FlownTrack& track, double time_s) {
    constexpr long long ms_per_s = 1000;
    const auto clock_ms = std::llround((track.start_clock_s + time_s) * static_cast<double>(ms_per_s));
    const auto ms = ((clock_ms % ms_per_s) + ms_per_s) % ms_per_s;
    const auto seconds = static_cast<std::time_t>((clock_ms - ms) / ms_per_s);
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z", fmt::gmtime(seconds), ms);
}

std::vector<TrackSegment> coloured_segments(const FlownTrack& track, TrackColour colour) {
    const double step_w = colour == TrackColour::power ? power_step_w(track) : 0.0;
    std::vector<TrackSegment> parts;
    bool is_open = false;
    for (std::size_t i = 0; i + 1 < track.points.size(); ++i) {
        const auto& point = track.points[i];
        if (crosses_antimeridian(point, track.points[i + 1])) {
            is_open = false;
            continue;
        }
        const auto drawn = colour == TrackColour::phase ? drawn_by_phase(point) : drawn_by_power(point, step_w);
        if (!is_open || parts.back().name != drawn.name) parts.push_back({drawn.name, drawn.colour, i, i + 1});
        parts.back().last = i + 1;
        is_open = true;
    }
    for (auto& part : parts) part.mean_power_w = mean_power_w(track, part);
    return parts;
}

}  // namespace flightwatt::exchange
