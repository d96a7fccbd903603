#include "flight/checks/unusual_rules.h"

#include "base/statistics.h"
#include "base/units.h"
#include "flight/power_report.h"
#include "flight/segment/motor_record.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double compared_power_w = 1.0;      // below, rounding and offsets dominate
constexpr double max_phase_fraction = 0.10;   // of the phase's energy,
constexpr double max_phase_of_flight = 0.02;  // and of the flight's
constexpr double large_gap_fraction = 0.02;   // links are interrupted for seconds all the time
constexpr double max_large_gaps_fraction = 0.04;
constexpr double max_gaps_fraction = 0.05;  // all gaps together, beyond usual intervals
constexpr double explained_percent = 3.0;   // difference from a counter that is usual
constexpr std::size_t powerless_samples = 3;
constexpr double idle_fraction = 0.1;  // of the upper quartile in flight

double measured_wh(const PowerRecord& record, double start_s, double end_s) {
    return units::wh_from_joule(integrated(record.time_s, record.power_w, start_s, end_s));
}

/// The first of a few next samples that regains what the counter had before sample i; `last` if none does.
std::size_t regained(const std::vector<double>& counter, std::size_t i, std::size_t last) {
    constexpr std::size_t late_samples = 3;
    const auto end = std::min(last, i + late_samples + 1);
    for (auto next = i + 1; next < end; ++next)
        if (counter[next] >= counter[i - 1]) return next;
    return last;
}

/// Sum of a counter's falls in flight over that of its rises, without samples that came after later ones. On the ground a
/// pack may be changed.
double return_of(const std::vector<double>& counter, const std::vector<IndexSpan>& flown) {
    if (counter.empty()) return 0.0;
    double returned = 0.0;
    double risen = 0.0;
    for (const auto& [first, last] : flown) {
        for (auto i = first + 1; i < last; ++i) {
            const double before = counter[i - 1];
            if (counter[i] < before)
                if (const auto next = regained(counter, i, last); next < last) i = next;
            const double step = counter[i] - before;
            (step < 0.0 ? returned : risen) += std::abs(step);
        }
    }
    return risen > 0.0 ? returned / risen : returned > 0.0 ? 1.0 : 0.0;
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

Findings product_difference(const PowerRecord& record) {
    if (record.is_sum_of_circuits || record.voltage_v.empty() || record.current_a.empty()) return {};
    std::vector<double> differences;
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        const double product = record.voltage_v[i] * record.current_a[i];
        if (std::abs(product) < compared_power_w) continue;
        differences.push_back(std::abs(record.power_w[i] - product) / std::abs(product));
    }
    if (differences.empty()) return {};
    const double difference = median_high(std::move(differences));
    return {
        {difference, fmt::format("the power of {} is {:.0f} % away from voltage times current: its energy is uncertain",
                                 record.power_source, units::percentage(difference, 1.0))}};
}

Findings stuck_voltage(const PowerRecord& record) {
    constexpr double next_part = 0.2;
    constexpr double varied_part = 0.1;  // of the mean current
    constexpr std::size_t enough = 10;   // samples: fewer are often equal by a coarse resolution
    if (record.is_sum_of_circuits || record.voltage_v.empty() || !record.has_current()) return {};
    const auto lasts_s = [&](const IndexSpan& run) { return record.time_s[run.end - 1] - record.time_s[run.begin]; };
    std::vector<IndexSpan> runs;
    for (const auto& flown : record.in_flight)
        std::ranges::move(runs_of(
                              flown, [](std::size_t) { return true; },
                              [&](std::size_t i) { return record.voltage_v[i] == record.voltage_v[i - 1]; }),
                          std::back_inserter(runs));
    if (runs.size() < 2) return {};  // constant throughout
    std::ranges::stable_sort(runs, std::ranges::greater(), lasts_s);
    const auto& longest = runs.front();
    if (longest.size() < enough) return {};
    const auto currents_a = part_of(record.current_a, longest);
    const std::vector<double> varied_a(currents_a.begin(), currents_a.end());
    const bool varies =
        quantile_of(varied_a, 0.95) - quantile_of(varied_a, 0.05) > varied_part * std::abs(record.mean_a);
    if (!varies || lasts_s(runs[1]) > next_part * lasts_s(longest)) return {};
    const double part = lasts_s(longest) / record.duration_s;
    return {
        {part, fmt::format("the voltage stays at {:.4g} V from {:.1f} to {:.1f} s, {:.0f} % of the flight, while the "
                           "current varies: is its sensor stuck? The energy there is approximate",
                           record.voltage_v[longest.begin], record.time_s[longest.begin],
                           record.time_s[longest.end - 1], units::percentage(part, 1.0))}};
}

