#include "flight/power_check.h"

#include "base/piecewise_linear.h"
#include "base/statistics.h"
#include "base/units.h"
#include "flight/checks/power_record.h"
#include "flight/checks/power_warnings.h"
#include "flight/phase_statistics.h"
#include "flight/sources/power_source.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

constexpr double faulty_power_difference = 0.10;
constexpr double compared_power_w = 1.0;  // below, rounding and offsets rule
constexpr double faulty_counter_return = 0.05;

/// The autopilot switches loads on the ground too (a burst after landing): the middle half of the samples is idle.
std::optional<IdleCurrent> idle_current(const std::vector<double>& current_a, const std::vector<std::size_t>& resting) {
    constexpr std::size_t enough = 10;
    if (current_a.empty() || resting.size() < enough) return std::nullopt;
    std::vector<double> values(resting.size());
    std::ranges::transform(resting, values.begin(), [&](auto i) { return current_a[i]; });
    const double middle = median_high(values);
    std::vector<double> distances(values.size());
    std::ranges::transform(values, distances.begin(), [&](double value) { return std::abs(value - middle); });
    const double reach = 5.0 * std::max(median_high(std::move(distances)), 1e-6);  // beyond 3 sigma is no idling
    std::erase_if(values, [&](double value) { return std::abs(value - middle) > reach; });
    IdleCurrent idle;
    double squares = 0.0;
    for (const double value : values) {
        ++idle.samples;
        const double delta = value - idle.mean_a;
        idle.mean_a += delta / static_cast<double>(idle.samples);
        squares += delta * (value - idle.mean_a);
    }
    if (idle.samples > 1) idle.sd_a = std::sqrt(squares / static_cast<double>(idle.samples - 1));
    return idle;
}

/// At rest before the first sortie, between it and the next, ..., after the last.
std::vector<std::optional<IdleCurrent>> idle_currents(const PowerRecord& record,
                                                      const std::vector<std::size_t>& resting) {
    std::vector<std::optional<IdleCurrent>> currents;
    auto begin = resting.begin();
    for (std::size_t sortie = 0; sortie <= record.in_flight.size(); ++sortie) {
        const auto end = sortie == record.in_flight.size()
                             ? resting.end()
                             : std::lower_bound(begin, resting.end(), record.in_flight[sortie].first);
        currents.push_back(idle_current(record.current_a, {begin, end}));
        begin = end;
    }
    return currents;
}

/// How far a rising counter ran back in flight, over what it counted there. On the ground a pack may be changed.
double counter_return(const std::vector<double>& counter, const std::vector<SampleRange>& flown) {
    if (counter.empty()) return 0.0;
    double returned = 0.0;
    double counted = 0.0;
    for (const auto& [first, last] : flown) {
        for (auto i = first + 1; i < last; ++i) {
            const double step = counter[i] - counter[i - 1];
            (step < 0.0 ? returned : counted) += std::abs(step);
        }
    }
    return counted > 0.0 ? returned / counted : returned > 0.0 ? 1.0 : 0.0;
}

/// Median of |power - voltage * current| over the product, where that is large enough; 0 if it cannot be compared, as
/// where devices have voltages of their own.
double power_difference(const PowerRecord& record) {
    if (record.is_sum_of_circuits || record.voltage_v.empty() || record.current_a.empty()) return 0.0;
    std::vector<double> differences;
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        const double product = record.voltage_v[i] * record.current_a[i];
        if (std::abs(product) < compared_power_w) continue;
        differences.push_back(std::abs(record.power_w[i] - product) / std::abs(product));
    }
    return differences.empty() ? 0.0 : median_high(std::move(differences));
}

bool is_constant_in_flight(const PowerRecord& record) {
    constexpr std::size_t enough = 10;
    return std::any_of(record.in_flight.begin(), record.in_flight.end(), [&](const SampleRange& flown) {
        const auto power_w = std::span(record.power_w).subspan(flown.first, flown.last - flown.first);
        return power_w.size() >= enough && std::ranges::count(power_w, power_w.front()) == std::ssize(power_w);
    });
}

/// Of the samples' power, whose mean has the same sign.
double power_sum_in_flight_w(const PowerRecord& record) {
    double sum_w = 0.0;
    for (const auto& [first, last] : record.in_flight)
        for (auto i = first; i < last; ++i) sum_w += record.power_w[i];
    return sum_w;
}

std::vector<std::string> power_faults_of(const PowerRecord& record, std::vector<std::string> faults,
                                         const PowerReport& report) {
    const auto add = [&](std::string text) { faults.push_back(std::move(text)); };
    if (const double apart = power_difference(record); apart > faulty_power_difference) {
        add(fmt::format("power is {:.0f} % away from voltage times current", apart * units::percent_per_whole));
    }
    for (const auto& [name, counter] :
         {std::pair{"energy", &record.energy_wh}, std::pair{"charge", &record.charge_ah}}) {
        if (const double part = counter_return(*counter, record.in_flight); part > faulty_counter_return) {
            add(fmt::format("the {} counter ran back by {:.0f} % of what it counted in flight", name,
                            part * units::percent_per_whole));
        }
    }
    for (const auto& [name, closure, rounding_percent] :
         {std::tuple{"energy", report.energy_closure_percent, report.energy_rounding_percent},
          std::tuple{"charge", report.charge_closure_percent, report.charge_rounding_percent}}) {
        if (closure && std::abs(*closure) > max_closure_percent + rounding_percent) {
            add(fmt::format("what was measured is {:+.0f} % away from the on-board {} counter", *closure, name));
        }
    }
    if (power_sum_in_flight_w(record) < 0.0) add("power is negative on average in flight");
    if (is_constant_in_flight(record)) add("power does not change in flight");
    return faults;
}

