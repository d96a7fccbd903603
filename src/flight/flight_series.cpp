#include "flight/flight_series.h"

#include "base/piecewise_linear.h"
#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flightwatt::flight {
namespace {

double interpolate(const Track& track, std::size_t after, double time_s) {
    if (after == 0) return track.value.front();
    if (after == track.time_s.size()) return track.value.back();
    const double begin_s = track.time_s[after - 1];
    const double fraction = (time_s - begin_s) / (track.time_s[after] - begin_s);
    return std::lerp(track.value[after - 1], track.value[after], fraction);
}

void truncate_skipped(std::vector<telemetry::SkippedLines>& skipped, double until_s) {
    for (auto& skip : skipped) {
        std::erase_if(skip.lines, [&](const auto& at) { return at.time_s > until_s; });
    }
    std::erase_if(skipped, [](const auto& skip) { return skip.lines.empty(); });
    std::sort(skipped.begin(), skipped.end(),
              [](const auto& a, const auto& b) { return a.first_line() < b.first_line(); });
}

}  // namespace

double median_interval_s(const std::vector<double>& time_s) {
    std::vector<double> intervals;
    for (std::size_t i = 1; i < time_s.size(); ++i) intervals.push_back(time_s[i] - time_s[i - 1]);
    return intervals.empty() ? 0.0 : median_high(std::move(intervals));
}

std::size_t first_at_or_after(const std::vector<double>& time_s, double from_s) {
    return static_cast<std::size_t>(std::ranges::lower_bound(time_s, from_s) - time_s.begin());
}

std::size_t first_after(const std::vector<double>& time_s, double until_s) {
    return static_cast<std::size_t>(std::ranges::upper_bound(time_s, until_s) - time_s.begin());
}

double gap_threshold_s(const std::vector<double>& time_s) {
    constexpr double max_s = 10.0;
    return std::min(3.0 * median_interval_s(time_s), max_s);
}

double integrated(const std::vector<double>& time_s, const std::vector<double>& values, double start_s, double end_s) {
    double integral = 0.0;
    double last_s = start_s;
    double last = interpolate_clamped(time_s, values, start_s);
    for (auto i = first_at_or_after(time_s, start_s); i < time_s.size() && time_s[i] < end_s; ++i) {
        integral += 0.5 * (last + values[i]) * (time_s[i] - last_s);
        last_s = time_s[i];
        last = values[i];
    }
    return integral + 0.5 * (last + interpolate_clamped(time_s, values, end_s)) * (end_s - last_s);
}

Track make_track(const std::vector<double>& time_s, const std::vector<double>& values, Merge merge) {
    std::vector<std::size_t> order;
    order.reserve(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        if (std::isfinite(values[i])) order.push_back(i);
    const auto time_of = [&](std::size_t i) { return time_s[i]; };
    if (!std::ranges::is_sorted(order, {}, time_of)) std::ranges::stable_sort(order, {}, time_of);
    Track track;
    track.time_s.reserve(order.size());
    track.value.reserve(order.size());
    std::size_t merged = 0;  // rows of the last point
    for (const auto i : order) {
        if (track.empty() || track.time_s.back() != time_s[i]) {
            merged = 1;
            track.time_s.push_back(time_s[i]);
            track.value.push_back(values[i]);
            continue;
        }
        ++merged;
        auto& value = track.value.back();
        value = merge == Merge::latest ? values[i] : value + (values[i] - value) / static_cast<double>(merged);
    }
    return track;
}

double value_at(const Track& track, double time_s) {
    return interpolate(track, first_after(track.time_s, time_s), time_s);
}

double state_at(const Track& track, double time_s) {
    const auto after = first_after(track.time_s, time_s);
    return track.value[after == 0 ? 0 : after - 1];
}

std::vector<double> resample(const Track& track, const std::vector<double>& time_s) {
    std::vector<double> values;
    if (track.empty()) return values;
    values.reserve(time_s.size());
    std::size_t after = 0;
    for (const double t : time_s) {
        while (after < track.time_s.size() && track.time_s[after] <= t) ++after;
        values.push_back(interpolate(track, after, t));
    }
    return values;
}

bool is_constant(const Track& track) {
    return std::all_of(track.value.begin(), track.value.end(),
                       [&](double value) { return value == track.value.front(); });
}

double last_time_s(const FlightSeries& series) {
    double end_s = -std::numeric_limits<double>::infinity();
    for (const auto& track : series.tracks) {
        const bool counts = track.name == "power_w" || track.name == "altitude_m";
        if (counts && !track.empty()) end_s = std::max(end_s, track.time_s.back());
    }
    return end_s;
}

void replace_track(FlightSeries& series, Track track) {
    const auto is_same = [&](const Track& other) { return other.name == track.name; };
    const auto at = std::find_if(series.tracks.begin(), series.tracks.end(), is_same) - series.tracks.begin();
    std::erase_if(series.tracks, is_same);
    series.tracks.insert(series.tracks.begin() + at, std::move(track));
}

FlightSeries truncate_series(FlightSeries series, double until_s) {
    std::erase_if(series.tracks, [&](const Track& track) { return track.since_s > until_s; });
    for (auto& track : series.tracks) {
        track.time_s.resize(first_after(track.time_s, until_s));
        track.value.resize(track.time_s.size());
    }
    std::erase_if(series.assumed_definitions, [&](const auto& definition) { return definition.since_s > until_s; });
    truncate_skipped(series.skipped, until_s);
    if (series.clock_restart && series.clock_restart->visible_from_s > until_s) series.clock_restart.reset();
    return series;
}

}  // namespace flightwatt::flight
