#include "live/state/flight_clock.h"

#include "flight/segmentation.h"

#include <algorithm>

namespace flightwatt::live {
namespace {

constexpr double rest_kept_s = 300.0;    // before a lift-off: longer than any rest that is looked at
constexpr double ground_kept_s = 600.0;  // on the ground

/// Whether what looks like a touchdown is no touch-and-go, which climbs a little before the segmentation calls it one.
bool has_stayed(const flight::Track& altitude_m, double touchdown_s, double now_s) {
    constexpr double beyond_doubt_s = 60.0;
    const flight::SegmentationOptions rest;
    if (now_s - touchdown_s < rest.rest_s) return false;
    if (now_s - touchdown_s >= beyond_doubt_s) return true;
    const auto& times_s = altitude_m.time_s;
    const auto from = std::ranges::lower_bound(times_s, now_s - rest.rest_s) - times_s.begin();
    const auto last = std::ranges::upper_bound(times_s, now_s) - times_s.begin();
    if (from >= last) return false;
    const auto [least, most] = std::minmax_element(altitude_m.value.begin() + from, altitude_m.value.begin() + last);
    return *most - *least <= rest.rest_height_m;
}

}  // namespace

void update_flight_times(const flight::Sortie& sortie, const flight::Track& altitude_m, double now_s, bool is_over,
                         LiveState& state) {
    using flight::Phase;
    const auto& first = sortie.phases.front();
    const auto& last = sortie.phases.back();
    state.began_in_air = first.phase != Phase::takeoff || !first.complete;
    state.landed =
        last.phase == Phase::landing && last.complete && (is_over || has_stayed(altitude_m, last.end.time_s, now_s));
    if (!state.began_in_air) state.lift_off_s = first.start.time_s;
    state.flight_time_s = (state.landed ? sortie.end_s() : now_s) - sortie.start_s();
    if (state.landed) return;
    state.phase = last.phase;
    state.phase_time_s = now_s - last.start.time_s;
    const double hold_s = flight::SegmentationOptions{}.hold_s;
    const bool climbs = last.phase == Phase::cruise && first.phase == Phase::takeoff && state.phase_time_s < hold_s;
    if (!climbs) return;
    state.phase = Phase::takeoff;
    state.phase_time_s = now_s - first.start.time_s;
}

double retention_start_s(const flight::FlightPhases& phases, const LiveState& state) {
    if (state.phase) return phases.sorties.back().start_s() - rest_kept_s;
    double from_s = state.time_s - ground_kept_s;
    for (const auto& sortie : phases.sorties)
        if (sortie.end_s() >= from_s) from_s = std::min(from_s, sortie.start_s() - rest_kept_s);
    return from_s;
}

std::string without_flight_name(const std::string& text, const std::string& flight) {
    const auto prefix = flight + ": ";
    return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

}  // namespace flightwatt::live
