#include "flight/checks/power_record.h"

#include "base/statistics.h"
#include "base/units.h"
#include "flight/checks/runs.h"
#include "flight/sources/device_sum.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double open_throttle_percent = 30.0;
constexpr double loaded_rest_a = 5.0;
constexpr double powerless_fraction = 0.05;  // of the upper quartile of the power at an open throttle
constexpr double gliding_sink_m_per_s = 0.5;

enum class Where { flight, rest, neither };

/// The samples of a record as the rules see them.
struct Samples {
    const PowerRecord& record;
    std::vector<Where> where;
    std::vector<double> step_s;  ///< for which each sample counts: half of both intervals, a gap's length at most
    double powerless_w = 0.0;    ///< no more is hardly anything, with an open throttle
    double max_a = 0.0;          ///< in flight

    bool in_flight(std::size_t i) const { return where[i] == Where::flight; }
    bool is_at_rest(std::size_t i) const { return where[i] == Where::rest; }
    bool has_current() const { return !record.current_a.empty(); }
    bool has_throttle() const { return !record.throttle_percent.empty(); }
    bool is_open(std::size_t i) const { return has_throttle() && record.throttle_percent[i] > open_throttle_percent; }
    bool is_shut(std::size_t i) const { return has_throttle() && !is_open(i); }
    /// Whether a run sinks as an aircraft does that glides.
    bool sinks(const SampleRange& run) const {
        if (record.altitude_m.empty()) return true;
        const double sunk_m = record.altitude_m[run.first] - record.altitude_m[run.last - 1];
        return sunk_m > gliding_sink_m_per_s * (record.time_s[run.last - 1] - record.time_s[run.first]);
    }
};

using Test = bool (*)(const Samples&, std::size_t);

constexpr Test always = [](const Samples&, std::size_t) { return true; };
constexpr Test in_flight = [](const Samples& s, std::size_t i) { return s.in_flight(i); };

/// Of what a rule's share is.
enum class Share { samples, time, energy, time_or_energy };
enum class Consequence { warning, fault };

/// Among the samples of which `applies` is true, those in runs of which `holds` is.
struct SampleRule {
    /// Of percent, samples, lasts_s, energy_wh, source, max_a; from_s, to_s, power_w of the longest run.
    const char* text;
    Test applies = in_flight;
    Test holds;
    Test continues = always;     ///< a run ends where it is false of a sample and the one before it
    std::size_t least_run = 1;   ///< samples, from which a run counts
    double least_level_s = 0.0;  ///< from so long on a run counts, and if it does not sink
    std::size_t min_samples = 0;
    double min_s = 0.0;  ///< of all runs
    Share share = Share::samples;
    double limit;  ///< of the share: reported above it
    Consequence consequence = Consequence::warning;
    bool unless_previous = false;  ///< not where the rule before was reported
};

constexpr std::size_t standing = 30;

/// Every doubt that could hide 5 % of the energy is reported (docs/methods.md says why each limit is what it is).
constexpr SampleRule rules[] = {
    {.text = "more than 5 A in {percent:.0f} % of the samples on the ground with the motor off",
     .applies = [](const Samples& s, std::size_t i) { return s.is_at_rest(i) && s.has_current(); },
     .holds = [](const Samples& s, std::size_t i) { return std::abs(s.record.current_a[i]) > loaded_rest_a; },
     .min_samples = 10,
     .limit = 0.10,
     .consequence = Consequence::fault},
    {.text = "power stands still at {power_w:.2f} W from {from_s:.1f} to {to_s:.1f} s, {percent:.0f} % of the flight",
     .holds = [](const Samples& s, std::size_t i) { return s.record.power_w[i] != 0.0 || s.is_open(i); },
     .continues = [](const Samples& s, std::size_t i) { return s.record.power_w[i] == s.record.power_w[i - 1]; },
     .least_run = standing,
     .share = Share::time_or_energy,
     .limit = 0.04},
    {.text = "the current stands still in {percent:.0f} % of the samples in flight: a sensor that hangs?",
     .holds = [](const Samples& s, std::size_t i) { return s.has_current() && s.record.current_a[i] > 0.0; },
     .continues = [](const Samples& s, std::size_t i) { return s.record.current_a[i] == s.record.current_a[i - 1]; },
     .least_run = standing,
     .limit = 0.04},
    {.text = "the current is {highest_a:.4g} A, its highest, in {percent:.0f} % of the samples in flight: does its "
             "sensor reach further?",
     .holds = [](const Samples& s, std::size_t i) { return s.has_current() && s.record.current_a[i] == s.max_a; },
     .min_samples = standing,
     .limit = 0.05,
     .unless_previous = true},
    {.text = "{source} is 0 for {lasts_s:.0f} s in flight without a descent, the longest from {from_s:.0f} s on: "
             "{percent:.0f} % of the flight has no power",
     .holds = [](const Samples& s, std::size_t i) { return s.record.power_w[i] == 0.0 && !s.is_shut(i); },
     .least_level_s = 5.0,
     .share = Share::time,
     .limit = 0.02},
    {.text = "power is negative in {samples} samples in flight, {percent:.0f} % of the energy",
     .holds = [](const Samples& s, std::size_t i) { return s.record.power_w[i] < 0.0; },
     .share = Share::energy,
     .limit = 0.02},
    {.text = "no power in {percent:.0f} % of the samples in flight with more than 30 % throttle",
     .applies = [](const Samples& s, std::size_t i) { return s.in_flight(i) && s.is_open(i); },
     .holds = [](const Samples& s, std::size_t i) { return std::abs(s.record.power_w[i]) <= s.powerless_w; },
     .min_samples = 5,
     .limit = 0.15},
    {.text = "{energy_wh:.3f} Wh, {percent:.0f} % of the energy in flight, were drawn outside of it with more than "
             "30 % throttle: a long run-up, or is the altitude wrong?",
     .applies = [](const Samples& s, std::size_t i) { return !s.in_flight(i); },
     .holds = [](const Samples& s, std::size_t i) { return s.is_open(i); },
     .min_s = 30.0,
     .share = Share::energy,
     .limit = 0.05},
};

