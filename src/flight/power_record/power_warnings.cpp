#include "flight/power_record/power_warnings.h"

#include "base/piecewise_linear.h"
#include "base/statistics.h"
#include "base/units.h"
#include "flight/phase_statistics.h"
#include "flight/power_record/flown_power.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double doubtful_rest_a = 1.0;
constexpr double doubtful_rest_part = 0.05;
constexpr double doubtful_closure_percent = 3.0;
constexpr double doubtful_phase_part = 0.10;       // of the phase's energy,
constexpr double doubtful_phase_of_flight = 0.02;  // and of the flight's
constexpr double told_gap_part = 0.02;             // links drop out for seconds all the time
constexpr double doubtful_gap_part = 0.04;
constexpr double doubtful_gaps_part = 0.05;  // all together, beyond usual intervals
constexpr double doubtful_silence_part = 0.06;
constexpr double doubtful_negative_part = 0.02;
constexpr std::size_t standing_samples = 30;
constexpr double doubtful_standing_part = 0.04;
constexpr double doubtful_highest_part = 0.05;  // of the samples
constexpr double powerless_throttle_percent = 30.0;
constexpr double powerless_part = 0.05;           // of the median power at such a throttle
constexpr double doubtful_powerless_part = 0.15;  // of the samples at such a throttle
constexpr double greatest_pack_v = 60.0;          // 14 LiPo cells
constexpr double least_pack_v = 2.5;              // one cell, empty
constexpr double least_voltage_part = 0.55;       // 2.3 V of a cell that began full
constexpr double least_mean_power_w = 3.0;
constexpr double doubtful_outside_part = 0.05;
constexpr double longest_run_up_s = 30.0;

void warn_of_rest(const FlownPower& flown, Warnings& warnings) {
    const auto& idle = flown.evidence.at_rest;
    if (!idle || flown.record.current_a.empty()) return;
    std::vector<double> currents;
    for_each_flown(flown.record, [&](std::size_t i) { currents.push_back(flown.record.current_a[i]); });
    if (currents.empty()) return;
    const double part = std::abs(idle->mean_a) / std::max(std::abs(mean(currents)), 1e-9);
    if (std::abs(idle->mean_a) < doubtful_rest_a && part < doubtful_rest_part) return;
    warnings.push_back(
        fmt::format("the current is {:.2f} A at rest on the ground, {} % of the mean in flight: what the electronics "
                    "draw, or an offset of the sensor that its counters share; --correct-idle-offset takes it out",
                    idle->mean_a, percent_of_whole(part)));
}

/// The least step of a counter in flight; 0 if it does not move.
double counter_resolution(const PowerRecord& record, const std::vector<double>& counter) {
    double least = 0.0;
    for (const auto& [first, last] : record.flown) {
        for (auto i = first + 1; i < last; ++i) {
            const double step = std::abs(counter[i] - counter[i - 1]);
            if (step > 1e-9 && (least == 0.0 || step < least)) least = step;
        }
    }
    return least;
}

double counted(const FlownPower& flown, const std::vector<double>& counter, double start_s, double end_s) {
    const auto& time_s = flown.record.time_s;
    return interpolate_clamped(time_s, counter, end_s) - interpolate_clamped(time_s, counter, start_s);
}

void warn_of_closure(const FlownPower& flown, Warnings& warnings) {
    const auto& record = flown.record;
    const auto judge = [&](const char* name, const std::optional<double>& closure, const std::vector<double>& counter) {
        if (!closure || std::abs(*closure) > faulty_closure_percent) return;
        double difference = 0.0;
        for (const auto& sortie : flown.evidence.phases.sorties)
            difference += counted(flown, counter, sortie.start_s(), sortie.end_s());
        const double rounding_percent = units::percent_of(2.0 * counter_resolution(record, counter), difference);
        if (std::abs(*closure) <= doubtful_closure_percent + rounding_percent) return;
        warnings.push_back(
            fmt::format("what was measured in flight is {:+.1f} % away from the on-board {} counter", *closure, name));
    };
    judge("energy", flown.evidence.report.energy_closure_percent, record.energy_wh);
    judge("charge", flown.evidence.report.charge_closure_percent, record.charge_ah);
}

