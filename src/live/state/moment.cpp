#include "live/state/moment.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "flight/link_gaps.h"
#include "flight/phase_statistics.h"
#include "live/state/soc_estimation.h"
#include "mechanical/flight_bins.h"
#include "mechanical/flight_progress.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>
#include <utility>

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

constexpr double caution_probability = 0.05;
constexpr double alarm_probability = 0.20;
constexpr double short_notice_s = 120.0;   // until the latest landing of a cruise beyond the mission's
constexpr double min_time_left_s = 10.0;   // below: now
constexpr double clearing_fraction = 0.5;  // of the threshold that was reached
constexpr const char* caution = "caution";
constexpr const char* alarm = "alarm";

bool reaches(double value, double threshold, bool was_reached) {
    return value >= threshold * (was_reached ? clearing_fraction : 1.0);
}

/// Empty: no alarm of that kind.
std::string_view grade_of(const std::vector<LiveAlarm>& alarms, std::string_view kind) {
    const auto found = std::ranges::find(alarms, kind, &LiveAlarm::kind);
    return found == alarms.end() ? std::string_view() : found->grade;
}

double probability_of(const LiveState& state) {
    const auto& known = state.battery ? state.battery->probability_below_reserve : std::nullopt;
    return known.value_or(state.prediction->battery->expected.keeps_reserve ? 0.0 : 1.0);
}

/// Whether a cruise beyond the mission's is near its latest return.
bool is_urgent(const LiveState& state) {
    return state.prediction->overtime_s && state.turn_home &&
           state.turn_home->latest_in_s.value_or(0.0) < short_notice_s;
}

std::string time_text(double time_s) {
    return time_s < 60.0 ? fmt::format("{:.0f} s", std::floor(time_s))
                         : fmt::format("{:.0f} min", std::floor(time_s / 60.0));
}

/// Whether there is time for a cruise, whose latest end is not known before it begins.
bool has_cruise_ahead(const LiveState& state) {
    if (state.phase != flight::Phase::takeoff || !state.battery) return false;
    return state.battery->time_to_reserve_s.value_or(0.0) > state.prediction->landing_s + short_notice_s;
}

/// "Turn home within 2 min", "Land now", ...
std::string return_text(const LiveState& state) {
    const auto* way = state.prediction->on_path_s ? "Turn home" : "Land";
    const auto& deadline = state.turn_home;
    if (!deadline && has_cruise_ahead(state)) return "Shorten the cruise";
    if (!deadline || deadline->latest_in_s.value_or(0.0) < min_time_left_s) return fmt::format("{} now", way);
    if (deadline->path_can_be_flown) return "Shorten the cruise";
    return fmt::format("{} within {}", way, time_text(*deadline->latest_in_s));
}

std::string reserve_text(const BatteryPrediction& battery, double probability) {
    const auto& landing = battery.expected;
    const double percent = units::percentage(probability, 1.0);
    const auto text = percent > 99.0 ? std::string("over 99 %") : fmt::format("{:.0f} %", percent);
    if (landing.fails_after_s)
        return fmt::format("the battery fails in {:.1f} min, before the landing; probability {}",
                           *landing.fails_after_s / 60.0, text);
    return fmt::format("{:.1f} % at landing, reserve {:g} %; probability of missing it {}", landing.soc_percent,
                       battery.limits.reserve_soc_percent, text);
}

void add_reserve_alarm(const LiveState& state, std::string_view before, std::vector<LiveAlarm>& alarms) {
    const double probability = probability_of(state);
    const bool is_alarm = reaches(probability, alarm_probability, before == alarm);
    const bool is_caution = reaches(probability, caution_probability, !before.empty());
    if (!is_alarm && !is_caution && !is_urgent(state)) return;
    const auto& battery = *state.prediction->battery;
    const bool has_reserve = battery.limits.reserve_soc_percent > 0.0;
    std::string action = return_text(state) + ": ";
    if (probability > 0.5)
        action += has_reserve ? "the reserve will be missed" : "the battery will be empty";
    else if (is_alarm || is_caution)
        action += fmt::format("{:.0f} of 100 flights {}", units::percentage(probability, 1.0),
                              has_reserve ? "miss the reserve" : "run empty");
    else
        action += has_reserve ? "later the reserve is missed" : "later the battery is empty";
    alarms.push_back({"reserve", is_alarm ? alarm : caution, reserve_text(battery, probability), std::move(action)});
}

