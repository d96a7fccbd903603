#include "flight/link_gaps.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

/// Within a minute, the power between two samples is near enough to a straight line, and a counter of whole Wh or mAh
/// is less exact.
constexpr double min_gap_s = 60.0;

/// The increase of a counter in a gap; 0 without one, or where it restarted or does not count.
double counted_in(const Track& counter, const TimeInterval& gap) {
    if (counter.empty()) return 0.0;
    return std::max(0.0, value_at(counter, gap.end_s) - value_at(counter, gap.start_s));
}

/// The charge counter is of the first circuit only.
double counted_energy_wh(const FlightData& data, const TimeInterval& gap) {
    const double energy_wh = counted_in(data.energy_wh, gap);
    if (energy_wh > 0.0 || data.voltage_v.empty() || data.circuits.size() > 1) return energy_wh;
    return counted_in(data.charge_ah, gap) * 0.5 *
           (value_at(data.voltage_v, gap.start_s) + value_at(data.voltage_v, gap.end_s));
}

/// Inserts samples that are never as far apart as a gap: the straight line across it, times a factor that gives it this
/// integral.
void fill(Track& track, const TimeInterval& gap, double integral) {
    const double line = integrated(track.time_s, track.value, gap.start_s, gap.end_s);
    const auto count = static_cast<std::size_t>(std::ceil(gap.duration_s() / gap_threshold_s(track.time_s)));
    std::vector<double> times_s;
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
        times_s.push_back(gap.start_s + gap.duration_s() * (static_cast<double>(i) + 0.5) / static_cast<double>(count));
        values.push_back(line > 0.0 ? value_at(track, times_s.back()) * integral / line : integral / gap.duration_s());
    }
    const auto at = std::ranges::upper_bound(track.time_s, gap.start_s) - track.time_s.begin();
    track.value.insert(track.value.begin() + at, values.begin(), values.end());
    track.time_s.insert(track.time_s.begin() + at, times_s.begin(), times_s.end());
}

bool is_flown(const LinkGap& gap, std::span<const Sortie> sorties) {
    return std::ranges::any_of(
        sorties, [&](const Sortie& sortie) { return gap.start_s < sortie.end_s() && gap.end_s > sortie.start_s(); });
}

std::string describe(const LinkGap& gap) {
    return fmt::format("gap of {:.0f} s from {:.1f} s on, in which nothing arrived: {}", gap.duration_s(), gap.start_s,
                       gap.is_counted ? "its energy is by the on-board counter" : "no counter shows its energy");
}

}  // namespace

bool bridge_gap(FlightData& data, const TimeInterval& gap) {
    const double energy_wh = counted_energy_wh(data, gap);
    if (!(energy_wh > 0.0)) return false;
    const double charge_ah = counted_in(data.charge_ah, gap);
    fill(data.power_w, gap, units::joule_from_wh(energy_wh));
    if (charge_ah > 0.0 && !data.current_a.empty()) fill(data.current_a, gap, units::coulomb_from_ah(charge_ah));
    return true;
}

std::vector<LinkGap> bridge_link_gaps(FlightData& data) {
    std::vector<LinkGap> gaps;
    const auto& power = data.power_w;
    for (std::size_t i = 1; i < power.time_s.size(); ++i)
        if (power.time_s[i] - power.time_s[i - 1] > min_gap_s) gaps.push_back({{power.time_s[i - 1], power.time_s[i]}});
    for (auto& gap : gaps) gap.is_counted = bridge_gap(data, gap);
    return gaps;
}

bool restarts(const Track& counter, double from_s, double to_s) {
    constexpr double low_fraction = 0.1;
    const auto& time_s = counter.time_s;
    const auto& value = counter.value;
    const auto end = first_after(time_s, to_s);
    for (auto i = first_at_or_after(time_s, from_s) + 1; i + 1 < end; ++i) {
        const double low = low_fraction * value[i - 1];
        if (value[i] < low && value[i + 1] < low && value[end - 1] > value[i]) return true;
    }
    return false;
}

std::vector<std::string> gap_warnings(const std::vector<LinkGap>& gaps, std::span<const Sortie> sorties) {
    std::vector<std::string> warnings;
    for (const auto& gap : gaps)
        if (is_flown(gap, sorties)) warnings.push_back(describe(gap));
    return warnings;
}

std::string unknown_energy_reason(const std::vector<LinkGap>& gaps, std::span<const Sortie> sorties) {
    const auto unknown =
        std::ranges::find_if(gaps, [&](const LinkGap& gap) { return !gap.is_counted && is_flown(gap, sorties); });
    return unknown == gaps.end() ? "" : describe(*unknown);
}

}  // namespace flightwatt::flight