Findings counter_return(const PowerRecord& record) {
    Findings findings;
    for (const auto* counter : record.counters()) {
        const double part = return_of(counter->value, record.in_flight);
        findings.push_back({part, fmt::format("the {} counter ran back by {:.0f} % of its count in flight",
                                              counter->name, units::percentage(part, 1.0))});
    }
    return findings;
}

std::optional<ClockJump> find_clock_jump(const PowerRecord& record, const OnBoardCounter& counter) {
    const auto& rate = &counter == &record.energy_wh ? record.power_w : record.current_a;
    if (!counter.closure_percent || counter.value.empty() || rate.empty()) return std::nullopt;
    double counted = 0.0;  // in flight
    for (const auto& sortie : record.sorties)
        counted += counter_change(record, counter, sortie.start_s(), sortie.end_s());
    SampleGap longest;
    double largest_excess = 0.0;
    for (const auto& gap : record.gaps) {
        const double end_s = gap.start_s + gap.duration_s;
        const double integral = integrated(record.time_s, rate, gap.start_s, end_s) / units::seconds_per_hour;
        const double excess = integral - counter_change(record, counter, gap.start_s, end_s);
        if (!gap.is_within || excess <= largest_excess) continue;
        longest = gap;
        largest_excess = excess;
    }
    const double percent = *counter.closure_percent - units::percentage(largest_excess, counted);
    const bool is_explained = std::abs(percent) <= explained_percent + counter.rounding_percent;
    return largest_excess > 0.0 && is_explained ? std::optional(ClockJump{longest, percent}) : std::nullopt;
}

Findings counter_difference(const PowerRecord& record) {
    Findings findings;
    for (const auto* counter : record.counters()) {
        if (!counter->closure_percent) continue;
        auto text = fmt::format("the measured integral in flight is {:+.1f} % away from the on-board {} counter",
                                *counter->closure_percent, counter->name);
        if (const auto jump = find_clock_jump(record, *counter))
            text = fmt::format(
                "the clock jumps by {:.0f} s at {:.1f} s, or {:.0f} s were lost: {}, without this gap "
                "{:+.1f} %",
                jump->gap.duration_s, jump->gap.start_s, jump->gap.duration_s, text, jump->closure_percent);
        findings.push_back({std::abs(*counter->closure_percent) - counter->rounding_percent, std::move(text)});
    }
    return findings;
}

Findings phase_difference(const PowerRecord& record) {
    Findings findings;
    const auto& counter = record.energy_wh;
    if (!counter.closure_percent || std::abs(*counter.closure_percent) > max_counter_difference_percent)
        return findings;
    const double flight_wh = units::wh_from_joule(record.energy_j);
    for (const auto& sortie : record.sorties) {
        for (const auto& span : sortie.phases) {
            const double measured = measured_wh(record, span.start.time_s, span.end.time_s);
            const double count_wh = counter_change(record, record.energy_wh, span.start.time_s, span.end.time_s);
            const double difference_wh = std::abs(measured - count_wh);
            if (difference_wh <= max_phase_of_flight * flight_wh) continue;
            const double limit_wh = max_phase_fraction * std::abs(count_wh) + 2.0 * record.energy_wh.resolution;
            findings.push_back(
                {difference_wh / limit_wh, fmt::format("{} at {:.0f} s: {:.3f} Wh were measured and {:.3f} Wh counted",
                                                       phase_word(span.phase), span.start.time_s, measured, count_wh)});
        }
    }
    return findings;
}

/// A change of the power at any time between two samples, of which a straight line is assumed, is one of a uniform
/// distribution.
Findings slow_samples(const PowerRecord& record) {
    Findings findings;
    const auto& time_s = record.time_s;
    const double interval_s = median_interval_s(time_s);
    if (!(interval_s > slow_power_s)) return findings;
    for (const auto& sortie : record.sorties) {
        for (const auto& span : sortie.phases) {
            constexpr double uniform_variance = 1.0 / 12.0;
            double variance = 0.0;
            for (std::size_t i = 1; i < time_s.size(); ++i) {
                if (time_s[i] <= span.start.time_s || time_s[i - 1] >= span.end.time_s) continue;
                const double energy_j = (record.power_w[i] - record.power_w[i - 1]) * (time_s[i] - time_s[i - 1]);
                variance += uniform_variance * energy_j * energy_j;
            }
            const double energy_wh = measured_wh(record, span.start.time_s, span.end.time_s);
            const double sd_wh = units::wh_from_joule(std::sqrt(variance));
            findings.push_back(
                {energy_wh > 0.0 ? sd_wh / energy_wh : 0.0,
                 fmt::format(
                     "the power is measured every {:.2g} s: the {:.3f} Wh of the {} at {:.0f} s are known within "
                     "{:.3f} Wh (1 sd)",
                     interval_s, energy_wh, phase_word(span.phase), span.start.time_s, sd_wh)});
        }
    }
    return findings;
}