/// While the charge at landing is unknown: an alarm below the reserve; else what was raised before, as nothing shows
/// that it has passed.
void add_reserve_alarm_without_prediction(const LiveState& state, double reserve_percent, std::string_view before,
                                          std::vector<LiveAlarm>& alarms) {
    if (!state.phase) return;
    const auto now = state.battery.value_or(LiveBattery{});
    const auto percent = now.soc_percent && !now.is_by_voltage ? now.soc_percent : now.soc_by_voltage_percent;
    if (percent && *percent <= reserve_percent)
        alarms.push_back({"reserve", alarm, fmt::format("{:.1f} % left, reserve {:g} %", *percent, reserve_percent),
                          "Land now: the charge is below the reserve"});
    else if (!before.empty())
        alarms.push_back({"reserve", std::string(before), "the charge at landing is unknown at present",
                          "As before: nothing shows that the reserve is kept"});
}

/// Whether the voltage is so far below the battery's model that an alarm is raised, or stays: in the air, and as a caution
/// on the ground, as a pack that lost charge may be flown again.
bool contradicts_charge(const LiveState& state, const std::vector<LiveAlarm>& before) {
    if (!state.battery) return false;
    const double missing_v = -state.battery->voltage_residual_v.value_or(0.0);
    return reaches(missing_v, contradicting_v(state.battery->voltage_explained_v),
                   !grade_of(before, "voltage").empty());
}

}  // namespace

bool states_flight(const flight::FlightData& data) {
    constexpr double recent_s = 10.0;
    const auto is_now = [&](const flight::Track& of, double value) {
        return !of.empty() && of.value.back() == value && of.time_s.back() >= data.last_s - recent_s;
    };
    return is_now(data.landed, 0.0) && !is_now(data.armed, 0.0);
}

double time_without_power_s(const flight::Track& power_w, const LiveState& state) {
    if (power_w.empty() || !state.phase) return 0.0;
    const double without_s = state.time_s - power_w.time_s.back();
    const double usual_s = 3.0 * flight::median_interval_s(power_w.time_s);
    return without_s >= std::max(state.silence_threshold_s, usual_s) ? without_s : 0.0;
}

void update_flight_times(const flight::Sortie& sortie, const flight::FlightData& data, bool is_over, LiveState& state) {
    using flight::Phase;
    const double now_s = data.last_s;
    const auto& first = sortie.phases.front();
    const auto& last = sortie.phases.back();
    state.began_in_air = first.phase != Phase::takeoff || !first.complete;
    state.landed = last.phase == Phase::landing && last.complete &&
                   (is_over || (has_stayed(data.altitude_m, last.end.time_s, now_s) && !states_flight(data)));
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
    if (state.phase) {
        const auto& sorties = phases.sorties;
        const double start_s = sorties.back().start_s();
        if (sorties.size() == 1) return start_s - rest_kept_s;
        const double rest_s = start_s - sorties[sorties.size() - 2].end_s();
        return start_s - std::min(rest_kept_s, rest_s / 2.0);  // in the rest, not in the flight before
    }
    double from_s = state.time_s - ground_kept_s;
    for (const auto& sortie : phases.sorties)
        if (sortie.end_s() >= from_s) from_s = std::min(from_s, sortie.start_s() - rest_kept_s);
    return from_s;
}

