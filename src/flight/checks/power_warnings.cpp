#include "flight/checks/power_warnings.h"

#include "base/piecewise_linear.h"
#include "base/statistics.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <span>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double doubtful_rest_a = 1.0;
constexpr double doubtful_rest_fraction = 0.05;
constexpr double doubtful_closure_percent = 3.0;
constexpr double doubtful_phase_fraction = 0.10;   // of the phase's energy,
constexpr double doubtful_phase_of_flight = 0.02;  // and of the flight's
constexpr double doubtful_gain_drift = 0.10;
constexpr double resolved_counts = 100.0;  // steps of the counter in a quarter of a flight
constexpr double doubtful_product_part = 0.05;
constexpr double told_gap_fraction = 0.02;  // links drop out for seconds all the time
constexpr double doubtful_gap_fraction = 0.04;
constexpr double doubtful_gaps_fraction = 0.05;  // all together, beyond usual intervals
constexpr double doubtful_silence_fraction = 0.06;
constexpr double max_pack_v = 60.0;        // 14 LiPo cells
constexpr double min_pack_v = 2.5;         // one cell, empty
constexpr double min_voltage_part = 0.55;  // 2.3 V of a cell that began full
constexpr double min_mean_power_w = 3.0;
constexpr double doubtful_drift_fraction = 0.05;  // of the mean current in flight
constexpr double powerless_climb_m = 10.0;
constexpr std::ptrdiff_t powerless_samples = 3;
constexpr double idle_fraction = 0.1;  // of the upper quartile in flight

void warn_of_rest(const PowerCheckInput& input, Warnings& warnings) {
    const auto& idle = input.at_rest;
    if (!idle || input.record.current_a.empty()) return;
    std::vector<double> currents;
    for_each_in_flight(input.record, [&](std::size_t i) { currents.push_back(input.record.current_a[i]); });
    if (currents.empty()) return;
    const double part = std::abs(idle->mean_a) / std::max(std::abs(mean(currents)), 1e-9);
    if (std::abs(idle->mean_a) < doubtful_rest_a && part < doubtful_rest_fraction) return;
    warnings.push_back(
        fmt::format("the current is {:.2f} A at rest on the ground, {} % of the mean in flight: what the electronics "
                    "draw, or an offset of the sensor that its counters share; --correct-idle-offset takes it out",
                    idle->mean_a, percent_of_whole(part)));
}

double counted(const PowerCheckInput& input, const std::vector<double>& counter, double start_s, double end_s) {
    const auto& time_s = input.record.time_s;
    return interpolate_clamped(time_s, counter, end_s) - interpolate_clamped(time_s, counter, start_s);
}

void warn_of_closure(const PowerCheckInput& input, Warnings& warnings) {
    const auto compare = [&](const char* name, const std::optional<double>& closure, double rounding_percent) {
        if (!closure || std::abs(*closure) > max_closure_percent + rounding_percent) return;  // a fault
        if (std::abs(*closure) <= doubtful_closure_percent + rounding_percent) return;
        warnings.push_back(
            fmt::format("what was measured in flight is {:+.1f} % away from the on-board {} counter", *closure, name));
    };
    const auto& report = input.report;
    compare("energy", report.energy_closure_percent, report.energy_rounding_percent);
    compare("charge", report.charge_closure_percent, report.charge_rounding_percent);
}

double measured_wh(const PowerCheckInput& input, double start_s, double end_s) {
    return units::wh_from_joule(integrated(input.record.time_s, input.record.power_w, start_s, end_s));
}

/// A sensor whose gain changes while the whole still agrees with the counter: by quarters of a sortie.
void warn_of_gain_drift(const PowerCheckInput& input, Warnings& warnings) {
    constexpr int quarters = 4;
    const auto& counter_wh = input.record.energy_wh;
    for (const auto& sortie : input.phases.sorties) {
        const double quarter_s = (sortie.end_s() - sortie.start_s()) / quarters;
        double least = std::numeric_limits<double>::infinity();
        double most = -least;
        for (int quarter = 0; quarter < quarters; ++quarter) {
            const double start_s = sortie.start_s() + quarter * quarter_s;
            const double count_wh = counted(input, counter_wh, start_s, start_s + quarter_s);
            if (count_wh < doubtful_phase_fraction * units::wh_from_joule(input.record.energy_j) ||
                count_wh < resolved_counts * input.record.energy_resolution_wh)
                continue;
            const double gain = measured_wh(input, start_s, start_s + quarter_s) / count_wh;
            least = std::min(least, gain);
            most = std::max(most, gain);
        }
        if (most - least <= doubtful_gain_drift) continue;
        warnings.push_back(fmt::format(
            "sortie {}: measured power over the on-board energy counter is {:.2f} to {:.2f} by quarters of the flight: "
            "the gain of its sensor drifts",
            sortie.number, least, most));
    }
}