void warn_of_phases(const FlownPower& flown, Warnings& warnings) {
    const auto& closure = flown.evidence.report.energy_closure_percent;
    if (!closure || std::abs(*closure) > doubtful_closure_percent) return;  // the whole is told of
    for (const auto& sortie : flown.evidence.phases.sorties) {
        for (const auto& span : sortie.phases) {
            const double measured_j =
                integrated(flown.record.time_s, flown.record.power_w, span.start.time_s, span.end.time_s);
            const double counter_j =
                units::joule_from_wh(counted(flown, flown.record.energy_wh, span.start.time_s, span.end.time_s));
            const double apart_j = std::abs(measured_j - counter_j);
            if (apart_j <= doubtful_phase_part * std::abs(counter_j) ||
                apart_j <= doubtful_phase_of_flight * flown.energy_j) {
                continue;
            }
            warnings.push_back(fmt::format("{} at {:.0f} s: {:.3f} Wh were measured and {:.3f} Wh counted",
                                           to_string(span.phase), span.start.time_s, units::wh_from_joule(measured_j),
                                           units::wh_from_joule(counter_j)));
        }
    }
}

/// Gaps together, and the energy that a straight line across them adds.
struct GapSum {
    std::size_t gaps = 0;
    double carried_j = 0.0;
    double together_s = 0.0;
    PowerGap longest = {};

    void add(double start_s, double interval_s, double energy_j) {
        ++gaps;
        carried_j += energy_j;
        together_s += interval_s;
        if (interval_s > longest.duration_s) longest = {start_s, interval_s};
    }
};

/// Where the altitude, which comes more often, pauses too, no message came, or the clock jumped.
void warn_of_silence(const FlownPower& flown, Warnings& warnings) {
    const auto& time_s = flown.record.altitude_time_s;
    const double usual_s = usual_interval_s(time_s);
    const double gap_s = gap_threshold_s(time_s);
    GapSum sum;
    for (const auto& sortie : flown.evidence.phases.sorties) {
        for (std::size_t i = 1; i < time_s.size(); ++i) {
            const double interval_s = time_s[i] - time_s[i - 1];
            if (interval_s <= gap_s || time_s[i - 1] < sortie.start_s() || time_s[i] > sortie.end_s()) continue;
            sum.add(time_s[i - 1], interval_s, flown.energy_j / flown.duration_s * (interval_s - usual_s));
        }
    }
    const double part = sum.carried_j / flown.energy_j;
    if (part <= doubtful_silence_part) return;
    warnings.push_back(fmt::format(
        "{} gaps in the altitude in flight, {:.0f} s in all: no message came, or the clock jumped; {} % of the "
        "energy lies in them, and no counter confirms it",
        sum.gaps, sum.together_s, percent_of_whole(part)));
}

/// A gap that begins or ends a sortie hides when that was: no counter helps. Many short ones add up: of these what is
/// beyond a usual interval.
void warn_of_gaps(const FlownPower& flown, Warnings& warnings) {
    const auto& record = flown.record;
    const auto& time_s = record.time_s;
    const double usual_s = usual_interval_s(time_s);
    const double gap_s = gap_threshold_s(time_s);
    const auto& report = flown.evidence.report;
    const bool is_counted = report.energy_closure_percent || report.charge_closure_percent;
    GapSum all;
    GapSum large;
    for (std::size_t i = 1; i < time_s.size(); ++i) {
        const double interval_s = time_s[i] - time_s[i - 1];
        if (interval_s <= gap_s) continue;
        for (const auto& sortie : flown.evidence.phases.sorties) {
            if (time_s[i] <= sortie.start_s() || time_s[i - 1] >= sortie.end_s()) continue;
            const bool inside = time_s[i - 1] >= sortie.start_s() && time_s[i] <= sortie.end_s();
            if (inside && is_counted) continue;  // the closure tells
            const double mean_w = std::abs(record.power_w[i - 1] + record.power_w[i]) / 2.0;
            all.add(time_s[i - 1], interval_s, mean_w * (interval_s - usual_s));
            if (mean_w * interval_s >= told_gap_part * flown.energy_j)
                large.add(time_s[i - 1], interval_s, mean_w * interval_s);
        }
    }
    if (!is_counted) warn_of_silence(flown, warnings);
    const bool many = all.carried_j > doubtful_gaps_part * flown.energy_j;
    if (!many && large.carried_j <= doubtful_gap_part * flown.energy_j) return;
    const auto& told = many ? all : large;
    warnings.push_back(
        fmt::format("{} gap{} in the power, {:.0f} s in all, the longest {:.0f} s from {:.1f} s on: {} % "
                    "of the energy is a straight line across, and no counter confirms it",
                    told.gaps, told.gaps == 1 ? "" : "s", told.together_s, told.longest.duration_s,
                    told.longest.start_s, percent_of_whole(told.carried_j / flown.energy_j)));
}

