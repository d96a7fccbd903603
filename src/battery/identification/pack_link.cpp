#include "battery/identification/pack_link.h"

#include "base/piecewise_linear.h"
#include "base/units.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <string_view>

namespace flightwatt::battery {
namespace {

constexpr double max_pause_s = 6.0 * units::seconds_per_hour;
constexpr double counter_error = 0.02;
constexpr double min_error_ah = 0.005;
constexpr double counted_ah = 0.01;         // a counter that begins above did not begin anew
constexpr double unreadable_cell_v = 0.01;  // a cell; a smaller fall tells nothing
constexpr double max_deviations = 2.5;      // of a resting voltage

/// Of a name like "20_07_10__06_53_03": the wall clock where it was flown, as if that were UTC.
std::optional<double> named_clock_s(std::string_view name) {
    constexpr std::string_view form = "00_00_00__00_00_00";
    if (name.size() < form.size()) return std::nullopt;
    constexpr std::array<std::size_t, 6> places{0, 3, 6, 10, 13, 16};
    std::array<int, 6> parts{};
    for (std::size_t i = 0; i < form.size(); ++i) {
        const bool is_digit = name[i] >= '0' && name[i] <= '9';
        if (form[i] == '0' ? !is_digit : name[i] != '_') return std::nullopt;
    }
    for (std::size_t i = 0; i < places.size(); ++i)
        parts[i] = 10 * (name[places[i]] - '0') + (name[places[i] + 1] - '0');
    const std::chrono::year_month_day date{std::chrono::year(2000 + parts[0]),
                                           std::chrono::month(static_cast<unsigned>(parts[1])),
                                           std::chrono::day(static_cast<unsigned>(parts[2]))};
    if (!date.ok()) return std::nullopt;
    const auto days = std::chrono::sys_days(date).time_since_epoch();
    return std::chrono::duration<double>(days).count() + units::seconds_per_hour * parts[3] +
           units::seconds_per_minute * parts[4] + parts[5];
}

/// From the last sample of one record to the first of another; negative if that one began before.
std::optional<double> pause_s(const DischargeRecord& earlier, const DischargeRecord& later) {
    const double length_s = earlier.time_s.back() - earlier.time_s.front();
    if (earlier.start_clock_s && later.start_clock_s) return *later.start_clock_s - *earlier.start_clock_s - length_s;
    const auto from_s = named_clock_s(earlier.flight);
    const auto to_s = named_clock_s(later.flight);
    if (!from_s || !to_s) return std::nullopt;
    return *to_s + later.time_s.front() - *from_s - earlier.time_s.back();
}

bool is_fallen_as_drawn(const DischargeRecord& later, const AlignedRecord& earlier, const CircuitFit& fit) {
    const double from_ah = earlier.initial_charge_ah;
    const double to_ah = from_ah + earlier.record->charge_ah.back();
    const double drawn_v = interpolate_clamped(fit.knots_ah, fit.open_circuit_v, from_ah) -
                           interpolate_clamped(fit.knots_ah, fit.open_circuit_v, to_ah);
    const double fallen_v = earlier.record->resting_voltage_v - later.resting_voltage_v;
    const double readable_v = std::max(unreadable_cell_v * fit.weights.cells, later.resolution_v);
    const double reach_v =
        max_deviations * std::hypot(charged_rest_sd_v * fit.weights.cells, lower_rest_fraction * drawn_v);
    return drawn_v > 2.0 * readable_v && fallen_v > drawn_v / 2.0 && fallen_v < drawn_v + reach_v;
}

}  // namespace

std::optional<PackLink> find_pack_link(const DischargeRecord& later, std::span<const AlignedRecord> known,
                                       const CircuitFit& fit) {
    if (later.is_other_pack) return std::nullopt;
    PackLink link;
    link.pause_s = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < known.size(); ++i) {
        if (known[i].record == &later) continue;
        const auto pause = pause_s(*known[i].record, later);
        if (!pause || *pause < 0.0 || *pause >= link.pause_s) continue;
        link.pause_s = *pause;
        link.earlier = i;
    }
    if (!(link.pause_s <= max_pause_s)) return std::nullopt;
    const auto& earlier = known[link.earlier];
    if (earlier.record->counter_ah && later.counter_ah && later.counter_ah->low > counted_ah) {
        const double apart_ah = later.counter_ah->low - earlier.record->counter_ah->high;
        if (std::abs(apart_ah) > 2.0 * counted_ah) return std::nullopt;
        link.counter_continues = true;
    }
    if (!is_fallen_as_drawn(later, earlier, fit)) return std::nullopt;
    link.charge_ah = earlier.record->charge_ah.back();
    link.error_ah = std::hypot(min_error_ah, counter_error * link.charge_ah);
    return link;
}

}  // namespace flightwatt::battery
