#include "flight/phase_statistics.h"

#include "base/piecewise_linear.h"
#include "base/units.h"

#include <algorithm>

namespace flightwatt::flight {
namespace {

/// The samples before intervals in which bytes of the log are damaged and a sample is lost.
std::vector<std::size_t> samples_before_damage(const FlightData& data, const std::vector<double>& time_s) {
    constexpr double lost_intervals = 1.5;
    const double lost_s = lost_intervals * median_interval_s(time_s);
    std::vector<std::size_t> before;
    for (const auto& skipped : data.skipped) {
        if (skipped.unit != telemetry::SkippedLines::Unit::byte) continue;
        for (const auto& at : skipped.lines) {
            const auto next = first_at_or_after(time_s, at.time_s);
            if (next > 0 && next < time_s.size() && time_s[next] - time_s[next - 1] > lost_s)
                before.push_back(next - 1);
        }
    }
    std::ranges::sort(before);
    before.erase(std::unique(before.begin(), before.end()), before.end());
    return before;
}

}  // namespace

double integrated_energy_wh(const Track& power_w, double start_s, double end_s) {
    return units::wh_from_joule(integrated(power_w.time_s, power_w.value, start_s, end_s));
}

std::vector<CircuitShare> circuit_shares(const FlightData& data, const FlightPhases& phases) {
    std::vector<CircuitShare> shares;
    double all_wh = 0.0;
    for (const auto& circuit : data.circuits) {
        const auto& power = circuit.power_w;
        CircuitShare share{circuit.name};
        for (const auto& sortie : phases.sorties)
            share.energy_wh += integrated_energy_wh(power, sortie.start_s(), sortie.end_s());
        if (phases.sorties.empty() && !power.empty())
            share.energy_wh = integrated_energy_wh(power, power.time_s.front(), power.time_s.back());
        all_wh += share.energy_wh;
        shares.push_back(std::move(share));
    }
    for (auto& share : shares) share.percent = all_wh > 0.0 ? units::percentage(share.energy_wh, all_wh) : 0.0;
    return shares;
}

PowerStatistics::PowerStatistics(const FlightData& data)
    : power_(data.power_w),
      counter_wh_(resample(data.energy_wh, power_.time_s)),
      gap_s_(gap_threshold_s(power_.time_s)),
      lost_(samples_before_damage(data, power_.time_s)) {}

PhaseStatistics PowerStatistics::between(double start_s, double end_s) const {
    PhaseStatistics statistics;
    if (power_.empty()) return statistics;
    const auto& time_s = power_.time_s;
    double last_s = start_s;
    const auto count_gap = [&](double until_s) {
        const double interval_s = until_s - last_s;
        statistics.max_gap_s = std::max(statistics.max_gap_s, interval_s);
        if (interval_s > gap_s_) ++statistics.gaps;
        last_s = until_s;
    };
    for (auto i = first_at_or_after(time_s, start_s); i < time_s.size() && time_s[i] <= end_s; ++i) {
        count_gap(time_s[i]);
        ++statistics.samples;
    }
    count_gap(end_s);
    double energy_j = integrated(time_s, power_.value, start_s, end_s);
    for (const auto i : lost_) {
        const double from_s = std::max(start_s, time_s[i]);
        const double to_s = std::min(end_s, time_s[i + 1]);
        if (to_s <= from_s) continue;
        statistics.lost_s += to_s - from_s;
        energy_j -= integrated(time_s, power_.value, from_s, to_s);
    }
    statistics.energy_wh = units::wh_from_joule(energy_j);
    const double known_s = end_s - start_s - statistics.lost_s;
    if (known_s > 0.0) statistics.mean_power_w = energy_j / known_s;
    if (!counter_wh_.empty()) {
        statistics.counter_energy_wh =
            interpolate_clamped(time_s, counter_wh_, end_s) - interpolate_clamped(time_s, counter_wh_, start_s);
    }
    return statistics;
}

}  // namespace flightwatt::flight