void warn_of_phases(const PowerCheckInput& input, Warnings& warnings) {
    const auto& closure = input.report.energy_closure_percent;
    if (!closure || std::abs(*closure) > max_closure_percent) return;
    const double resolved_wh = 2.0 * input.record.energy_resolution_wh;
    for (const auto& sortie : input.phases.sorties) {
        for (const auto& span : sortie.phases) {
            const double measured = measured_wh(input, span.start.time_s, span.end.time_s);
            const double count_wh = counted(input, input.record.energy_wh, span.start.time_s, span.end.time_s);
            const double apart_wh = std::abs(measured - count_wh);
            if (apart_wh <= doubtful_phase_fraction * std::abs(count_wh) + resolved_wh ||
                apart_wh <= doubtful_phase_of_flight * units::wh_from_joule(input.record.energy_j)) {
                continue;
            }
            warnings.push_back(fmt::format("{} at {:.0f} s: {:.3f} Wh were measured and {:.3f} Wh counted",
                                           to_string(span.phase), span.start.time_s, measured, count_wh));
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
void warn_of_silence(const PowerCheckInput& input, Warnings& warnings) {
    const auto& time_s = input.record.altitude_time_s;
    const double median_s = median_interval_s(time_s);
    const double gap_s = gap_threshold_s(time_s);
    GapSum sum;
    for (const auto& sortie : input.phases.sorties) {
        for (std::size_t i = 1; i < time_s.size(); ++i) {
            const double interval_s = time_s[i] - time_s[i - 1];
            if (interval_s <= gap_s || time_s[i - 1] < sortie.start_s() || time_s[i] > sortie.end_s()) continue;
            sum.add(time_s[i - 1], interval_s,
                    input.record.energy_j / input.record.duration_s * (interval_s - median_s));
        }
    }
    const double part = sum.carried_j / input.record.energy_j;
    if (part <= doubtful_silence_fraction) return;
    warnings.push_back(fmt::format(
        "{} gaps in the altitude in flight, {:.0f} s in all: no message came, or the clock jumped; {} % of the "
        "energy lies in them, and no counter confirms it",
        sum.gaps, sum.together_s, percent_of_whole(part)));
}

/// A gap that begins or ends a sortie hides when that was: no counter helps. Many short ones add up: of these what is
/// beyond a usual interval.
void warn_of_gaps(const PowerCheckInput& input, Warnings& warnings) {
    const auto& record = input.record;
    const auto& time_s = record.time_s;
    const double median_s = median_interval_s(time_s);
    const double gap_s = gap_threshold_s(time_s);
    const auto& report = input.report;
    const bool is_counted = report.energy_closure_percent || report.charge_closure_percent;
    GapSum all;
    GapSum large;
    for (std::size_t i = 1; i < time_s.size(); ++i) {
        const double interval_s = time_s[i] - time_s[i - 1];
        if (interval_s <= gap_s) continue;
        for (const auto& sortie : input.phases.sorties) {
            if (time_s[i] <= sortie.start_s() || time_s[i - 1] >= sortie.end_s()) continue;
            const bool inside = time_s[i - 1] >= sortie.start_s() && time_s[i] <= sortie.end_s();
            if (inside && is_counted) continue;  // the closure tells
            const double mean_w = std::abs(record.power_w[i - 1] + record.power_w[i]) / 2.0;
            all.add(time_s[i - 1], interval_s, mean_w * (interval_s - median_s));
            if (mean_w * interval_s >= told_gap_fraction * input.record.energy_j)
                large.add(time_s[i - 1], interval_s, mean_w * interval_s);
        }
    }
    if (!is_counted) warn_of_silence(input, warnings);
    const bool many = all.carried_j > doubtful_gaps_fraction * input.record.energy_j;
    if (!many && large.carried_j <= doubtful_gap_fraction * input.record.energy_j) return;
    const auto& told = many ? all : large;
    warnings.push_back(
        fmt::format("{} gap{} in the power, {:.0f} s in all, the longest {:.0f} s from {:.1f} s on: {} % "
                    "of the energy is a straight line across, and no counter confirms it",
                    told.gaps, told.gaps == 1 ? "" : "s", told.together_s, told.longest.duration_s,
                    told.longest.start_s, percent_of_whole(told.carried_j / input.record.energy_j)));
}

/// Devices that report a power of their own beside voltage and current.
void warn_of_device_products(const PowerCheckInput& input, Warnings& warnings) {
    const auto& record = input.record;
    if (!record.power_source.starts_with("ESC") || record.voltage_v.empty() || record.current_a.empty()) return;
    std::vector<double> product_w(record.time_s.size());
    std::ranges::transform(record.voltage_v, record.current_a, product_w.begin(), std::multiplies<>());
    double product_j = 0.0;
    for (const auto& sortie : input.phases.sorties)
        product_j += integrated(record.time_s, product_w, sortie.start_s(), sortie.end_s());
    if (!(product_j > 0.0) || std::abs(input.record.energy_j - product_j) <= doubtful_product_part * product_j) return;
    warnings.push_back(fmt::format(
        "the power of {} makes {:.2f} Wh in flight, its voltage times current {:.2f} Wh ({:+.0f} %): one of them is wrong",
        record.power_source, units::wh_from_joule(input.record.energy_j), units::wh_from_joule(product_j),
        units::percentage(input.record.energy_j - product_j, product_j)));
}

void warn_of_voltage(const PowerCheckInput& input, Warnings& warnings) {
    std::vector<double> voltages;
    if (input.record.voltage_v.empty()) return;
    for_each_in_flight(input.record, [&](std::size_t i) { voltages.push_back(input.record.voltage_v[i]); });
    if (voltages.empty()) return;
    const auto [low, high] = std::ranges::minmax(voltages);
    if (high > max_pack_v) {
        warnings.push_back(
            fmt::format("a voltage of {:.4g} V is that of more than 14 LiPo cells: is its unit V?", high));
    } else if (high < min_pack_v) {
        warnings.push_back(fmt::format("a voltage of {:.4g} V is less than a LiPo cell's: is its unit V?", high));
    } else if (low < min_voltage_part * high) {
        warnings.push_back(fmt::format("the voltage falls to {:.4g} V from {:.4g} V: no pack stands that", low, high));
    }
}

/// Of a current at rest that is another one after a sortie than before: a sensor that drifts.
void warn_of_drift(const PowerCheckInput& input, Warnings& warnings) {
    const auto& current_a = input.record.current_a;
    const auto& rests = input.rests;
    for (std::size_t sortie = 0; sortie < input.record.in_flight.size() && !current_a.empty(); ++sortie) {
        const auto& before = rests[sortie];
        const auto& after = rests[sortie + 1];
        const auto [first, last] = input.record.in_flight[sortie];
        if (!before || !after || first == last) continue;
        const double drift_a = after->mean_a - before->mean_a;
        const double mean_a = mean(std::span(current_a).subspan(first, last - first));
        if (std::abs(drift_a) <= doubtful_drift_fraction * std::abs(mean_a)) continue;
        warnings.push_back(
            fmt::format("the current at rest is {:.2f} A before sortie {} and {:.2f} A after it, the mean "
                        "in flight {:.2f} A: does its sensor drift?",
                        before->mean_a, input.phases.sorties[sortie].number, after->mean_a, mean_a));
    }
}

/// Of a lift-off and 10 m of height without power: it is logged late, or the aircraft was launched by something else.
void warn_of_powerless_climb(const PowerCheckInput& input, Warnings& warnings) {
    const auto& record = input.record;
    if (record.altitude_m.empty()) return;
    const auto& sorties = input.phases.sorties;
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

}  // namespace

Warnings find_power_warnings(const PowerCheckInput& input) {
    Warnings warnings;
    if (input.record.time_s.empty()) return warnings;
    warn_of_rest(input, warnings);
    warn_of_drift(input, warnings);
    warn_of_voltage(input, warnings);
    if (!(input.record.energy_j > 0.0)) return warnings;  // a fault
    warn_of_closure(input, warnings);
    const auto before = warnings.size();
    warn_of_phases(input, warnings);
    const bool is_counted = input.report.energy_closure_percent.has_value();
    if (is_counted && warnings.size() == before) warn_of_gain_drift(input, warnings);
    warn_of_device_products(input, warnings);
    warn_of_gaps(input, warnings);
    warn_of_brief_changes(input, warnings);
    warn_of_power_beside_throttle(input, warnings);
    warnings.insert(warnings.end(), input.samples.warnings.begin(), input.samples.warnings.end());
    warn_of_powerless_climb(input, warnings);
    if (const double mean_w = input.record.energy_j / input.record.duration_s; mean_w < min_mean_power_w) {
        warnings.push_back(
            fmt::format("a mean of {:.3g} W in flight: hardly anything flies on that; is its unit W?", mean_w));
    }
    return warnings;
}

}  // namespace flightwatt::flight