std::string without_flight_name(const std::string& text, const std::string& flight) {
    const auto prefix = flight + ": ";
    return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

mechanical::FlightProgress airborne_progress(const flight::FlightData& data, const flight::Sortie& sortie) {
    const double until_s = data.last_s;
    const auto& first = sortie.phases.front();
    const double cruise_start_s = first.phase == flight::Phase::takeoff ? first.end.time_s : sortie.start_s();
    const double hold_s = flight::SegmentationOptions{}.hold_s;
    if (sortie.phases.back().phase == flight::Phase::takeoff || until_s - cruise_start_s < hold_s) {
        throw NoResultError(
            fmt::format("at {:.1f} s of the log, which begins in the air, the aircraft has not held its height for "
                        "{:.0f} s",
                        until_s, hold_s));
    }
    auto flown = mechanical::measured_progress(data, {{flight::Phase::cruise, cruise_start_s, until_s}}, until_s);
    flown.lift_off_s = sortie.start_s();
    flown.energy_wh += integrated_energy_wh(data.power_w, flown.lift_off_s, cruise_start_s);
    return flown;
}

Prediction predict_airborne_start(const PredictionInput& input, const mechanical::FlightProgress& flown,
                                  bool has_cruise_start, const std::optional<path::PathFix>& fix, Remarks& remarks) {
    auto ahead = input;
    ahead.prior = mechanical::CruisePrior::constant;  // the position on the curve is not known
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
    if (restarts(charge_ah, charge_ah.time_s.front(), charge_ah.time_s.back())) return;
    const double drawn_ah = charge_ah.value.back();
    const double left_percent = initial_soc_percent - units::percentage(drawn_ah, capacity_ah);
    if (!(drawn_ah > 0.0) || !(left_percent > 0.0)) return;  // it does not count, restarted, or counts another pack
    result.drawn_ah = drawn_ah;
    result.initial = {initial_soc_percent};
    result.soc_percent = left_percent;
    result.state = battery::BatteryState{left_percent, 0.0};
}

std::vector<LiveAlarm> find_alarms(const LiveState& state, const std::optional<PredictionInput>& input,
                                   const std::vector<LiveAlarm>& before) {
    std::vector<LiveAlarm> alarms;
    if (state.time_since_message_s >= state.silence_threshold_s) {
        alarms.push_back({"silence", state.phase ? alarm : caution,
                          fmt::format("nothing was received for {:.0f} s", state.time_since_message_s),
                          "Check antenna and line of sight: the numbers are old"});
    }
    if (alarms.empty() && state.time_without_power_s > 0.0) {
        alarms.push_back(
            {"silence", alarm,
             fmt::format("no power was received for {:.0f} s, though the aircraft sends", state.time_without_power_s),
             "Turn home: the charge is unknown"});
    }
    const auto reserve_before = grade_of(before, "reserve");
    if (state.prediction && state.prediction->battery)
        add_reserve_alarm(state, reserve_before, alarms);
    else if (input)
        add_reserve_alarm_without_prediction(state, input->limits.reserve_soc_percent, reserve_before, alarms);
    if (contradicts_charge(state, before)) {
        auto text = fmt::format("the voltage is {:.2f} V below the battery's model: a failing cell, or another pack",
                                -state.battery->voltage_residual_v.value_or(0.0));
        if (state.prediction && state.battery->is_by_voltage)
            text += fmt::format("; the prediction is by the voltage, {:.0f} %", state.battery->state->soc_percent);
        const auto* action = state.phase ? "Turn home and land" : "Do not take off";
        alarms.push_back({"voltage", state.phase ? alarm : caution, std::move(text),
                          fmt::format("{}: the voltage is too low for this charge", action)});
    }
    if (state.prediction) {
        auto [fraction, text] = model_deviation(*state.prediction, *input);
        if (reaches(fraction, 1.0, !grade_of(before, "model").empty()))
            alarms.push_back(
                {"model", caution, std::move(text), "Check load, propeller and wind: the model may not fit"});
    }
    std::ranges::stable_sort(alarms, std::less<>(), [](const LiveAlarm& of) { return of.grade != alarm; });
    return alarms;
}

}  // namespace flightwatt::live
