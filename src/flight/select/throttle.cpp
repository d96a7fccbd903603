#include "flight/select/throttle.h"

#include "base/statistics.h"
#include "base/units.h"
#include "flight/checks/runs.h"
#include "flight/families/derived_tracks.h"
#include "flight/flight_phases.h"
#include "flight/select/candidates.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double contradicted_s = 30.0;  // an idle throttle is contradicted for at least this time

/// Whether a throttle of unknown unit is 0 to 1: the motor takes power at such values, or they are not whole percents.
bool is_fraction(const Track& throttle, const Track& power) {
    constexpr std::size_t enough = 10;
    constexpr double idle = 0.05;
    constexpr double runs = 0.2;
    constexpr double full = 1.5;
    if (throttle.empty() || comes_from_message(throttle)) return false;
    const auto [low, high] = std::ranges::minmax(throttle.value);
    if (high < runs || high > full || low < -idle) return false;
    std::vector<double> idle_w;
    std::vector<double> running_w;
    for (std::size_t i = 0; i < power.time_s.size(); ++i) {
        const double fraction = value_at(throttle, power.time_s[i]);
        if (fraction <= idle) idle_w.push_back(power.value[i]);
        if (fraction >= runs) running_w.push_back(power.value[i]);
    }
    if (!is_constant(power) && idle_w.size() >= enough && running_w.size() >= enough)
        return median_high(std::move(running_w)) >= 3.0 * std::max(median_high(std::move(idle_w)), 0.0) + 1.0;
    const auto is_between = [](double value) { return value > idle && value != 1.0; };
    return std::ranges::count_if(throttle.value, is_between) >= static_cast<std::ptrdiff_t>(enough);
}

/// Converts a fraction to percent.
void scale_fraction(ChosenTrack& throttle) {
    const auto [low, high] = std::ranges::minmax(throttle.value);
    throttle.notes.push_back(
        fmt::format("the throttle ({}) is {:.3g} to {:.3g}: it is read as a fraction, {:.0f} to {:.0f} %",
                    throttle.source, low, high, units::percentage(low, 1.0), units::percentage(high, 1.0)));
    for (auto& value : throttle.value) value = units::percentage(value, 1.0);
}

/// The commands, if they are those of a throttle, or nullptr.
const Track* commands_of(const FlightSeries& series) {
    const auto found = std::ranges::find(series.tracks, commanded_throttle, &Track::source);
    const bool is_throttle = found != series.tracks.end() && !found->empty() &&
                             std::ranges::none_of(found->value, [](double percent) { return percent < 0.0; });
    return is_throttle ? &*found : nullptr;
}

void follow_commands(const Track& commands, ChosenTrack& throttle) {
    constexpr SegmentationOptions limits;
    const auto replaced =
        replace_idle_throttle(throttle, limits.idle_throttle_percent,
                              {commands, limits.flight_throttle_percent, limits.flight_throttle_percent, Track{}});
    if (!replaced) return;
    throttle.notes.push_back(
        fmt::format("{} is idle while {} is not for {:.0f} s, first from {:.0f} s: the latter is used there",
                    throttle.source, commanded_throttle, replaced->together_s, replaced->first_s));
}

}  // namespace

ChosenTrack select_throttle(const FlightSeries& series, const Track& power_w) {
    constexpr double max_interval_s = 2.0;  // rarer commands are used only without a power
    const auto* commands = commands_of(series);
    const bool counts =
        commands != nullptr && (median_interval_s(commands->time_s) <= max_interval_s || power_w.empty());
    const auto is_thrust = [](const Track& track) { return track.source == "ROTORCRAFT_FP.thrust"; };
    auto found = first_that_varies(series, "throttle_percent", [&](const Track& track) {
        return !is_thrust(track) && (track.source != commanded_throttle || counts);
    });
    if (found.empty()) {
        auto thrust = first_that_varies(series, "throttle_percent", is_thrust);
        std::ranges::move(thrust.notes, std::back_inserter(found.notes));
        found = {std::move(thrust), std::move(found.notes)};
    }
    if (is_fraction(found, power_w)) scale_fraction(found);
    if (commands != nullptr && !found.empty() && found.source != commanded_throttle) follow_commands(*commands, found);
    return found;
}

std::optional<ReplacedThrottle> replace_idle_throttle(Track& throttle, double idle_percent,
                                                      const MotorEvidence& evidence) {
    const auto& clock_s = evidence.percent.time_s;
    const auto moves = [&](double time_s) {
        return evidence.speed.empty() || value_at(evidence.speed, time_s) > SegmentationOptions{}.rest_speed_m_per_s;
    };
    const auto runs = [&](std::size_t i) {
        return evidence.percent.value[i] > evidence.running_percent && moves(clock_s[i]);
    };
    const auto idles = [&](std::size_t i) { return throttle.value[i] <= idle_percent; };
    const double gap_s = gap_threshold_s(clock_s);
    std::optional<ReplacedThrottle> replaced;
    for (const auto& run : runs_of({0, throttle.time_s.size()}, idles)) {
        const IndexSpan within{first_at_or_after(clock_s, throttle.time_s[run.begin]),
                               first_after(clock_s, throttle.time_s[run.end - 1])};
        const double running_s = time_where(clock_s, within, gap_s, runs);
        if (running_s < contradicted_s) continue;
        std::vector<double> running_percent;
        for (auto i = within.begin; i < within.end; ++i)
            if (runs(i)) running_percent.push_back(evidence.percent.value[i]);
        const double mean_percent = mean(running_percent);
        if (mean_percent < evidence.mean_percent) continue;
        const double last_s = clock_s[within.end - 1];  // after it nothing is known
        for (auto i = run.begin; i < run.end && throttle.time_s[i] <= last_s; ++i)
            if (moves(throttle.time_s[i])) throttle.value[i] = value_at(evidence.percent, throttle.time_s[i]);
        if (!replaced) replaced = {throttle.time_s[run.begin], 0.0, 0.0};
        replaced->mean_percent = (replaced->mean_percent * replaced->together_s + mean_percent * running_s) /
                                 (replaced->together_s + running_s);
        replaced->together_s += running_s;
    }
    return replaced;
}

}  // namespace flightwatt::flight
