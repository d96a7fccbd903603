#include "base/statistics.h"
#include "base/units.h"
#include "flight/checks/power_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double faulty_product_difference = 0.10;
constexpr double suspect_product_difference = 0.05;
constexpr double compared_power_w = 1.0;  // below, rounding and offsets dominate
constexpr double faulty_counter_return = 0.05;
constexpr double faulty_closure_percent = 10.0;
constexpr double suspect_closure_percent = 3.0;
constexpr double suspect_phase_fraction = 0.10;   // of the phase's energy,
constexpr double suspect_phase_of_flight = 0.02;  // and of the flight's
constexpr double large_gap_fraction = 0.02;       // links are interrupted for seconds all the time
constexpr double suspect_large_gaps_fraction = 0.04;
constexpr double suspect_gaps_fraction = 0.05;  // all gaps together, beyond usual intervals
constexpr double suspect_altitude_gaps_fraction = 0.06;
constexpr double suspect_drift_fraction = 0.05;  // of the mean current in flight
constexpr double powerless_climb_m = 10.0;
constexpr std::size_t powerless_samples = 3;
constexpr double idle_fraction = 0.1;  // of the upper quartile in flight

double measured_wh(const PowerRecord& record, double start_s, double end_s) {
    return units::wh_from_joule(integrated(record.time_s, record.power_w, start_s, end_s));
}

/// Sum of a counter's falls in flight over that of its rises. On the ground a pack may be changed.
double counter_return(const std::vector<double>& counter, const std::vector<IndexSpan>& flown) {
    if (counter.empty()) return 0.0;
    double returned = 0.0;
    double risen = 0.0;
    for (const auto& [first, last] : flown) {
        for (auto i = first + 1; i < last; ++i) {
            const double step = counter[i] - counter[i - 1];
            (step < 0.0 ? returned : risen) += std::abs(step);
        }
    }
    return risen > 0.0 ? returned / risen : returned > 0.0 ? 1.0 : 0.0;
}

/// Counters from which the record differs by more than the first limit and at most the second.
Texts beyond_counters(const PowerRecord& record, double low_percent, double high_percent) {
    Texts texts;
    for (const auto* counter : record.counters()) {
        if (counter->is_beyond(low_percent) && !counter->is_beyond(high_percent))
            texts.push_back(
                fmt::format("the measured integral in flight is {:+.1f} % away from the on-board {} counter",
                            *counter->closure_percent, counter->name));
    }
    return texts;
}

/// The median difference of power from voltage times current, if it is above the first limit and not above the second.
Texts beyond_product(const PowerRecord& record, double low, double high) {
    if (record.is_sum_of_circuits || record.voltage_v.empty() || record.current_a.empty()) return {};
    std::vector<double> differences;
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        const double product = record.voltage_v[i] * record.current_a[i];
        if (std::abs(product) < compared_power_w) continue;
        differences.push_back(std::abs(record.power_w[i] - product) / std::abs(product));
    }
    const double difference = differences.empty() ? 0.0 : median_high(std::move(differences));
    if (difference <= low || difference > high) return {};
    return {fmt::format("power is {:.0f} % away from voltage times current", units::percentage(difference, 1.0))};
}

/// Sum of gaps, and the energy in them beyond usual intervals.
struct GapSum {
    std::size_t gaps = 0;
    double carried_j = 0.0;
    double together_s = 0.0;
    SampleGap longest = {};
};

template <typename Counts, typename MeanPower>
GapSum sum_of(const std::vector<SampleGap>& gaps, double usual_s, const Counts& counts, const MeanPower& mean_power_w) {
    GapSum sum;
    for (const auto& gap : gaps) {
        if (!counts(gap)) continue;
        ++sum.gaps;
        sum.carried_j += mean_power_w(gap) * (gap.duration_s - usual_s);
        sum.together_s += gap.duration_s;
        if (gap.duration_s > sum.longest.duration_s) sum.longest = gap;
    }
    return sum;
}

}  // namespace

Texts power_contradicts_product(const PowerRecord& record) {
    return beyond_product(record, faulty_product_difference, std::numeric_limits<double>::infinity());
}

Texts power_differs_from_product(const PowerRecord& record) {
    return beyond_product(record, suspect_product_difference, faulty_product_difference);
}

Texts counters_run_back(const PowerRecord& record) {
    Texts texts;
    for (const auto* counter : record.counters()) {
        if (const double part = counter_return(counter->value, record.in_flight); part > faulty_counter_return) {
            texts.push_back(fmt::format("the {} counter ran back by {:.0f} % of its count in flight", counter->name,
                                        units::percentage(part, 1.0)));
        }
    }
    return texts;
}

Texts counters_contradict(const PowerRecord& record) {
    return beyond_counters(record, faulty_closure_percent, std::numeric_limits<double>::infinity());
}

Texts counters_differ(const PowerRecord& record) {
    return beyond_counters(record, suspect_closure_percent, faulty_closure_percent);
}

