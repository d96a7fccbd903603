#include "flight/physical_bounds.h"

#include <algorithm>
#include <array>

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
    const auto is_possible = [&](double value) { return is_within(bounds, value); };
    Track kept{track.name, track.source, track.device, track.since_s, {}, {}};
    constexpr double max_beyond = 0.1;
    const auto beyond = track.value.size() - static_cast<std::size_t>(std::ranges::count_if(track.value, is_possible));
    if (static_cast<double>(beyond) > max_beyond * static_cast<double>(track.value.size())) return kept;
    for (std::size_t i = 0; i < track.value.size(); ++i) {
        if (!is_possible(track.value[i])) continue;
        kept.time_s.push_back(track.time_s[i]);
        kept.value.push_back(track.value[i]);
    }
    return kept;
}

}  // namespace flightwatt::flight
