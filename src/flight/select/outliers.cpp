#include "flight/select/outliers.h"

#include "base/statistics.h"
#include "base/units.h"
#include "flight/checks/runs.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

const std::map<std::string_view, PhysicalBounds> bounds_by_name{{"altitude_m", {-500.0, 2e4}},
                                                                {"throttle_percent", {-5.0, 105.0}},
                                                                {"voltage_v", {0.0, 500.0}},
                                                                {"current_a", {-2e3, 2e3}},
                                                                {"power_w", {-1e5, 1e5}},
                                                                {"charge_ah", {-1e4, 1e4}},
                                                                {"energy_wh", {-1e5, 1e5}},
                                                                {"ground_speed_m_per_s", {-1.0, 300.0}},
                                                                {"airspeed_m_per_s", {-50.0, 300.0}},
                                                                {"wind_speed_m_per_s", {0.0, 100.0}},
                                                                {"wind_east_m_per_s", {-100.0, 100.0}},
                                                                {"wind_north_m_per_s", {-100.0, 100.0}},
                                                                {"climb_m_per_s", {-300.0, 300.0}},
                                                                {"air_temperature_c", {-80.0, 100.0}},
                                                                {"battery_temperature_c", {-80.0, 200.0}},
                                                                {"vtol_state", {1.0, 4.0}},
                                                                {"payload_kg", {0.0, 1e3}}};

bool is_within(const PhysicalBounds& bounds, double value) { return value >= bounds.low && value <= bounds.high; }

constexpr double spike_factor = 3.0;
constexpr double neighbour_factor = 2.0;
constexpr double voltage_step = 0.30;
constexpr double counter_step = 0.01;
constexpr std::size_t max_dropout = 3;
constexpr double max_removed_part = 0.2;  // of the samples: more may be a motor that is pulsed
constexpr double dropout_throttle_percent = 30.0;
constexpr double running_fraction = 0.25;

/// The largest magnitude that was held for three samples.
double held_magnitude(const std::vector<double>& values) {
    double held = 0.0;
    for (std::size_t i = 2; i < values.size(); ++i) {
        held = std::max(held, std::min({std::abs(values[i - 2]), std::abs(values[i - 1]), std::abs(values[i])}));
    }
    return held;
}

bool is_speed(const Track& track) { return track.name == "ground_speed_m_per_s" || track.name == "airspeed_m_per_s"; }

bool is_counter(const Track& track) { return track.name == "charge_ah" || track.name == "energy_wh"; }

/// Decides on one sample between its neighbours.
using IsSpike = std::function<bool(double before, double value, double after)>;

/// Of voltage: more than 30 % from both neighbours, which agree.
bool is_voltage_spike(double before, double value, double after) {
    const double step = voltage_step * std::max(std::abs(before), std::abs(after));
    return std::abs(after - before) <= step && std::abs(value - before) > step && std::abs(value - after) > step;
}

/// Of a counter: out of order by more than 1 % of its range.
IsSpike counter_spike(const std::vector<double>& values) {
    const auto [low, high] = std::ranges::minmax(values);
    return [step = counter_step * (high - low)](double before, double value, double after) {
        return after >= before && (value > after + step || value < before - step);
    };
}

/// Of power and current: more than three times the held magnitude and more than twice the neighbours.
IsSpike power_spike(const std::vector<double>& values, double floor) {
    return [limit = spike_factor * held_magnitude(values) + floor](double before, double value, double after) {
        const double neighbours = neighbour_factor * std::max(std::abs(before), std::abs(after));
        return std::abs(value) > limit && std::abs(value) > neighbours;
    };
}

IsSpike spike_of(const Track& track) {
    constexpr double floor_a = 1.0;
    constexpr double floor_w = 5.0;
    if (track.name == "voltage_v") return is_voltage_spike;
    if (is_counter(track)) return counter_spike(track.value);
    if (track.name == "current_a") return power_spike(track.value, floor_a);
    if (track.name == "power_w") return power_spike(track.value, floor_w);
    return {};
}

/// The times of spikes of electrical tracks: one sample (of counters), or one or two samples, between two others.
std::vector<double> spike_times(const Track& track) {
    constexpr std::size_t min_samples = 10;
    const auto& value = track.value;
    const std::size_t max_length = is_counter(track) ? 1 : 2;
    std::vector<double> times_s;
    const auto is_spike = spike_of(track);
    if (value.size() < min_samples || !is_spike) return times_s;
    for (std::size_t i = 1; i + 1 < value.size(); ++i) {
        for (std::size_t length = 1; length <= max_length && i + length < value.size(); ++length) {
            const auto spike = part_of(value, {i, i + length});
            if (!std::ranges::all_of(spike, [&](double v) { return is_spike(value[i - 1], v, value[i + length]); }))
                continue;
            for (std::size_t k = 0; k < length; ++k) times_s.push_back(track.time_s[i + k]);
            i += length - 1;
            break;
        }
    }
    return times_s;
}

