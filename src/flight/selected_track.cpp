#include "flight/selected_track.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "flight/checks/runs.h"
#include "flight/flight_phases.h"
#include "flight/sources/derived_tracks.h"
#include "flight/sources/device_check.h"
#include "flight/sources/device_sum.h"
#include "flight/sources/outliers.h"
#include "flight/sources/power_source.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

constexpr std::string_view power_device = "POWER_DEVICE";
constexpr auto units_in_log = "units in the .log";
constexpr auto any_source = [](const Track&) { return true; };

using Choice = TrackSelection;

void prepend(std::vector<std::string>& notes, const std::vector<std::string>& earlier) {
    notes.insert(notes.begin(), earlier.begin(), earlier.end());
}

/// The candidate without outliers.
Choice cleaned_choice(const FlightSeries& series, const Track& candidate) {
    const bool is_current = candidate.name == "current_a";
    auto choice = remove_outliers(candidate, {}, is_current ? dropout_throttle(series, candidate) : Track{});
    // Contradictions within a message are noted with its power.
    if (candidate.name == "voltage_v" || is_current)
        erase_times(choice.track, contradicted_times(series, candidate.source));
    return choice;
}

template <typename Accept = decltype(any_source)>
Choice first_that_varies(const FlightSeries& series, std::string_view name, const Accept& accept = any_source) {
    Choice constant;
    for (const auto& track : series.tracks) {
        if (track.name != name || track.empty() || !track.device.empty() || !accept(track)) continue;
        if (is_constant(track) && !constant.track.empty()) continue;
        auto cleaned = cleaned_choice(series, track);
        prepend(cleaned.removal_notes, constant.removal_notes);
        if (!is_constant(cleaned.track)) return cleaned;
        if (cleaned.track.empty()) {
            constant.removal_notes = std::move(cleaned.removal_notes);
        } else if (constant.track.empty()) {
            constant = std::move(cleaned);
        }
    }
    return constant;
}

Choice first_of(const FlightSeries& series, std::string_view name) {
    for (const auto& track : series.tracks)
        if (track.name == name && !track.empty()) return cleaned_choice(series, track);
    return {};
}

