#include "flight/select/voltage_dropouts.h"

#include "base/statistics.h"
#include "flight/checks/runs.h"
#include "flight/select/outliers.h"
#include "flight/select/power.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double dropped_part = 0.1;         // of the median voltage
constexpr double max_dropped_samples = 0.5;  // of all between the first and the last: more may be not connected
constexpr double min_median_v = 2.5;         // one cell, empty: less is no pack

/// The message and device that a track is of; a user's CSV has neither.
std::pair<std::string, std::string> supply_of(const Track& track) {
    const auto dot = track.source.find('.');
    return {dot == std::string::npos ? "" : track.source.substr(0, dot), track.device};
}

/// Power devices and ESCs are switched off in flight.
bool is_voltage_of_battery(const Track& track) {
    return track.name == "voltage_v" && std::ranges::none_of(device_messages, [&](const char* message) {
               return track.source.starts_with(message);
           });
}

std::vector<IndexSpan> dropouts_of(const std::vector<double>& voltage_v) {
    if (voltage_v.empty()) return {};
    const auto [low_v, high_v] = std::ranges::minmax(voltage_v);
    if (low_v > dropped_part * high_v) return {};
    std::vector<double> positive_v;
    std::ranges::copy_if(voltage_v, std::back_inserter(positive_v), [](double volts) { return volts > 0.0; });
    const double median_v = positive_v.empty() ? 0.0 : median_high(std::move(positive_v));
    if (median_v < min_median_v) return {};
    auto runs = runs_of({0, voltage_v.size()}, [&](std::size_t i) { return voltage_v[i] <= dropped_part * median_v; });
    std::erase_if(runs, [&](const IndexSpan& run) { return run.begin == 0 || run.end == voltage_v.size(); });
    std::size_t dropped = 0;
    for (const auto& run : runs) dropped += run.size();
    const bool are_many = static_cast<double>(dropped) > max_dropped_samples * static_cast<double>(voltage_v.size());
    return are_many ? std::vector<IndexSpan>{} : runs;
}

/// Removes the samples of a supply at `times_s`, which rise: of its other tracks than the voltage and its product those
/// that are 0.
void remove_from(Track& track, const std::vector<double>& times_s) {
    const bool is_measured = track.name != "voltage_v" && track.source.find(" * ") == std::string::npos;
    std::vector<double> removed_s;
    for (std::size_t i = 0; is_measured && i < track.time_s.size(); ++i)
        if (track.value[i] == 0.0 && std::ranges::binary_search(times_s, track.time_s[i]))
            removed_s.push_back(track.time_s[i]);
    erase_times(track, is_measured ? removed_s : times_s);
}

std::string describe_dropouts(const Track& voltage, const std::vector<IndexSpan>& runs) {
    const auto lasts_s = [&](const IndexSpan& run) { return voltage.time_s[run.end] - voltage.time_s[run.begin]; };
    double together_s = 0.0;
    std::size_t samples = 0;
    for (const auto& run : runs) {
        together_s += lasts_s(run);
        samples += run.size();
    }
    const auto longest = std::ranges::max(runs, {}, lasts_s);
    return fmt::format(
        "the voltage ({}) is about 0 V for {:.1f} s in all, between others, the longest {:.1f} s from {:.1f} s on: these "
        "{} samples are removed, and the power is interpolated across them",
        voltage.source, together_s, lasts_s(longest), voltage.time_s[longest.begin], samples);
}

}  // namespace

WithoutDropouts without_voltage_dropouts(const FlightSeries& series) {
    WithoutDropouts without;
    for (const auto& voltage : series.tracks) {
        const auto runs = is_voltage_of_battery(voltage) ? dropouts_of(voltage.value) : std::vector<IndexSpan>{};
        if (runs.empty()) continue;
        std::vector<double> times_s;
        for (const auto& run : runs) std::ranges::copy(part_of(voltage.time_s, run), std::back_inserter(times_s));
        if (!without.series) without.series = series;
        for (auto& track : without.series->tracks) {
            const bool is_electrical =
                track.name == "power_w" || track.name == "current_a" || track.source == voltage.source;
            if (is_electrical && supply_of(track) == supply_of(voltage)) remove_from(track, times_s);
        }
        without.warnings.push_back(describe_dropouts(voltage, runs));
    }
    return without;
}

}  // namespace flightwatt::flight