/// What a rule found.
struct Found {
    std::size_t applied = 0;
    std::size_t samples = 0;
    double lasts_s = 0.0;
    double energy_j = 0.0;
    SampleRange longest{0, 0};
};

Found scan(const SampleRule& rule, const Samples& samples) {
    const auto& record = samples.record;
    const auto count = record.time_s.size();
    Found found;
    for (std::size_t i = 0; i < count; ++i) found.applied += rule.applies(samples, i) ? 1 : 0;
    const auto joins = [&](std::size_t i) { return rule.applies(samples, i) && rule.holds(samples, i); };
    const auto continues = [&](std::size_t i) { return rule.continues(samples, i); };
    for (const auto& run : runs_of({0, count}, joins, continues)) {
        const double run_s = record.time_s[run.last - 1] - record.time_s[run.first];
        if (run.size() < rule.least_run || run_s < rule.least_level_s) continue;
        if (rule.least_level_s > 0.0 && samples.sinks(run)) continue;
        found.samples += run.size();
        for (auto i = run.first; i < run.last; ++i) {
            found.lasts_s += samples.step_s[i];
            found.energy_j += std::abs(record.power_w[i]) * samples.step_s[i];
        }
        if (run.size() > found.longest.size()) found.longest = run;
    }
    return found;
}

double share_of(const SampleRule& rule, const Found& found, const PowerRecord& record) {
    const double of_time = found.lasts_s / record.duration_s;
    const double of_energy = found.energy_j / record.energy_j;
    switch (rule.share) {
        case Share::samples:
            return static_cast<double>(found.samples) / static_cast<double>(found.applied);
        case Share::time:
            return of_time;
        case Share::energy:
            return of_energy;
        case Share::time_or_energy:
            return std::max(of_time, of_energy);
    }
    return 0.0;
}

Samples samples_of(const PowerRecord& record, const std::vector<std::size_t>& resting) {
    const auto count = record.time_s.size();
    Samples samples{record, std::vector(count, Where::neither), std::vector<double>(count)};
    for (const auto i : resting) samples.where[i] = Where::rest;
    for (const auto& [first, last] : record.in_flight)
        std::fill(samples.where.begin() + static_cast<std::ptrdiff_t>(first),
                  samples.where.begin() + static_cast<std::ptrdiff_t>(last), Where::flight);
    const double max_s = gap_threshold_s(record.time_s);
    for (std::size_t i = 1; i < count; ++i) {
        const double half_s = 0.5 * std::min(record.time_s[i] - record.time_s[i - 1], max_s);
        samples.step_s[i - 1] += half_s;
        samples.step_s[i] += half_s;
    }
    std::vector<double> running_w;
    for (std::size_t i = 0; i < count; ++i) {
        if (!samples.in_flight(i)) continue;
        if (samples.is_open(i)) running_w.push_back(std::abs(record.power_w[i]));
        if (samples.has_current()) samples.max_a = std::max(samples.max_a, record.current_a[i]);
    }
    std::ranges::sort(running_w);
    if (!running_w.empty()) samples.powerless_w = powerless_fraction * quantile(running_w, 0.75);
    return samples;
}

