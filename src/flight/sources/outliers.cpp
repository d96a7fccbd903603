#include "flight/sources/outliers.h"

#include "base/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

struct NamedBounds {
    std::string_view name;
    PhysicalBounds bounds;
};

constexpr std::array bounds_by_name{NamedBounds{"altitude_m", {-500.0, 2e4}},
                                    NamedBounds{"throttle_percent", {-5.0, 105.0}},
                                    NamedBounds{"voltage_v", {0.0, 500.0}},
                                    NamedBounds{"current_a", {-2e3, 2e3}},
                                    NamedBounds{"power_w", {-1e5, 1e5}},
                                    NamedBounds{"charge_ah", {-1e4, 1e4}},
                                    NamedBounds{"energy_wh", {-1e5, 1e5}},
                                    NamedBounds{"ground_speed_m_per_s", {-1.0, 300.0}},
                                    NamedBounds{"airspeed_m_per_s", {-50.0, 300.0}},
                                    NamedBounds{"wind_speed_m_per_s", {0.0, 100.0}},
                                    NamedBounds{"wind_east_m_per_s", {-100.0, 100.0}},
                                    NamedBounds{"wind_north_m_per_s", {-100.0, 100.0}},
                                    NamedBounds{"climb_m_per_s", {-300.0, 300.0}},
                                    NamedBounds{"air_temperature_c", {-80.0, 100.0}}};

bool is_within(const PhysicalBounds& bounds, double value) { return value >= bounds.low && value <= bounds.high; }

constexpr double spike_factor = 3.0;
constexpr double neighbour_factor = 2.0;
constexpr double voltage_step = 0.30;
constexpr double counter_step = 0.01;
constexpr std::size_t max_dropout = 3;
constexpr double dropout_throttle_percent = 30.0;
constexpr double beside_dropout_fraction = 0.25;

/// The largest magnitude that was held for three samples.
double held_magnitude(const std::vector<double>& values) {
    double held = 0.0;
    for (std::size_t i = 2; i < values.size(); ++i) {
        held = std::max(held, std::min({std::abs(values[i - 2]), std::abs(values[i - 1]), std::abs(values[i])}));
    }
    return held;
}

/// The times of all runs [first, last) of one or two samples between two others that are spikes.
template <typename IsSpike>
std::vector<double> times_of_runs(const Track& track, const IsSpike& is_spike) {
    std::vector<double> times_s;
    for (std::size_t i = 1; i + 1 < track.value.size(); ++i) {
        for (const std::size_t length : {1U, 2U}) {
            if (i + length >= track.value.size() || !is_spike(i, i + length)) continue;
            times_s.insert(times_s.end(), track.time_s.begin() + static_cast<std::ptrdiff_t>(i),
                           track.time_s.begin() + static_cast<std::ptrdiff_t>(i + length));
            i += length - 1;
            break;
        }
    }
    return times_s;
}

bool is_counter(const Track& track) { return track.name == "charge_ah" || track.name == "energy_wh"; }

bool is_electrical(const Track& track) {
    return is_counter(track) || track.name == "voltage_v" || track.name == "current_a" || track.name == "power_w";
}

std::vector<double> voltage_spikes(const Track& track) {
    const auto& value = track.value;
    return times_of_runs(track, [&](std::size_t first, std::size_t last) {
        const double before = value[first - 1];
        const double after = value[last];
        const double step = voltage_step * std::max(std::abs(before), std::abs(after));
        if (std::abs(after - before) > step) return false;
        for (auto i = first; i < last; ++i)
            if (std::abs(value[i] - before) <= step || std::abs(value[i] - after) <= step) return false;
        return true;
    });
}

std::vector<double> counter_spikes(const Track& track) {
    const auto& value = track.value;
    const auto [least, most] = std::ranges::minmax(value);
    const double step = counter_step * (most - least);
    return times_of_runs(track, [&](std::size_t first, std::size_t last) {
        if (last != first + 1 || value[last] < value[first - 1]) return false;
        return value[first] > value[last] + step || value[first] < value[first - 1] - step;
    });
}

