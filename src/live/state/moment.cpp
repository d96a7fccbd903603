#include "live/state/moment.h"

#include "base/error.h"
#include "base/statistics.h"
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

/// [V] of a pack below the battery's model: a cell at 3.7 V would be at 3.4 V, nearly empty.
constexpr double failing_cell_v = 0.3;

std::string reserve_text(const BatteryPrediction& battery, const std::optional<double>& probability) {
    const auto& landing = battery.expected.keeps_reserve ? battery.worst : battery.expected;
    const auto* at = battery.expected.keeps_reserve ? "at the high end of the energy's interval " : "";
    auto text = landing.fails_after_s ? fmt::format("{}the battery fails in {:.1f} min, before the landing", at,
                                                    *landing.fails_after_s / 60.0)
                                      : fmt::format("{}{:.1f} % at landing, short of the reserve of {:g} %", at,
                                                    landing.soc_percent, battery.limits.reserve_soc_percent);
    if (probability)
        text += fmt::format("; probability of landing below it {:.0f} %", units::percentage(*probability, 1.0));
    return text;
}

/// The deviation of the cruise from the model, where it is outside the 95 % interval; else empty.
std::string model_text(const Prediction& prediction, const PredictionInput& input) {
    if (prediction.uses_physical_model) {
        const auto& model = input.model.physical.value();
        const double level = prediction.cruise.gain;
        if (!model.level_sd || prediction.flown.motion.bins.empty()) return "";
        const double reach = *model.level_sd * student_t_half_width(model.degrees_of_freedom);
        if (std::abs(level) <= reach) return "";
        return fmt::format(
            "the power of this flight differs from the model by {:+.1f} %, 95 of 100 flights by {:.1f} %",
            units::percentage(level, 1.0), units::percentage(reach, 1.0));
    }
    const auto cruise_s = prediction.flown.cruise_s();
    const auto expected = predict_before_flight(forecast_of(input.model, flight::Phase::cruise), cruise_s);
    const auto interval = interval_95(expected);
    const double measured_wh = prediction.flown.cruise_energy_wh;
    if (!interval || interval->contains(measured_wh)) return "";
    return fmt::format("the cruise so far took {:.3f} Wh; 95 of 100 flights of the model take {:.3f} to {:.3f} Wh",
                       measured_wh, interval->low_wh, interval->high_wh);
}

/// The longest remaining cruise after `received_s` of it.
double max_remaining_s(const PredictionInput& input, double received_s) {
    const double whole_s = input.path ? input.path->flown().duration_s : input.cruise_s.value();
    if (received_s < whole_s) return whole_s - received_s;
    throw NoResultError(fmt::format(
        "the cruise takes longer than the mission's {:.0f} s: give the remaining cruise with --remaining", whole_s));
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
    mechanical::FlightProgress flown;
    flown.until_s = mechanical::last_time_s(tracks.series());
    flown.lift_off_s = sortie.start_s();
    const auto& first = sortie.phases.front();
    flown.cruise_start_s = first.phase == flight::Phase::takeoff ? first.end.time_s : sortie.start_s();
    const double hold_s = flight::SegmentationOptions{}.hold_s;
    if (sortie.phases.back().phase == flight::Phase::takeoff || flown.cruise_s() < hold_s) {
        throw NoResultError(
            fmt::format("at {:.1f} s of the log, which begins in the air, the aircraft has not held its height for "
                        "{:.0f} s",
                        flown.until_s, hold_s));
    }
    const auto& power = tracks["power_w"];
    flown.cruise_energy_wh = integrated_energy_wh(power, flown.cruise_start_s, flown.until_s);
    flown.energy_wh = integrated_energy_wh(power, flown.lift_off_s, flown.cruise_start_s) + flown.cruise_energy_wh;
    flown.motion = mechanical::bin_flight(tracks, {{flight::Phase::cruise, flown.cruise_start_s, flown.until_s}});
    return flown;
}

Prediction predict_airborne_start(const PredictionInput& input, const mechanical::FlightProgress& flown,
                                  bool has_cruise_start, const std::optional<path::PathFix>& fix,
                                  Diagnostics& remarks) {
    auto ahead = input;
    if (!ahead.level) ahead.level = mechanical::CruisePrior::constant;  // the position on the curve is not known
    const bool is_remaining_known = input.remaining_s || has_cruise_start;
    const double max_s = is_remaining_known ? 0.0 : max_remaining_s(input, flown.cruise_s());
    if (!is_remaining_known) {
        ahead.remaining_s = 0.5 * max_s;
        remarks.warnings.push_back(
            fmt::format("the telemetry begins in the air: 0 to {:.0f} s of the mission's cruise may remain; half of "
                        "that is expected, and the interval contains all of it",
                        max_s));
    }
    auto prediction = predict_energy(ahead, flown, fix, remarks);
    prediction.began_in_air = true;
    if (is_remaining_known) return prediction;
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

std::vector<Alarm> alarms_of(const LiveState& state, const std::optional<PredictionInput>& input, double silence_s) {
    std::vector<Alarm> alarms;
    if (state.time_since_message_s >= silence_s) {
        alarms.push_back({"silence", fmt::format("nothing was received for {:.0f} s", state.time_since_message_s)});
    }
    if (state.prediction) {
        if (const auto& battery = state.prediction->battery; battery && !battery->worst.keeps_reserve)
            alarms.push_back({"reserve", reserve_text(*battery, state.battery->probability_below_reserve)});
        if (auto text = model_text(*state.prediction, *input); !text.empty())
            alarms.push_back({"model", std::move(text)});
    }
    if (state.phase && state.battery && state.battery->voltage_residual_v.value_or(0.0) < -failing_cell_v) {
        alarms.push_back(
            {"voltage", fmt::format("the voltage is {:.2f} V below the battery's model: a failing cell, or "
                                    "another pack",
                                    -*state.battery->voltage_residual_v)});
    }
    return alarms;
}

}  // namespace flightwatt::live