/// The decimal place that a counter is rounded to, from 1 down to a millionth: the first of which all its values are
/// multiples. However seldom it is logged, that is how well it is known.
double resolution_of(const Track& counter) {
    constexpr double finest = 1e-6;
    constexpr double logged_digits = 1e-6;
    const auto is_multiple = [](double value, double unit) {
        const double units = value / unit;
        return std::abs(units - std::round(units)) <= logged_digits * std::max(1.0, std::abs(units));
    };
    double unit = 1.0;
    while (unit > finest && !std::ranges::all_of(counter.value, [&](double value) { return is_multiple(value, unit); }))
        unit /= 10.0;
    return unit;
}

}  // namespace

SampleFindings apply_sample_rules(const PowerRecord& record, const std::vector<std::size_t>& resting) {
    SampleFindings findings;
    const auto samples = samples_of(record, resting);
    bool was_reported = false;
    for (const auto& rule : rules) {
        if (rule.consequence == Consequence::warning && !(record.energy_j > 0.0)) continue;  // a fault
        const auto found = scan(rule, samples);
        const double share = found.samples > 0 ? share_of(rule, found, record) : 0.0;
        const bool is_silent = rule.unless_previous && was_reported;
        was_reported = share > rule.limit && found.samples >= rule.min_samples && found.lasts_s >= rule.min_s;
        if (!was_reported || is_silent) continue;
        auto& texts = rule.consequence == Consequence::fault ? findings.faults : findings.warnings;
        texts.push_back(fmt::format(
            fmt::runtime(rule.text), fmt::arg("percent", share * units::percent_per_whole),
            fmt::arg("samples", found.samples), fmt::arg("lasts_s", found.lasts_s),
            fmt::arg("from_s", record.time_s[found.longest.first]),
            fmt::arg("to_s", record.time_s[found.longest.last - 1]),
            fmt::arg("power_w", record.power_w[found.longest.first]), fmt::arg("highest_a", samples.max_a),
            fmt::arg("energy_wh", units::wh_from_joule(found.energy_j)), fmt::arg("source", record.power_source)));
    }
    return findings;
}

PowerRecord make_power_record(const SelectedTracks& tracks, const FlightPhases& phases) {
    const auto& power = tracks["power_w"];
    const auto on_clock = [&](const char* name) { return sample_selected_track(tracks, name, power.time_s); };
    PowerRecord record;
    record.voltage_v = on_clock("voltage_v");
    record.current_a = on_clock("current_a");
    record.charge_ah = on_clock("charge_ah");
    record.energy_wh = on_clock("energy_wh");
    record.charge_resolution_ah = resolution_of(tracks["charge_ah"]);
    record.energy_resolution_wh = resolution_of(tracks["energy_wh"]);
    record.throttle_percent = on_clock("throttle_percent");
    record.altitude_m = on_clock("altitude_m");
    record.altitude_time_s = tracks["altitude_m"].time_s;
    record.is_sum_of_circuits = is_sum_over_devices(power) && power.source.starts_with("POWER_DEVICE");
    record.power_source = power.source;
    record.time_s = power.time_s;
    record.power_w = power.value;
    const auto& time_s = record.time_s;
    for (const auto& sortie : phases.sorties) {
        const auto first = std::lower_bound(time_s.begin(), time_s.end(), sortie.start_s());
        const auto last = std::upper_bound(first, time_s.end(), sortie.end_s());
        record.in_flight.push_back(
            {static_cast<std::size_t>(first - time_s.begin()), static_cast<std::size_t>(last - time_s.begin())});
        if (!time_s.empty()) record.energy_j += integrated(time_s, record.power_w, sortie.start_s(), sortie.end_s());
        record.duration_s += sortie.end_s() - sortie.start_s();
    }
    return record;
}

std::vector<std::size_t> resting_samples(const PowerRecord& record, const std::vector<TimeInterval>& rests,
                                         const SegmentationOptions& options) {
    std::vector<std::size_t> indices;
    const bool motor_known = !record.throttle_percent.empty();
    const auto is_off = [&](std::size_t i) {
        if (motor_known) return record.throttle_percent[i] <= options.idle_throttle_percent;
        return std::ranges::none_of(record.in_flight,
                                    [&](const SampleRange& flown) { return i >= flown.first && i < flown.last; });
    };
    auto rest = rests.begin();
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        while (rest != rests.end() && record.time_s[i] >= rest->end_s) ++rest;
        if (rest != rests.end() && record.time_s[i] >= rest->start_s && is_off(i)) indices.push_back(i);
    }
    return indices;
}

}  // namespace flightwatt::flight