bool runs_by_throttle(const PowerRecord& record, std::size_t i) {
    return !record.throttle_percent.empty() && record.throttle_percent[i] > powerless_throttle_percent;
}

void warn_of_standing(const FlownPower& flown, Warnings& warnings) {
    const auto& record = flown.record;
    const auto& time_s = record.time_s;
    const auto& power_w = record.power_w;
    for (const auto& [first, last] : record.flown) {
        for (auto begin = first; begin < last;) {
            auto end = begin + 1;
            while (end < last && power_w[end] == power_w[begin]) ++end;
            const bool is_off = power_w[begin] == 0.0 && !runs_by_throttle(record, (begin + end) / 2);
            const double lasts_s = is_off ? 0.0 : time_s[end - 1] - time_s[begin];
            const double part = std::max(power_w[begin] * lasts_s / flown.energy_j, lasts_s / flown.duration_s);
            if (end - begin >= standing_samples && end - begin < last - first && part > doubtful_standing_part) {
                warnings.push_back(
                    fmt::format("power stands still at {:.2f} W from {:.1f} to {:.1f} s, {} % of the flight",
                                power_w[begin], time_s[begin], time_s[end - 1], percent_of_whole(part)));
            }
            begin = end;
        }
    }
}

/// A current that stands still gives a power that moves with the voltage; one that stops at its highest is saturated.
void warn_of_standing_current(const FlownPower& flown, Warnings& warnings) {
    const auto& record = flown.record;
    const auto& current_a = record.current_a;
    if (current_a.empty()) return;
    std::size_t standing = 0;
    std::size_t samples = 0;
    double highest_a = 0.0;
    for (const auto& [first, last] : record.flown) {
        samples += last - first;
        for (auto begin = first; begin < last;) {
            auto end = begin + 1;
            while (end < last && current_a[end] == current_a[begin]) ++end;
            if (current_a[begin] > 0.0 && end - begin >= standing_samples) standing += end - begin;
            highest_a = std::max(highest_a, current_a[begin]);
            begin = end;
        }
    }
    std::size_t at_highest = 0;
    for_each_flown(record, [&](std::size_t i) { at_highest += current_a[i] == highest_a ? 1 : 0; });
    const auto part_of = [&](std::size_t count) { return static_cast<double>(count) / static_cast<double>(samples); };
    if (part_of(standing) > doubtful_standing_part) {
        warnings.push_back(
            fmt::format("the current stands still in {} % of the samples in flight: a sensor that hangs?",
                        percent_of_whole(part_of(standing))));
    } else if (at_highest >= standing_samples && part_of(at_highest) > doubtful_highest_part) {
        warnings.push_back(
            fmt::format("the current is {:.4g} A, its highest, in {} % of the samples in flight: does its "
                        "sensor reach further?",
                        highest_a, percent_of_whole(part_of(at_highest))));
    }
}

void warn_of_negative(const FlownPower& flown, Warnings& warnings) {
    const auto& record = flown.record;
    double negative_j = 0.0;
    std::size_t samples = 0;
    for_each_flown(record, [&](std::size_t i) {
        if (record.power_w[i] >= 0.0 || i == 0 || i + 1 >= record.power_w.size()) return;
        negative_j -= record.power_w[i] * (record.time_s[i + 1] - record.time_s[i - 1]) / 2.0;
        ++samples;
    });
    if (negative_j <= doubtful_negative_part * flown.energy_j) return;
    warnings.push_back(fmt::format("power is negative in {} samples in flight, {} % of the energy", samples,
                                   percent_of_whole(negative_j / flown.energy_j)));
}

