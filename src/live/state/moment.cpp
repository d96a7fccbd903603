#include "live/state/moment.h"

#include "base/error.h"
#include "base/units.h"
#include "flight/phase_statistics.h"
#include "flight/segmentation.h"
#include "flight/selected_track.h"
#include "mechanical/flight_bins.h"
#include "mechanical/flight_progress.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

constexpr double rest_kept_s = 300.0;    // before a lift-off: longer than any rest that is evaluated
constexpr double ground_kept_s = 600.0;  // on the ground

/// Whether the height after a touchdown is constant; a touch-and-go climbs before the segmentation detects it.
bool has_stayed(const flight::Track& altitude_m, double touchdown_s, double now_s) {
    constexpr double certain_s = 60.0;
    const flight::SegmentationOptions rest;
    if (now_s - touchdown_s < rest.rest_s) return false;
    if (now_s - touchdown_s >= certain_s) return true;
    const auto& times_s = altitude_m.time_s;
    const auto from = std::ranges::lower_bound(times_s, now_s - rest.rest_s) - times_s.begin();
    const auto last = std::ranges::upper_bound(times_s, now_s) - times_s.begin();
    if (from >= last) return false;
    const auto [low, high] = std::minmax_element(altitude_m.value.begin() + from, altitude_m.value.begin() + last);
    return *high - *low <= rest.rest_height_m;
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

mechanical::FlightProgress airborne_progress(const flight::SelectedTracks& tracks, const flight::Sortie& sortie) {
    const double until_s = mechanical::last_time_s(tracks.series());
    const auto& first = sortie.phases.front();
    const double cruise_start_s = first.phase == flight::Phase::takeoff ? first.end.time_s : sortie.start_s();
    const double hold_s = flight::SegmentationOptions{}.hold_s;
    if (sortie.phases.back().phase == flight::Phase::takeoff || until_s - cruise_start_s < hold_s) {
        throw NoResultError(
            fmt::format("at {:.1f} s of the log, which begins in the air, the aircraft has not held its height for "
                        "{:.0f} s",
                        until_s, hold_s));
    }
    auto flown = mechanical::measured_progress(tracks, {{flight::Phase::cruise, cruise_start_s, until_s}}, until_s);
    flown.lift_off_s = sortie.start_s();
    flown.energy_wh += integrated_energy_wh(tracks["power_w"], flown.lift_off_s, cruise_start_s);
    return flown;
}

Prediction predict_airborne_start(const PredictionInput& input, const mechanical::FlightProgress& flown,
                                  bool has_cruise_start, const std::optional<path::PathFix>& fix,
                                  Diagnostics& remarks) {
    auto ahead = input;
    if (!ahead.level) ahead.level = mechanical::CruisePrior::constant;  // the position on the curve is not known
    double max_s = 0.0;
    if (!input.remaining_s && !has_cruise_start)
        max_s = (input.path ? input.path->flown().duration_s : input.cruise_s.value()) - flown.cruise_s();
    if (max_s > 0.0) {
        ahead.remaining_s = 0.5 * max_s;
        remarks.warnings.push_back(
            fmt::format("the telemetry begins in the air: 0 to {:.0f} s of the mission's cruise may remain; half of "
                        "that is expected, and the interval contains all of it",
                        max_s));
    }
    auto prediction = predict_energy(ahead, flown, fix, remarks);
    prediction.began_in_air = true;
    if (!(max_s > 0.0)) return prediction;
    constexpr double uniform_variance = 1.0 / 12.0;
    constexpr double degrees_of_freedom = 1e9;  // known exactly
    const double energy_wh = units::wh_from_joule(prediction.cruise.remaining_mean_w * max_s);
    mechanical::add_variance(prediction.remaining_energy, energy_wh * energy_wh * uniform_variance, degrees_of_freedom);
    prediction.interval = mechanical::interval_95(prediction.remaining_energy).value();
    return prediction;
}

void estimate_soc_from_counter(const flight::Track& charge_ah, double capacity_ah, double initial_soc_percent,
                               LiveBattery& result) {
    if (charge_ah.empty() || result.soc_percent) return;
    const double drawn_ah = charge_ah.value.back();
    const double left_percent = initial_soc_percent - units::percentage(drawn_ah, capacity_ah);
    if (!(drawn_ah > 0.0) || !(left_percent > 0.0)) return;  // it does not count, restarted, or counts another pack
    result.drawn_ah = drawn_ah;
    result.initial_soc_percent = initial_soc_percent;
    result.soc_percent = left_percent;
    result.state = battery::BatteryState{left_percent, 0.0};
}

}  // namespace flightwatt::live