Texts phases_differ_from_counter(const PowerRecord& record) {
    Texts texts;
    const auto& counter = record.energy_wh;
    if (!counter.closure_percent || std::abs(*counter.closure_percent) > faulty_closure_percent) return texts;
    const double flight_wh = units::wh_from_joule(record.energy_j);
    for (const auto& sortie : record.sorties) {
        for (const auto& span : sortie.phases) {
            const double measured = measured_wh(record, span.start.time_s, span.end.time_s);
            const double count_wh = counted(record, record.energy_wh, span.start.time_s, span.end.time_s);
            const double difference_wh = std::abs(measured - count_wh);
            if (difference_wh <= suspect_phase_fraction * std::abs(count_wh) + 2.0 * record.energy_wh.resolution ||
                difference_wh <= suspect_phase_of_flight * flight_wh)
                continue;
            texts.push_back(fmt::format("{} at {:.0f} s: {:.3f} Wh were measured and {:.3f} Wh counted",
                                        to_string(span.phase), span.start.time_s, measured, count_wh));
        }
    }
    return texts;
}

Texts current_at_rest_drifts(const PowerRecord& record) {
    Texts texts;
    for (std::size_t s = 0; s < record.sorties.size() && record.has_current(); ++s) {
        const auto& before = record.rests[s];
        const auto& after = record.rests[s + 1];
        const auto flown = record.in_flight[s];
        if (!before || !after || flown.size() == 0) continue;
        const double mean_a = mean(part_of(record.current_a, flown));
        if (std::abs(after->mean_a - before->mean_a) <= suspect_drift_fraction * std::abs(mean_a)) continue;
        texts.push_back(
            fmt::format("the current at rest is {:.2f} A before sortie {} and {:.2f} A after it, the mean "
                        "in flight {:.2f} A: does its sensor drift?",
                        before->mean_a, record.sorties[s].number, after->mean_a, mean_a));
    }
    return texts;
}

Texts altitude_has_gaps(const PowerRecord& record) {
    if (record.is_counted()) return {};
    const auto& time_s = record.altitude_time_s;
    const auto sum = sum_of(
        gaps_in(time_s, record.sorties), median_interval_s(time_s), [](const SampleGap& gap) { return gap.is_within; },
        [&](const SampleGap&) { return record.energy_j / record.duration_s; });
    if (sum.carried_j <= suspect_altitude_gaps_fraction * record.energy_j) return {};
    return {fmt::format(
        "{} gaps in the altitude in flight, {:.0f} s in all: no message came, or the clock jumped; {:.0f} % "
        "of the energy is in them, and no counter confirms it",
        sum.gaps, sum.together_s, units::percentage(sum.carried_j, record.energy_j))};
}

/// Large gaps, or many short ones beyond usual intervals. A gap at the edge of a sortie hides the time of the edge, so
/// no counter confirms it.
Texts power_has_gaps(const PowerRecord& record) {
    const auto mean_w = [&](const SampleGap& gap) {
        return std::abs(record.power_w[gap.end - 1] + record.power_w[gap.end]) / 2.0;
    };
    const auto is_unconfirmed = [&](const SampleGap& gap) { return !gap.is_within || !record.is_counted(); };
    const auto is_large = [&](const SampleGap& gap) {
        return is_unconfirmed(gap) && mean_w(gap) * gap.duration_s >= large_gap_fraction * record.energy_j;
    };
    const auto all = sum_of(record.gaps, median_interval_s(record.time_s), is_unconfirmed, mean_w);
    const auto large = sum_of(record.gaps, 0.0, is_large, mean_w);
    const bool are_many = all.carried_j > suspect_gaps_fraction * record.energy_j;
    if (!are_many && large.carried_j <= suspect_large_gaps_fraction * record.energy_j) return {};
    const auto& sum = are_many ? all : large;
    return {
        fmt::format("{} gap{} in the power, {:.0f} s in all, the longest {:.0f} s from {:.1f} s: {:.0f} % of the "
                    "energy is interpolated across, and no counter confirms it",
                    sum.gaps, sum.gaps == 1 ? "" : "s", sum.together_s, sum.longest.duration_s, sum.longest.start_s,
                    units::percentage(sum.carried_j, record.energy_j))};
}

Texts climbs_without_power(const PowerRecord& record) {
    Texts texts;
    if (record.altitude_m.empty()) return texts;
    const auto& sorties = record.sorties;
    for (std::size_t s = 0; s < sorties.size(); ++s) {
        const auto flown = record.in_flight[s];
        const auto& lift_off = sorties[s].phases.front();
        if (lift_off.phase != Phase::takeoff || !lift_off.complete || flown.size() < 2) continue;
        const auto power_w = part_of(record.power_w, flown);
        std::vector<double> sorted(power_w.begin(), power_w.end());
        std::ranges::sort(sorted);
        const double idle_w = idle_fraction * quantile(sorted, 0.75);
        const auto powered = static_cast<std::size_t>(
            std::ranges::find_if(power_w, [&](double watts) { return watts >= idle_w; }) - power_w.begin());
        if (powered < powerless_samples) continue;
        const auto last_idle = flown.begin + powered - 1;
        const double climbed_m = record.altitude_m[last_idle] - sorties[s].ground_altitude_m;
        if (climbed_m < powerless_climb_m) continue;
        texts.push_back(fmt::format(
            "sortie {} climbs to {:.0f} m above its ground from {:.1f} to {:.1f} s without power: was it towed, or is "
            "the power logged late?",
            sorties[s].number, climbed_m, lift_off.start.time_s, record.time_s[last_idle]));
    }
    return texts;
}

}  // namespace flightwatt::flight