/// Whether a throttle is logged as 0 to 1: the motor takes power at such values, or they are not whole percents.
bool is_fraction(const Track& throttle, const FlightSeries& series) {
    constexpr std::size_t enough = 10;
    constexpr double idle = 0.05;
    constexpr double runs = 0.2;
    constexpr double full = 1.5;
    if (throttle.empty()) return false;
    const auto [low, high] = std::ranges::minmax(throttle.value);
    if (high < runs || high > full || low < -idle) return false;
    const auto power = select_power(series).track;
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
void scale_fraction(const FlightSeries& series, Choice& throttle) {
    auto& track = throttle.track;
    if (!is_fraction(track, series)) return;
    const auto [low, high] = std::ranges::minmax(track.value);
    throttle.removal_notes.push_back(
        fmt::format("the throttle ({}) is {:.3g} to {:.3g}: it is read as a fraction, {:.0f} to {:.0f} %", track.source,
                    low, high, units::percentage(low, 1.0), units::percentage(high, 1.0)));
    for (auto& value : track.value) value = units::percentage(value, 1.0);
}

/// The commands, if they are those of a throttle, or nullptr.
const Track* commands_of(const FlightSeries& series) {
    const auto found = std::ranges::find(series.tracks, commanded_throttle, &Track::source);
    const bool is_throttle = found != series.tracks.end() && !found->empty() &&
                             std::ranges::none_of(found->value, [](double percent) { return percent < 0.0; });
    return is_throttle ? &*found : nullptr;
}

/// Replaces an idle throttle by the commands in runs where these are not idle for half a minute (manual mode).
void follow_commands(const FlightSeries& series, Choice& throttle) {
    constexpr SegmentationOptions limits;
    const auto* commands = commands_of(series);
    auto& track = throttle.track;
    if (commands == nullptr || track.empty() || track.source == commanded_throttle) return;
    const auto percent = resample(*commands, track.time_s);
    const auto idles = [&](std::size_t i) { return track.value[i] <= limits.idle_throttle_percent; };
    const auto runs = [&](std::size_t i) { return commands->value[i] >= limits.flight_throttle_percent; };
    const auto first_after = [](const std::vector<double>& times_s, double time_s) {
        return static_cast<std::size_t>(std::ranges::upper_bound(times_s, time_s) - times_s.begin());
    };
    const double gap_s = gap_threshold_s(commands->time_s);
    double together_s = 0.0;
    std::optional<double> first_s;
    for (const auto& run : runs_of({0, track.time_s.size()}, idles)) {
        const auto first = std::ranges::lower_bound(commands->time_s, track.time_s[run.begin]);
        const IndexSpan sent{static_cast<std::size_t>(first - commands->time_s.begin()),
                             first_after(commands->time_s, track.time_s[run.end - 1])};
        const double running_s = time_where(commands->time_s, sent, gap_s, runs);
        if (running_s < contradicted_s) continue;
        const auto last = first_after(track.time_s, commands->time_s[sent.end - 1]);  // after it no command is known
        std::copy(percent.begin() + static_cast<std::ptrdiff_t>(run.begin),
                  percent.begin() + static_cast<std::ptrdiff_t>(last),
                  track.value.begin() + static_cast<std::ptrdiff_t>(run.begin));
        together_s += running_s;
        if (!first_s) first_s = track.time_s[run.begin];
    }
    if (!first_s) return;
    throttle.removal_notes.push_back(
        fmt::format("{} is idle while {} is not for {:.0f} s, first from {:.0f} s: the latter is used there",
                    track.source, commanded_throttle, together_s, *first_s));
}

Choice throttle(const FlightSeries& series) {
    constexpr double max_interval_s = 2.0;  // rarer commands are used only without a power
    const auto* commands = commands_of(series);
    const bool counts = commands != nullptr &&
                        (median_interval_s(commands->time_s) <= max_interval_s || select_power(series).track.empty());
    const auto is_thrust = [](const Track& track) { return track.source == "ROTORCRAFT_FP.thrust"; };
    auto found = first_that_varies(series, "throttle_percent", [&](const Track& track) {
        return !is_thrust(track) && (track.source != commanded_throttle || counts);
    });
    if (found.track.empty()) {
        auto thrust = first_that_varies(series, "throttle_percent", is_thrust);
        prepend(thrust.removal_notes, found.removal_notes);
        found = std::move(thrust);
    }
    scale_fraction(series, found);
    follow_commands(series, found);
    return found;
}

/// The pack's current, else the sum of the consumers' currents.
Choice current(const FlightSeries& series) {
    auto found = first_that_varies(series, "current_a");
    for (const std::string_view message : {std::string_view("ESC"), power_device}) {
        if (!found.track.empty()) break;
        if (message == power_device && !differing_voltages_reason(series).empty()) continue;
        found.track = sum_over_devices(series, "current_a", message).track;
    }
    return found;
}

/// No voltage for circuits with different voltages.
Choice voltage(const FlightSeries& series) {
    auto found = first_that_varies(series, "voltage_v");
    if (!found.track.source.starts_with(power_device)) return found;
    auto reason = differing_voltages_reason(series);
    if (reason.empty()) return found;
    return {.removal_notes = {std::move(reason)}};
}

Choice choose(const FlightSeries& series, std::string_view name) {
    if (name == "power_w") return select_power(series);
    if (auto of_batteries = select_of_batteries(series, name)) return *std::move(of_batteries);
    if (name == "current_a") return current(series);
    if (name == "voltage_v") return voltage(series);
    if (name == "throttle_percent") return throttle(series);
    if (name == "ground_speed_m_per_s") return first_of(series, name);
    auto found = first_that_varies(series, name);
    if (name == "airspeed_m_per_s" && is_constant(found.track))
        return {.removal_notes = std::move(found.removal_notes)};
    return found;
}

}  // namespace

Track select_track(const FlightSeries& series, std::string_view name) { return choose(series, name).track; }

const TrackSelection& SelectedTracks::choice(std::string_view name) const {
    const auto known = choices_.find(name);
    return known != choices_.end() ? known->second : choices_.emplace(name, choose(series_, name)).first->second;
}

std::vector<double> sample_selected_track(const SelectedTracks& tracks, std::string_view name,
                                          const std::vector<double>& time_s) {
    const auto& track = tracks[name];
    return track.empty() ? std::vector<double>{} : resample(track, time_s);
}

