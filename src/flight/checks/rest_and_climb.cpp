#include "base/statistics.h"
#include "flight/checks/flown_power.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double doubtful_drift_fraction = 0.05;  // of the mean current in flight
constexpr double powerless_climb_m = 10.0;
constexpr std::ptrdiff_t powerless_samples = 3;
constexpr double idle_fraction = 0.1;  // of the upper quartile in flight

}  // namespace

void warn_of_drift(const InFlightPower& flown, Warnings& warnings) {
    const auto& current_a = flown.record.current_a;
    const auto& rests = flown.evidence.rests;
    for (std::size_t sortie = 0; sortie < flown.record.in_flight.size() && !current_a.empty(); ++sortie) {
        const auto& before = rests[sortie];
        const auto& after = rests[sortie + 1];
        const auto [first, last] = flown.record.in_flight[sortie];
        if (!before || !after || first == last) continue;
        const double drift_a = after->mean_a - before->mean_a;
        const double mean_a = mean(std::span(current_a).subspan(first, last - first));
        if (std::abs(drift_a) <= doubtful_drift_fraction * std::abs(mean_a)) continue;
        warnings.push_back(
            fmt::format("the current at rest is {:.2f} A before sortie {} and {:.2f} A after it, the mean "
                        "in flight {:.2f} A: does its sensor drift?",
                        before->mean_a, flown.evidence.phases.sorties[sortie].number, after->mean_a, mean_a));
    }
}

void warn_of_powerless_climb(const InFlightPower& flown, Warnings& warnings) {
    const auto& record = flown.record;
    if (record.altitude_m.empty()) return;
    const auto& sorties = flown.evidence.phases.sorties;
    for (std::size_t sortie = 0; sortie < sorties.size(); ++sortie) {
        const auto [first, last] = record.in_flight[sortie];
        const auto& lift_off = sorties[sortie].phases.front();
        if (lift_off.phase != Phase::takeoff || !lift_off.complete || last - first < 2) continue;
        const auto begin = record.power_w.begin() + static_cast<std::ptrdiff_t>(first);
        const auto end = record.power_w.begin() + static_cast<std::ptrdiff_t>(last);
        std::vector<double> sorted(begin, end);
        std::ranges::sort(sorted);
        const double idle_w = idle_fraction * quantile(sorted, 0.75);
        const auto powered = std::find_if(begin, end, [&](double power_w) { return power_w >= idle_w; });
        if (powered - begin < powerless_samples) continue;
        const auto last_idle = static_cast<std::size_t>(powered - record.power_w.begin()) - 1;
        const double climbed_m = record.altitude_m[last_idle] - sorties[sortie].ground_altitude_m;
        if (climbed_m < powerless_climb_m) continue;
        warnings.push_back(fmt::format(
            "sortie {} climbs to {:.0f} m above its ground from {:.1f} to {:.1f} s without power: was it towed, or is "
            "the power logged late?",
            sorties[sortie].number, climbed_m, lift_off.start.time_s, record.time_s[last_idle]));
    }
}

}  // namespace flightwatt::flight
