#include "live/state/alarms.h"

#include "base/statistics.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

constexpr double caution_probability = 0.05;
constexpr double alarm_probability = 0.20;
constexpr double failing_cell_v = 0.3;     // below the battery's model: a cell at 3.7 V would be at 3.4 V
constexpr double short_notice_s = 120.0;   // until the latest landing of a cruise beyond the mission's
constexpr double min_time_left_s = 10.0;   // below: now
constexpr double clearing_fraction = 0.5;  // of the threshold that was reached
constexpr const char* caution = "caution";
constexpr const char* alarm = "alarm";

bool reaches(double value, double threshold, bool was_reached) {
    return value >= threshold * (was_reached ? clearing_fraction : 1.0);
}

/// Empty: no alarm of that kind.
std::string_view grade_of(const std::vector<Alarm>& alarms, std::string_view kind) {
    const auto found = std::ranges::find(alarms, kind, &Alarm::kind);
    return found == alarms.end() ? std::string_view() : found->grade;
}

double probability_of(const LiveState& state) {
    const auto& prediction = *state.prediction;
    const auto& known = state.battery ? state.battery->probability_below_reserve : std::nullopt;
    const double probability = known.value_or(prediction.battery->expected.keeps_reserve ? 0.0 : 1.0);
    if (!prediction.overtime_s || !state.turn_home) return probability;
    const bool is_urgent = state.turn_home->latest_in_s.value_or(0.0) < short_notice_s;
    return is_urgent ? std::max(probability, caution_probability) : probability;
}

std::string time_text(double time_s) {
    return time_s < 60.0 ? fmt::format("{:.0f} s", std::floor(time_s))
                         : fmt::format("{:.0f} min", std::floor(time_s / 60.0));
}

/// "Turn home within 2 min", "Land now", ...
std::string return_text(const LiveState& state) {
    const auto* way = state.prediction->on_path_s ? "Turn home" : "Land";
    const auto& deadline = state.turn_home;
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

void add_reserve_alarm(const LiveState& state, std::string_view before, std::vector<Alarm>& alarms) {
    const double probability = probability_of(state);
    const bool is_alarm = reaches(probability, alarm_probability, before == alarm);
    if (!is_alarm && !reaches(probability, caution_probability, !before.empty())) return;
    const auto& battery = *state.prediction->battery;
    const bool has_reserve = battery.limits.reserve_soc_percent > 0.0;
    auto action =
        probability > 0.5
            ? fmt::format("{}: {}", return_text(state),
                          has_reserve ? "the reserve will be missed" : "the battery will be empty")
            : fmt::format("{}: {:.0f} of 100 flights {}", return_text(state), units::percentage(probability, 1.0),
                          has_reserve ? "miss the reserve" : "run empty");
    alarms.push_back({"reserve", is_alarm ? alarm : caution, reserve_text(battery, probability), std::move(action)});
}

/// The deviation of the cruise from the model, of the half width of the 95 % interval.
struct ModelDeviation {
    double fraction = 0.0;
    std::string text;
};

ModelDeviation model_deviation(const Prediction& prediction, const PredictionInput& input) {
    if (prediction.uses_physical_model) {
        const auto& model = input.model.physical.value();
        const double level = prediction.cruise.gain;
        if (!model.level_sd || prediction.flown.motion.bins.empty()) return {};
        const double reach = *model.level_sd * student_t_half_width(model.degrees_of_freedom);
        return {
            std::abs(level) / reach,
            fmt::format("the power of this flight differs from the model by {:+.1f} %, 95 of 100 flights by {:.1f} %",
                        units::percentage(level, 1.0), units::percentage(reach, 1.0))};
    }
    const auto expected =
        predict_before_flight(forecast_of(input.model, flight::Phase::cruise), prediction.flown.cruise_s());
    const auto interval = interval_95(expected);
    if (!interval) return {};
    const double measured_wh = prediction.flown.cruise_energy_wh;
    return {std::abs(measured_wh - expected.energy_wh) / (interval->high_wh - expected.energy_wh),
            fmt::format("the cruise so far took {:.3f} Wh; 95 of 100 flights of the model take {:.3f} to {:.3f} Wh",
                        measured_wh, interval->low_wh, interval->high_wh)};
}

}  // namespace

std::vector<Alarm> alarms_of(const LiveState& state, const std::optional<PredictionInput>& input,
                             const std::vector<Alarm>& before) {
    std::vector<Alarm> alarms;
    if (state.time_since_message_s >= state.silence_threshold_s) {
        alarms.push_back({"silence", state.phase ? alarm : caution,
                          fmt::format("nothing was received for {:.0f} s", state.time_since_message_s),
                          "Check antenna and line of sight: the numbers are old"});
    }
    if (state.prediction && state.prediction->battery) add_reserve_alarm(state, grade_of(before, "reserve"), alarms);
    const double missing_v = state.phase && state.battery ? -state.battery->voltage_residual_v.value_or(0.0) : 0.0;
    if (reaches(missing_v, failing_cell_v, !grade_of(before, "voltage").empty())) {
        alarms.push_back({"voltage", alarm,
                          fmt::format("the voltage is {:.2f} V below the battery's model: a failing cell, or another "
                                      "pack",
                                      missing_v),
                          "Turn home and land: the voltage is too low for this charge"});
    }
    if (state.prediction) {
        auto [fraction, text] = model_deviation(*state.prediction, *input);
        if (reaches(fraction, 1.0, !grade_of(before, "model").empty()))
            alarms.push_back(
                {"model", caution, std::move(text), "Check load, propeller and wind: the model may not fit"});
    }
    std::ranges::stable_sort(alarms, std::less<>(), [](const Alarm& of) { return of.grade != alarm; });
    return alarms;
}

}  // namespace flightwatt::live