/// The times of dropouts of power or current: up to three samples at exactly 0 with the throttle above 30 %, between
/// samples with such a throttle and more than a quarter of its median. A motor that is cut has its throttle closed.
std::vector<double> dropout_times(const Track& track, const Track& throttle) {
    const auto& value = track.value;
    std::vector<double> times_s;
    if (throttle.empty() || std::ranges::find(value, 0.0) == value.end()) return times_s;
    const auto percent = resample(throttle, track.time_s);
    std::vector<double> running;
    for (std::size_t i = 0; i < value.size(); ++i)
        if (percent[i] > dropout_throttle_percent) running.push_back(value[i]);
    if (running.empty()) return times_s;
    const double running_level = running_fraction * median_high(std::move(running));
    const auto runs = [&](std::size_t i) { return percent[i] > dropout_throttle_percent; };
    const auto is_running = [&](std::size_t i) { return runs(i) && value[i] > 0.0 && value[i] > running_level; };
    for (std::size_t i = 1; i + 1 < value.size(); ++i) {
        if (value[i] != 0.0 || !is_running(i - 1)) continue;
        const auto first = i;
        while (i < value.size() && value[i] == 0.0 && runs(i)) ++i;
        if (i == value.size() || i - first > max_dropout || !is_running(i)) continue;
        times_s.insert(times_s.end(), track.time_s.begin() + static_cast<std::ptrdiff_t>(first),
                       track.time_s.begin() + static_cast<std::ptrdiff_t>(i));
    }
    return times_s;
}

/// Whether all values are within the bounds.
bool is_plausible(const Track& track) {
    const auto bounds = physical_bounds(track.name);
    return !bounds || std::ranges::all_of(track.value, [&](double value) { return is_within(*bounds, value); });
}

}  // namespace

std::optional<PhysicalBounds> physical_bounds(std::string_view track_name) {
    const auto found = bounds_by_name.find(track_name);
    return found == bounds_by_name.end() ? std::nullopt : std::optional(found->second);
}

Track within_bounds(const Track& track) {
    if (is_plausible(track)) return track;
    const auto bounds = physical_bounds(track.name).value();
    constexpr double max_beyond = 0.1;
    auto kept = track;
    const auto beyond = erase_samples(kept, [&](std::size_t i) { return !is_within(bounds, track.value[i]); });
    if (static_cast<double>(beyond) > max_beyond * static_cast<double>(track.value.size()))
        kept.time_s = kept.value = {};
    return kept;
}

std::size_t erase_times(Track& track, const std::vector<double>& times_s) {
    auto next = times_s.begin();
    return erase_samples(track, [&](std::size_t i) {
        while (next != times_s.end() && *next < track.time_s[i]) ++next;
        return next != times_s.end() && *next == track.time_s[i];
    });
}

ChosenTrack remove_outliers(const Track& candidate, const std::vector<double>& contradicted_s, const Track& throttle) {
    ChosenTrack chosen{within_bounds(candidate)};
    std::vector<std::string> reasons;
    const auto all = candidate.value.size();
    if (chosen.empty() && all > 0) {
        const auto bounds = physical_bounds(candidate.name).value();
        chosen.notes.push_back(
            fmt::format("{} of {} is mostly beyond {:g} to {:g}: is it in another unit? "
                        "--columns MAP.toml states it (key unit)",
                        candidate.name, candidate.source, bounds.low, bounds.high));
        return chosen;
    }
    if (const auto beyond = all - chosen.value.size(); beyond > 0)
        reasons.push_back(fmt::format("{} beyond physical bounds", beyond));
    const auto remove = [&](const std::vector<double>& times_s, const char* reason) {
        if (const auto removed = erase_times(chosen, times_s); removed > 0)
            reasons.push_back(fmt::format("{} {}", removed, reason));
    };
    remove(contradicted_s, "where power is not voltage times current");
    const auto part = [&](const std::vector<double>& times_s) {
        return static_cast<double>(times_s.size()) / std::max(1.0, static_cast<double>(all));
    };
    const auto dropouts_s = dropout_times(chosen, throttle);
    const bool is_pulsed = part(dropouts_s) > max_removed_part;
    if (is_pulsed) {
        chosen.notes.push_back(fmt::format(
            "{} ({}) is 0 in {:.0f} % of its samples, between others with the throttle open: a pulsed motor, or a sensor "
            "that fails; they count as they are, without them {:.0f} % of the energy would be added",
            candidate.name, candidate.source, units::percentage(part(dropouts_s), 1.0),
            units::percentage(part(dropouts_s), 1.0 - part(dropouts_s))));
    } else {
        remove(dropouts_s, "at 0 for up to three samples with the throttle open");
    }
    const auto spikes_s = spike_times(chosen);
    const bool is_load = candidate.name == "power_w" || candidate.name == "current_a";
    if (!is_load || part(spikes_s) <= max_removed_part) {
        remove(spikes_s, is_counter(candidate) ? "out of the counter's order" : "far beyond the neighbouring samples");
    } else if (!is_pulsed) {
        chosen.notes.push_back(fmt::format(
            "{:.0f} % of the samples of {} ({}) are far beyond their neighbours: a pulsed motor, or a sensor that fails; "
            "they count as they are",
            units::percentage(part(spikes_s), 1.0), candidate.name, candidate.source));
    }
    if (is_speed(candidate))  // below 0 by the noise of a sensor
        for (auto& value : chosen.value) value = std::max(value, 0.0);
    if (!reasons.empty()) {
        chosen.notes.push_back(fmt::format("{} of {} samples of {} ({}) are removed: {}", all - chosen.value.size(),
                                           all, candidate.name, candidate.source, fmt::join(reasons, ", ")));
    }
    return chosen;
}

}  // namespace flightwatt::flight