std::map<std::string, std::string> track_sources(const SelectedTracks& tracks) {
    std::map<std::string, std::string> sources;
    for (const auto& name : track_names())
        if (const auto& track = tracks[name]; !track.empty()) sources[name] = track.source;
    return sources;
}

std::optional<double> ground_altitude_m(const SelectedTracks& tracks) {
    // Altitudes of a rotorcraft are above the reference on the ground.
    if (tracks["altitude_m"].source.starts_with("ROTORCRAFT_FP")) return 0.0;
    const auto& logged = tracks["ground_altitude_m"];
    return logged.empty() ? tracks.series().planned_ground_altitude_m : logged.value.back();
}

std::optional<double> payload_kg(const FlightSeries& series) {
    const auto stated = select_track(series, "payload_kg");
    return stated.empty() ? std::nullopt : std::optional(stated.value.front());
}

std::vector<std::string> warnings_of(const SelectedTracks& tracks) {
    const auto& series = tracks.series();
    std::vector<std::string> warnings;
    if (!series.assumed_definitions.empty()) {
        std::vector<std::string> assumed;
        for (const auto& definition : series.assumed_definitions) assumed.push_back(definition.text);
        warnings.push_back(fmt::format("{}: {}",
                                       series.log_is_missing ? "no .log: message layouts assumed" : units_in_log,
                                       fmt::join(assumed, ", ")));
    }
    if (series.current_origin == CurrentOrigin::throttle) {
        warnings.emplace_back(
            "the airframe defines MILLIAMP_AT_FULL_THROTTLE and no current sensor: the current is computed from the "
            "throttle, so a power model fitted to it is circular");
    }
    const auto& power_w = tracks["power_w"];
    for (const auto& reason : tracks.choice("power_w").rejected_sources) {
        if (power_w.empty()) break;  // see no_power_reason
        warnings.push_back(fmt::format("{}: power is that of {}", reason, power_w.source));
    }
    const auto add = [&](const std::vector<std::string>& notes) {
        warnings.insert(warnings.end(), notes.begin(), notes.end());
    };
    add(tracks.choice("power_w").removal_notes);
    for (const auto* message : {"ESC", "POWER_DEVICE"})
        if (power_w.source.starts_with(message)) add(find_suspect_devices(series, message));
    for (const auto& name : track_names())
        if (name != "power_w") add(tracks.choice(name).removal_notes);
    for (const auto& skip : series.skipped) warnings.push_back(describe(skip));
    if (series.log_is_missing && series.assumed_definitions.empty()) warnings.emplace_back("no .log");
    add(series.notes);
    return warnings;
}

std::string no_power_reason(const FlightSeries& series) {
    auto power = select_power(series);
    if (!power.track.empty()) return "";
    auto reasons = std::move(power.rejected_sources);
    for (const auto& skip : series.skipped) reasons.push_back(describe(skip));
    for (const auto& assumed : series.assumed_definitions)
        reasons.push_back(fmt::format("{} {}", series.log_is_missing ? "assumed" : "the .log:", assumed.text));
    return fmt::format("{}", fmt::join(reasons, "; "));
}

void require_power(const FlightSeries& series, const std::string& messages) {
    if (const auto& restart = series.clock_restart) {
        const auto aircraft = series.aircraft_id.empty() ? "" : fmt::format("aircraft {}, ", series.aircraft_id);
        throw InputError({series.file},
                         fmt::format("the clock runs back from {:.3f} to {:.3f} s ({}{})", restart->from_s,
                                     restart->to_s, aircraft, restart->message),
                         "the file has several recordings: split it there");
    }
    if (!select_power(series).track.empty()) return;
    const auto reasons = no_power_reason(series);
    const auto reason = reasons.empty() ? "" : fmt::format(" ({})", reasons);
    const bool is_paparazzi = !series.aircraft_name.starts_with("Ardu") && !series.aircraft_name.starts_with("PX4");
    const auto whose = series.aircraft_id.empty() ? "" : " of aircraft " + series.aircraft_id;
    throw InputError({series.file}, fmt::format("has no measured power{}{}", whose, reason),
                     fmt::format("expected {}{}{}",
                                 is_paparazzi ? "ENERGY with power, BAT or ENERGY with current, ESC or POWER_DEVICE"
                                              : "BAT, CURR or battery_status with current",
                                 messages.empty() ? "" : "; it has ", messages));
}

}  // namespace flightwatt::flight