struct Closure {
    std::optional<double> percent;  ///< integral over counter, less 100 %; absent without a counter that counted
    double rounding_percent = 0.0;
};

/// Over all sorties. `resolution`: of the counter.
Closure closure_of(const std::vector<double>& time_s, const std::vector<double>& rate,
                   const std::vector<double>& counter, double resolution, const FlightPhases& phases) {
    if (rate.empty() || counter.empty()) return {};
    double integral = 0.0;
    double difference = 0.0;
    for (const auto& sortie : phases.sorties) {
        integral += integrated(time_s, rate, sortie.start_s(), sortie.end_s()) / units::seconds_per_hour;
        difference += interpolate_clamped(time_s, counter, sortie.end_s()) -
                      interpolate_clamped(time_s, counter, sortie.start_s());
    }
    if (!(difference > 0.0)) return {};
    return {(integral / difference - 1.0) * units::percent_per_whole, units::percentage(2.0 * resolution, difference)};
}

/// A log that goes on without power: what is flown then is not seen.
void warn_of_short_record(const SelectedTracks& tracks, const std::vector<double>& time_s,
                          std::vector<std::string>& warnings) {
    constexpr double min_s = 30.0;
    constexpr double min_part = 0.05;
    const auto& altitude = tracks["altitude_m"];
    if (altitude.empty() || time_s.empty()) return;
    const double limit_s = std::max(min_s, min_part * (altitude.time_s.back() - altitude.time_s.front()));
    const auto warn = [&](const char* way, const char* when, double power_s, double altitude_s) {
        if (std::abs(power_s - altitude_s) <= limit_s) return;
        warnings.push_back(
            fmt::format("power is logged {} {:.0f} s, altitude {} {:.0f} s: what was flown {} is not seen", way,
                        power_s, way, altitude_s, when));
    };
    if (time_s.front() > altitude.time_s.front()) warn("from", "before", time_s.front(), altitude.time_s.front());
    if (time_s.back() < altitude.time_s.back()) warn("to", "after", time_s.back(), altitude.time_s.back());
}

}  // namespace

PowerReport check_power_record(const SelectedTracks& tracks, const FlightPhases& phases,
                               const SegmentationOptions& options) {
    PowerReport report;
    report.origin = tracks.series().current_origin;
    const auto record = make_power_record(tracks, phases);
    const auto& time_s = record.time_s;
    const auto resting = resting_samples(record, phases.rests, options);
    const auto at_rest = idle_current(record.current_a, resting);
    const bool motor_known = !record.throttle_percent.empty();
    if (motor_known) report.idle = at_rest;
    const auto energy = closure_of(time_s, record.power_w, record.energy_wh, record.energy_resolution_wh, phases);
    const auto charge = closure_of(time_s, record.current_a, record.charge_ah, record.charge_resolution_ah, phases);
    report.energy_closure_percent = energy.percent;
    report.energy_rounding_percent = energy.rounding_percent;
    report.charge_closure_percent = charge.percent;
    report.charge_rounding_percent = charge.rounding_percent;
    const double gap_s = gap_threshold_s(time_s);
    for (const auto& [first, last] : record.in_flight) {
        for (auto i = first + 1; i < last; ++i) {
            const double interval_s = time_s[i] - time_s[i - 1];
            if (interval_s > gap_s) report.gaps.push_back({time_s[i - 1], interval_s});
        }
    }
    const auto motor_off = motor_known ? resting : std::vector<std::size_t>{};
    const auto samples = apply_sample_rules(record, motor_off);
    report.power_faults = power_faults_of(record, samples.faults, report);
    report.warnings = find_power_warnings({record, phases, samples, report, at_rest, idle_currents(record, resting)});
    warn_of_short_record(tracks, time_s, report.warnings);
    return report;
}

std::string describe_power_faults(const std::vector<std::string>& power_faults) {
    return fmt::format("power faults: {}; --keep overrides this", fmt::join(power_faults, ", "));
}

void correct_idle_offset(FlightSeries& series, const std::optional<IdleCurrent>& idle) {
    if (!idle) return;
    auto power = power_track(series);
    auto current = select_track(series, "current_a");
    const auto voltage_v = sample_selected_track(series, "voltage_v", power.time_s);
    const auto current_a = resample(current, power.time_s);
    for (std::size_t i = 0; i < power.time_s.size(); ++i) {
        const double volts = !voltage_v.empty()    ? voltage_v[i]
                             : current_a[i] != 0.0 ? power.value[i] / current_a[i]
                                                   : 0.0;
        power.value[i] -= idle->mean_a * volts;
    }
    current.time_s = power.time_s;
    current.value = current_a;
    for (auto& value : current.value) value -= idle->mean_a;
    // What was not chosen goes, since its offset is not known; what was said of the choice stays.
    const auto before = warnings_of(series);
    if (energy_and_power_are_swapped(series)) replace_track(series, select_track(series, "charge_ah"));
    replace_track(series, std::move(power));
    replace_track(series, std::move(current));
    const auto after = warnings_of(series);
    for (const auto& warning : before) {
        if (std::find(after.begin(), after.end(), warning) == after.end()) series.notes.push_back(warning);
    }
    series.notes.push_back(
        fmt::format("the idle current of {:.4f} A ({} samples at rest) was taken out", idle->mean_a, idle->samples));
}

}  // namespace flightwatt::flight
