#include "base/statistics.h"
#include "base/units.h"
#include "flight/checks/power_rules.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double faulty_power_difference = 0.10;
constexpr double compared_power_w = 1.0;  // below, rounding and offsets rule
constexpr double faulty_counter_return = 0.05;
constexpr double faulty_closure_percent = 10.0;
constexpr double doubtful_closure_percent = 3.0;
constexpr double doubtful_phase_fraction = 0.10;   // of the phase's energy,
constexpr double doubtful_phase_of_flight = 0.02;  // and of the flight's
constexpr double doubtful_gain_drift = 0.10;
constexpr double resolved_counts = 100.0;  // steps of the counter in a quarter of a flight
constexpr double doubtful_product_part = 0.05;
constexpr double large_gap_fraction = 0.02;  // links drop out for seconds all the time
constexpr double doubtful_large_gaps_fraction = 0.04;
constexpr double doubtful_gaps_fraction = 0.05;  // all together, beyond usual intervals
constexpr double doubtful_silence_fraction = 0.06;
constexpr double doubtful_drift_fraction = 0.05;  // of the mean current in flight
constexpr double powerless_climb_m = 10.0;
constexpr std::size_t powerless_samples = 3;
constexpr double idle_fraction = 0.1;  // of the upper quartile in flight

double measured_wh(const PowerRecord& record, double start_s, double end_s) {
    return units::wh_from_joule(integrated(record.time_s, record.power_w, start_s, end_s));
}

/// How far a rising counter ran back in flight, over what it counted there. On the ground a pack may be changed.
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

/// Of the counters that the record is further away from than one limit, and no further than the other.
Texts beyond_counters(const PowerRecord& record, double least_percent, double most_percent, const char* text) {
    Texts texts;
    for (const auto* counter : record.counters()) {
        if (counter->is_beyond(least_percent) && !counter->is_beyond(most_percent))
            texts.push_back(fmt::format(fmt::runtime(text), *counter->closure_percent, counter->name));
    }
    return texts;
}

/// Gaps together, and the energy that is drawn in them beyond usual intervals.
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

Texts power_is_no_product(const PowerRecord& record) {
    if (record.is_sum_of_circuits || record.voltage_v.empty() || record.current_a.empty()) return {};
    std::vector<double> differences;
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        const double product = record.voltage_v[i] * record.current_a[i];
        if (std::abs(product) < compared_power_w) continue;
        differences.push_back(std::abs(record.power_w[i] - product) / std::abs(product));
    }
    const double apart = differences.empty() ? 0.0 : median_high(std::move(differences));
    if (apart <= faulty_power_difference) return {};
    return {fmt::format("power is {:.0f} % away from voltage times current", units::percentage(apart, 1.0))};
}

Texts counters_run_back(const PowerRecord& record) {
    Texts texts;
    for (const auto* counter : record.counters()) {
        if (const double part = counter_return(counter->value, record.in_flight); part > faulty_counter_return) {
            texts.push_back(fmt::format("the {} counter ran back by {:.0f} % of what it counted in flight",
                                        counter->name, units::percentage(part, 1.0)));
        }
    }
    return texts;
}

Texts counters_contradict(const PowerRecord& record) {
    return beyond_counters(record, faulty_closure_percent, std::numeric_limits<double>::infinity(),
                           "what was measured is {:+.0f} % away from the on-board {} counter");
}

Texts counters_differ(const PowerRecord& record) {
    return beyond_counters(record, doubtful_closure_percent, faulty_closure_percent,
                           "what was measured in flight is {:+.1f} % away from the on-board {} counter");
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
            const double apart_wh = std::abs(measured - count_wh);
            if (apart_wh <= doubtful_phase_fraction * std::abs(count_wh) + 2.0 * record.energy_wh.resolution ||
                apart_wh <= doubtful_phase_of_flight * flight_wh)
                continue;
            texts.push_back(fmt::format("{} at {:.0f} s: {:.3f} Wh were measured and {:.3f} Wh counted",
                                        to_string(span.phase), span.start.time_s, measured, count_wh));
        }
    }
    return texts;
}

