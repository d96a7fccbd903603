#include "flight/families/logging_pauses.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double min_pause_s = 60.0;
constexpr double restarted_part = 0.1;  // of the counter before
constexpr double fresh_factor = 1.05;   // of the voltage before: a loaded pack recovers less in minutes
constexpr double loaded_part = 0.5;     // of the current before
constexpr std::size_t compared_samples = 10;

/// The means of a track before and after a pause; empty without samples on both sides.
struct AroundPause {
    double before = 0.0;
    double after = 0.0;
};

std::optional<AroundPause> around_pause(const FlightSeries& series, std::string_view name, double end_s,
                                        std::size_t samples) {
    const auto found = std::ranges::find(series.tracks, name, &Track::name);
    if (found == series.tracks.end()) return std::nullopt;
    const auto end = first_at_or_after(found->time_s, end_s);
    const auto all = std::span(found->value);
    const auto before = all.first(end).last(std::min(samples, end));
    const auto after = all.subspan(end, std::min(samples, all.size() - end));
    if (before.empty() || after.empty()) return std::nullopt;
    return AroundPause{mean(before), mean(after)};
}

/// Why another pack is used after the pause; empty if none is known to be.
std::string other_pack_reason(const FlightSeries& series, double end_s) {
    const auto charge = around_pause(series, "charge_ah", end_s, 1);
    if (charge && charge->after < restarted_part * charge->before) return "the charge counter restarts";
    const auto voltage = around_pause(series, "voltage_v", end_s, compared_samples);
    const auto current = around_pause(series, "current_a", end_s, compared_samples);
    const bool is_fresh = voltage && voltage->before > 0.0 && voltage->after > fresh_factor * voltage->before;
    if (!is_fresh || !current || current->after < loaded_part * current->before) return "";
    return fmt::format("the voltage has risen from {:.1f} to {:.1f} V", voltage->before, voltage->after);
}

/// The part of a series from `begin_s` to before `end_s`.
FlightSeries part_between(const FlightSeries& series, double begin_s, double end_s) {
    const auto is_out = [&](double time_s) { return time_s < begin_s || (time_s >= end_s && std::isfinite(end_s)); };
    FlightSeries part = series;
    for (auto& track : part.tracks) {
        const auto time_s = track.time_s;
        erase_samples(track, [&](std::size_t i) { return is_out(time_s[i]); });
    }
    for (auto& skipped : part.skipped) std::erase_if(skipped.lines, [&](const auto& at) { return is_out(at.time_s); });
    std::erase_if(part.skipped, [](const auto& skipped) { return skipped.lines.empty(); });
    return part;
}

}  // namespace

std::vector<FlightSeries> split_at_pauses(FlightSeries series) {
    constexpr double infinite_s = std::numeric_limits<double>::infinity();
    std::vector<double> bounds_s{-infinite_s};
    std::vector<std::string> notes{""};
    if (!series.tracks.empty()) {
        const auto size = [](const Track& track) { return track.time_s.size(); };
        const auto& time_s = std::ranges::max_element(series.tracks, {}, size)->time_s;
        for (std::size_t i = 1; i < time_s.size(); ++i) {
            if (time_s[i] - time_s[i - 1] <= min_pause_s) continue;
            const auto reason = other_pack_reason(series, time_s[i]);
            if (reason.empty()) continue;
            bounds_s.push_back(time_s[i]);
            notes.push_back(fmt::format("the log pauses for {:.0f} s at {:.1f} s, and {}: another recording begins",
                                        time_s[i] - time_s[i - 1], time_s[i - 1], reason));
        }
    }
    std::vector<FlightSeries> parts;
    if (bounds_s.size() == 1) {
        parts.push_back(std::move(series));
        return parts;
    }
    for (std::size_t i = 0; i < bounds_s.size(); ++i) {
        parts.push_back(part_between(series, bounds_s[i], i + 1 < bounds_s.size() ? bounds_s[i + 1] : infinite_s));
        if (!notes[i].empty()) parts.back().notes.push_back(notes[i]);
    }
    return parts;
}

}  // namespace flightwatt::flight
