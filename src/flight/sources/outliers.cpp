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

constexpr double contradicting_part = 0.10;
constexpr double contradicting_w = 1.0;  // power may be a whole number
constexpr double spike_factor = 3.0;
constexpr double neighbour_factor = 2.0;
constexpr double voltage_step = 0.30;
constexpr double counter_step = 0.01;
constexpr std::size_t max_dropout = 3;
constexpr double dropout_throttle_percent = 30.0;
constexpr double beside_dropout_fraction = 0.25;

struct ComparedPower {
    double time_s;
    double difference_w;
    double larger_w;
};

std::vector<ComparedPower> compared(const Track& power, const Track& product) {
    std::vector<ComparedPower> pairs;
    pairs.reserve(std::min(power.time_s.size(), product.time_s.size()));
    for (std::size_t i = 0, j = 0; i < power.time_s.size(); ++i) {
        while (j < product.time_s.size() && product.time_s[j] < power.time_s[i]) ++j;
        if (j == product.time_s.size() || product.time_s[j] != power.time_s[i]) continue;
        pairs.push_back({power.time_s[i], std::abs(power.value[i] - product.value[j]),
                         std::max(std::abs(power.value[i]), std::abs(product.value[j]))});
    }
    return pairs;
}

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

}  // namespace

std::optional<PhysicalBounds> physical_bounds(std::string_view track_name) {
    const auto* const found = std::ranges::find(bounds_by_name, track_name, &NamedBounds::name);
    return found == bounds_by_name.end() ? std::nullopt : std::optional(found->bounds);
}

bool is_plausible(const Track& track) {
    const auto bounds = physical_bounds(track.name);
    return !bounds || std::ranges::all_of(track.value, [&](double value) { return is_within(*bounds, value); });
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

std::vector<double> inconsistent_times(const Track& power, const Track& product) {
    const auto pairs = compared(power, product);
    std::vector<double> parts;
    parts.reserve(pairs.size());
    for (const auto& pair : pairs)
        if (pair.larger_w > contradicting_w) parts.push_back(pair.difference_w / pair.larger_w);
    constexpr std::size_t enough = 10;
    if (parts.size() < enough) return {};
    const double part = std::max(contradicting_part, 10.0 * median_high(std::move(parts)));
    std::vector<double> times_s;
    for (const auto& pair : pairs)
        if (pair.difference_w > part * pair.larger_w + contradicting_w) times_s.push_back(pair.time_s);
    return times_s;
}

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

Track without_times(Track track, const std::vector<double>& times_s) {
    auto next = times_s.begin();
    erase_samples(track, [&](std::size_t i) {
        while (next != times_s.end() && *next < track.time_s[i]) ++next;
        return next != times_s.end() && *next == track.time_s[i];
    });
    return track;
}

CleanedTrack remove_outliers(const Track& candidate, const std::vector<double>& contradicted_s, const Track& throttle) {
    CleanedTrack sound;
    sound.is_unchanged = is_plausible(candidate);
    if (!sound.is_unchanged) sound.track = within_bounds(candidate);
    const auto all = candidate.value.size();
    if (sound.of(candidate).empty() && all > 0) {
        const auto bounds = physical_bounds(candidate.name).value();
        sound.removal_note = fmt::format("{} of {} is mostly beyond {:g} to {:g}", candidate.name, candidate.source,
                                         bounds.low, bounds.high);
        return sound;
    }
    std::vector<std::string> reasons;
    std::size_t left = all;
    const auto note = [&](const char* reason) {
        const auto now = sound.of(candidate).value.size();
        if (now < left) reasons.push_back(fmt::format("{} {}", left - now, reason));
        left = now;
    };
    const auto leave_out = [&](const std::vector<double>& times_s, const char* reason) {
        if (times_s.empty()) return;
        sound.track = without_times(sound.take(candidate), times_s);
        sound.is_unchanged = false;
        note(reason);
    };
    note("beyond what can be");
    leave_out(contradicted_s, "where power is not voltage times current");
    leave_out(dropout_times(sound.of(candidate), throttle), "at 0 for up to three samples with the throttle open");
    leave_out(spike_times(sound.of(candidate)),
              is_counter(candidate) ? "out of the counter's order" : "far beyond the samples beside");
    if (!reasons.empty()) {
        sound.removal_note = fmt::format("{} of {} samples of {} ({}) are left out: {}", all - left, all,
                                         candidate.name, candidate.source, fmt::join(reasons, ", "));
    }
    return sound;
}

}  // namespace flightwatt::flight