void warn_of_powerless_throttle(const FlownPower& flown, Warnings& warnings) {
    const auto& record = flown.record;
    if (record.throttle_percent.empty()) return;
    std::vector<double> powers;
    for_each_flown(record, [&](std::size_t i) {
        if (record.throttle_percent[i] > powerless_throttle_percent) powers.push_back(std::abs(record.power_w[i]));
    });
    if (powers.size() < standing_samples) return;
    auto sorted = powers;
    std::ranges::sort(sorted);
    const double limit_w = powerless_part * quantile(sorted, 0.75);
    const auto without = std::ranges::count_if(powers, [&](double power) { return power <= limit_w; });
    const double part = static_cast<double>(without) / static_cast<double>(powers.size());
    if (part <= doubtful_powerless_part) return;
    warnings.push_back(fmt::format("no power in {} % of the samples in flight with more than {:.0f} % throttle",
                                   percent_of_whole(part), powerless_throttle_percent));
}

/// Run-ups take some seconds. What takes longer was flown where the altitude does not show it.
void warn_of_power_outside(const FlownPower& flown, Warnings& warnings) {
    const auto& record = flown.record;
    const auto& time_s = record.time_s;
    const double longest_s = gap_threshold_s(time_s);
    double outside_j = 0.0;
    double outside_s = 0.0;
    auto sortie = record.flown.begin();
    for (std::size_t i = 1; i < time_s.size(); ++i) {
        while (sortie != record.flown.end() && i >= sortie->last) ++sortie;
        const bool is_flown = sortie != record.flown.end() && i >= sortie->first;
        if (is_flown || !runs_by_throttle(record, i)) continue;
        const double interval_s = std::min(time_s[i] - time_s[i - 1], longest_s);
        outside_j += record.power_w[i] * interval_s;
        outside_s += interval_s;
    }
    const double part = outside_j / flown.energy_j;
    if (part <= doubtful_outside_part || outside_s <= longest_run_up_s) return;
    warnings.push_back(
        fmt::format("{:.3f} Wh, {} % of the energy in flight, were drawn outside of it with more than "
                    "{:.0f} % throttle: a long run-up, or is the altitude wrong?",
                    units::wh_from_joule(outside_j), percent_of_whole(part), powerless_throttle_percent));
}

void warn_of_voltage(const FlownPower& flown, Warnings& warnings) {
    std::vector<double> voltages;
    if (flown.record.voltage_v.empty()) return;
    for_each_flown(flown.record, [&](std::size_t i) { voltages.push_back(flown.record.voltage_v[i]); });
    if (voltages.empty()) return;
    const auto [low, high] = std::ranges::minmax(voltages);
    if (high > greatest_pack_v) {
        warnings.push_back(
            fmt::format("a voltage of {:.4g} V is that of more than 14 LiPo cells: is its unit V?", high));
    } else if (high < least_pack_v) {
        warnings.push_back(fmt::format("a voltage of {:.4g} V is less than a LiPo cell's: is its unit V?", high));
    } else if (low < least_voltage_part * high) {
        warnings.push_back(fmt::format("the voltage falls to {:.4g} V from {:.4g} V: no pack stands that", low, high));
    }
}

}  // namespace

std::vector<std::string> power_warnings_of(const PowerEvidence& evidence) {
    Warnings warnings;
    if (evidence.record.time_s.empty()) return warnings;
    FlownPower flown{evidence, evidence.record};
    for (const auto& sortie : evidence.phases.sorties) {
        flown.energy_j += integrated(evidence.record.time_s, evidence.record.power_w, sortie.start_s(), sortie.end_s());
        flown.duration_s += sortie.end_s() - sortie.start_s();
    }
    warn_of_rest(flown, warnings);
    warn_of_drift(flown, warnings);
    warn_of_voltage(flown, warnings);
    if (!(flown.energy_j > 0.0)) return warnings;  // a fault
    warn_of_closure(flown, warnings);
    warn_of_phases(flown, warnings);
    warn_of_gaps(flown, warnings);
    warn_of_brief_changes(flown, warnings);
    warn_of_power_beside_throttle(flown, warnings);
    warn_of_standing(flown, warnings);
    warn_of_standing_current(flown, warnings);
    warn_of_negative(flown, warnings);
    warn_of_powerless_throttle(flown, warnings);
    warn_of_power_outside(flown, warnings);
    warn_of_powerless_climb(flown, warnings);
    if (const double mean_w = flown.energy_j / flown.duration_s; mean_w < least_mean_power_w) {
        warnings.push_back(
            fmt::format("a mean of {:.3g} W in flight: hardly anything flies on that; is its unit W?", mean_w));
    }
    return warnings;
}

}  // namespace flightwatt::flight