/// The times of samples that nothing before and after them explains. Of power and current: one or two samples of more
/// than three times what was ever held for three samples, and of more than twice their neighbours. Of voltage: one or
/// two samples that differ from the neighbours, which agree, by more than 30 %. Of counters: a sample that alone is out
/// of their order by more than 1 % of what was counted. A sample is judged once another follows it.
std::vector<double> spike_times(const Track& track) {
    const auto& value = track.value;
    constexpr std::size_t judged = 10;
    if (value.size() < judged || !is_electrical(track)) return {};
    if (track.name == "voltage_v") return voltage_spikes(track);
    if (is_counter(track)) return counter_spikes(track);
    const double floor = track.name == "current_a" ? 1.0 : 5.0;  // A or W: below, nothing is far
    const double limit = spike_factor * held_magnitude(value) + floor;
    return times_of_runs(track, [&](std::size_t first, std::size_t last) {
        const double beside = neighbour_factor * std::max(std::abs(value[first - 1]), std::abs(value[last]));
        for (auto i = first; i < last; ++i)
            if (std::abs(value[i]) <= limit || std::abs(value[i]) <= beside) return false;
        return true;
    });
}

/// The times of samples of power or current that dropped out: up to three in a row at exactly 0 while the throttle
/// stands above 30 %, as it does before and after, where there is more than a quarter of the median at such a throttle.
/// A motor that is cut for so short a time has its throttle closed.
std::vector<double> dropout_times(const Track& track, const Track& throttle) {
    const auto& value = track.value;
    std::vector<double> times_s;
    if (throttle.empty() || std::ranges::find(value, 0.0) == value.end()) return times_s;
    const auto percent = resample(throttle, track.time_s);
    std::vector<double> running;
    for (std::size_t i = 0; i < value.size(); ++i)
        if (percent[i] > dropout_throttle_percent) running.push_back(value[i]);
    if (running.empty()) return times_s;
    const double beside = beside_dropout_fraction * median_high(std::move(running));
    const auto runs = [&](std::size_t i) { return percent[i] > dropout_throttle_percent; };
    const auto is_beside = [&](std::size_t i) { return runs(i) && value[i] > 0.0 && value[i] > beside; };
    for (std::size_t i = 1; i + 1 < value.size(); ++i) {
        if (value[i] != 0.0 || !is_beside(i - 1)) continue;
        const auto first = i;
        while (i < value.size() && value[i] == 0.0 && runs(i)) ++i;
        if (i == value.size() || i - first > max_dropout || !is_beside(i)) continue;
        times_s.insert(times_s.end(), track.time_s.begin() + static_cast<std::ptrdiff_t>(first),
                       track.time_s.begin() + static_cast<std::ptrdiff_t>(i));
    }
    return times_s;
}

/// Whether all of it lies within its bounds.
bool is_plausible(const Track& track) {
    const auto bounds = physical_bounds(track.name);
    return !bounds || std::ranges::all_of(track.value, [&](double value) { return is_within(*bounds, value); });
}

}  // namespace

std::optional<PhysicalBounds> physical_bounds(std::string_view track_name) {
    const auto* const found = std::ranges::find(bounds_by_name, track_name, &NamedBounds::name);
    return found == bounds_by_name.end() ? std::nullopt : std::optional(found->bounds);
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

TrackSelection remove_outliers(const Track& candidate, const std::vector<double>& contradicted_s,
                               const Track& throttle) {
    TrackSelection sound{.logged = &candidate};
    std::vector<std::string> reasons;
    const auto note = [&](std::size_t samples, const char* reason) {
        if (samples > 0) reasons.push_back(fmt::format("{} {}", samples, reason));
    };
    const auto leave_out = [&](const std::vector<double>& times_s, const char* reason) {
        if (!times_s.empty()) note(erase_times(sound.own(), times_s), reason);
    };
    const auto all = candidate.value.size();
    if (!is_plausible(candidate)) {
        sound = TrackSelection{.derived = within_bounds(candidate)};
        if (sound.derived.empty()) {
            const auto bounds = physical_bounds(candidate.name).value();
            sound.removal_notes.push_back(fmt::format("{} of {} is mostly beyond {:g} to {:g}", candidate.name,
                                                      candidate.source, bounds.low, bounds.high));
            return sound;
        }
        note(all - sound.derived.value.size(), "beyond what can be");
    }
    leave_out(contradicted_s, "where power is not voltage times current");
    leave_out(dropout_times(sound.track(), throttle), "at 0 for up to three samples with the throttle open");
    leave_out(spike_times(sound.track()),
              is_counter(candidate) ? "out of the counter's order" : "far beyond the samples beside");
    if (!reasons.empty()) {
        sound.removal_notes.push_back(fmt::format("{} of {} samples of {} ({}) are left out: {}",
                                                  all - sound.track().value.size(), all, candidate.name,
                                                  candidate.source, fmt::join(reasons, ", ")));
    }
    return sound;
}

}  // namespace flightwatt::flight