Findings rest_current_drift(const PowerRecord& record) {
    Findings findings;
    for (std::size_t s = 0; s < record.sorties.size() && record.has_current(); ++s) {
        const auto& before = record.rests[s];
        const auto& after = record.rests[s + 1];
        const auto flown = record.in_flight[s];
        if (!before || !after || flown.size() == 0) continue;
        const double mean_a = mean(part_of(record.current_a, flown));
        findings.push_back({std::abs(after->mean_a - before->mean_a) / std::abs(mean_a),
                            fmt::format("the current at rest is {:.2f} A before sortie {} and {:.2f} A after it, the "
                                        "mean in flight {:.2f} A: does its sensor drift?",
                                        before->mean_a, record.sorties[s].number, after->mean_a, mean_a)});
    }
    return findings;
}

Findings altitude_gaps(const PowerRecord& record) {
    if (record.is_counted()) return {};
    const auto& time_s = record.altitude_time_s;
    const auto sum = sum_of(
        find_flight_gaps(time_s, record.sorties), median_interval_s(time_s),
        [](const SampleGap& gap) { return gap.is_within; },
        [&](const SampleGap&) { return record.energy_j / record.duration_s; });
    return {{sum.carried_j / record.energy_j,
             fmt::format("{} gaps in the altitude in flight, {:.0f} s in all: no message came, or the clock jumped; "
                         "{:.0f} % of the energy is in them, and no counter confirms it",
                         sum.gaps, sum.together_s, units::percentage(sum.carried_j, record.energy_j))}};
}

/// Large gaps, or many short ones beyond usual intervals. A gap at the edge of a sortie hides the time of the edge, so
/// no counter confirms it.
Findings power_gaps(const PowerRecord& record) {
    const auto mean_w = [&](const SampleGap& gap) {
        return std::abs(record.power_w[gap.end - 1] + record.power_w[gap.end]) / 2.0;
    };
    const auto is_unconfirmed = [&](const SampleGap& gap) { return !gap.is_within || !record.is_counted(); };
    const auto is_large = [&](const SampleGap& gap) {
        return is_unconfirmed(gap) && mean_w(gap) * gap.duration_s >= large_gap_fraction * record.energy_j;
    };
    const auto all = sum_of(record.gaps, median_interval_s(record.time_s), is_unconfirmed, mean_w);
    const auto large = sum_of(record.gaps, 0.0, is_large, mean_w);
    const bool are_many = all.carried_j > max_gaps_fraction * record.energy_j;
    const auto& sum = are_many ? all : large;
    return {{sum.carried_j / record.energy_j / (are_many ? max_gaps_fraction : max_large_gaps_fraction),
             fmt::format("{} gap{} in the power, {:.0f} s in all, the longest {:.0f} s from {:.1f} s: {:.0f} % of the "
                         "energy is interpolated across, and no counter confirms it",
                         sum.gaps, sum.gaps == 1 ? "" : "s", sum.together_s, sum.longest.duration_s,
                         sum.longest.start_s, units::percentage(sum.carried_j, record.energy_j))}};
}

Findings powerless_climb(const PowerRecord& record) {
    Findings findings;
    if (record.altitude_m.empty()) return findings;
    const auto& sorties = record.sorties;
    for (std::size_t s = 0; s < sorties.size(); ++s) {
        const auto flown = record.in_flight[s];
        const auto& lift_off = sorties[s].phases.front();
        if (lift_off.phase != Phase::takeoff || !lift_off.complete || flown.size() < 2) continue;
        const auto power_w = part_of(record.power_w, flown);
        const double idle_w = idle_fraction * quantile_of({power_w.begin(), power_w.end()}, 0.75);
        const auto powered = static_cast<std::size_t>(
            std::ranges::find_if(power_w, [&](double watts) { return watts >= idle_w; }) - power_w.begin());
        if (powered < powerless_samples) continue;
        const auto last_idle = flown.begin + powered - 1;
        const double climbed_m = record.altitude_m[last_idle] - sorties[s].ground_altitude_m;
        findings.push_back(
            {climbed_m, fmt::format("sortie {} climbs to {:.0f} m above its ground from {:.1f} to {:.1f} "
                                    "s without power: was it towed, or is the power logged late?",
                                    sorties[s].number, climbed_m, lift_off.start.time_s, record.time_s[last_idle])});
    }
    return findings;
}

}  // namespace flightwatt::flight