Texts gain_drifts(const PowerRecord& record) {
    constexpr int quarters = 4;
    Texts texts;
    if (!record.energy_wh.closure_percent) return texts;
    const double enough_wh = std::max(doubtful_phase_fraction * units::wh_from_joule(record.energy_j),
                                      resolved_counts * record.energy_wh.resolution);
    for (const auto& sortie : record.sorties) {
        const double quarter_s = (sortie.end_s() - sortie.start_s()) / quarters;
        double least = std::numeric_limits<double>::infinity();
        double most = -least;
        for (int quarter = 0; quarter < quarters; ++quarter) {
            const double start_s = sortie.start_s() + quarter * quarter_s;
            const double count_wh = counted(record, record.energy_wh, start_s, start_s + quarter_s);
            if (count_wh < enough_wh) continue;
            const double gain = measured_wh(record, start_s, start_s + quarter_s) / count_wh;
            least = std::min(least, gain);
            most = std::max(most, gain);
        }
        if (most - least <= doubtful_gain_drift) continue;
        texts.push_back(fmt::format(
            "sortie {}: measured power over the on-board energy counter is {:.2f} to {:.2f} by quarters of the flight: "
            "the gain of its sensor drifts",
            sortie.number, least, most));
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
        if (std::abs(after->mean_a - before->mean_a) <= doubtful_drift_fraction * std::abs(mean_a)) continue;
        texts.push_back(
            fmt::format("the current at rest is {:.2f} A before sortie {} and {:.2f} A after it, the mean "
                        "in flight {:.2f} A: does its sensor drift?",
                        before->mean_a, record.sorties[s].number, after->mean_a, mean_a));
    }
    return texts;
}

Texts devices_contradict_themselves(const PowerRecord& record) {
    if (!record.power_source.starts_with("ESC") || record.voltage_v.empty() || record.current_a.empty()) return {};
    std::vector<double> product_w(record.time_s.size());
    std::ranges::transform(record.voltage_v, record.current_a, product_w.begin(), std::multiplies<>());
    double product_j = 0.0;
    for (const auto& sortie : record.sorties)
        product_j += integrated(record.time_s, product_w, sortie.start_s(), sortie.end_s());
    const double more_j = record.energy_j - product_j;
    if (!(product_j > 0.0) || std::abs(more_j) <= doubtful_product_part * product_j) return {};
    return {fmt::format(
        "the power of {} makes {:.2f} Wh in flight, its voltage times current {:.2f} Wh ({:+.0f} %): one of them is "
        "wrong",
        record.power_source, units::wh_from_joule(record.energy_j), units::wh_from_joule(product_j),
        units::percentage(more_j, product_j))};
}

Texts altitude_pauses(const PowerRecord& record) {
    if (record.is_counted()) return {};
    const auto& time_s = record.altitude_time_s;
    const auto sum = sum_of(
        gaps_in(time_s, record.sorties), median_interval_s(time_s), [](const SampleGap& gap) { return gap.is_within; },
        [&](const SampleGap&) { return record.energy_j / record.duration_s; });
    if (sum.carried_j <= doubtful_silence_fraction * record.energy_j) return {};
    return {fmt::format(
        "{} gaps in the altitude in flight, {:.0f} s in all: no message came, or the clock jumped; {:.0f} % "
        "of the energy lies in them, and no counter confirms it",
        sum.gaps, sum.together_s, units::percentage(sum.carried_j, record.energy_j))};
}

/// A gap that begins or ends a sortie hides when that was: no counter helps. Many short ones add up: of these what is
/// beyond a usual interval.
Texts power_pauses(const PowerRecord& record) {
    const auto mean_w = [&](const SampleGap& gap) {
        return std::abs(record.power_w[gap.end - 1] + record.power_w[gap.end]) / 2.0;
    };
    const auto is_unconfirmed = [&](const SampleGap& gap) { return !gap.is_within || !record.is_counted(); };
    const auto is_large = [&](const SampleGap& gap) {
        return is_unconfirmed(gap) && mean_w(gap) * gap.duration_s >= large_gap_fraction * record.energy_j;
    };
    const auto all = sum_of(record.gaps, median_interval_s(record.time_s), is_unconfirmed, mean_w);
    const auto large = sum_of(record.gaps, 0.0, is_large, mean_w);
    const bool are_many = all.carried_j > doubtful_gaps_fraction * record.energy_j;
    if (!are_many && large.carried_j <= doubtful_large_gaps_fraction * record.energy_j) return {};
    const auto& sum = are_many ? all : large;
    return {
        fmt::format("{} gap{} in the power, {:.0f} s in all, the longest {:.0f} s from {:.1f} s on: {:.0f} "
                    "% of the energy is a straight line across, and no counter confirms it",
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
