#include "flight/checks/power_rules.h"

#include "base/statistics.h"
#include "base/units.h"
#include "flight/checks/runs.h"
#include "flight/checks/unusual_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr std::size_t stuck_samples = 30;  // equal values in a row
constexpr std::size_t stuck_updates = 4;   // of a sensor slower than the log
constexpr double faulty_rest_a = 5.0;
constexpr double suspect_rest_a = 1.0;
constexpr double suspect_rest_percent = 5.0;   // of the mean in flight
constexpr double negative_rest_a = 0.1;        // beyond the resolution of sensors
constexpr double negative_rest_percent = 1.0;  // of the mean in flight
constexpr double gliding_sink_m_per_s = 0.5;
constexpr double usual_factor = 0.65;  // of the power at the same throttle, or of the samples around
constexpr double usual_factor_without_throttle = 0.3;
constexpr double same_throttle_factor = 0.85;  // of the samples around
constexpr double same_throttle_percent = 2.0;
constexpr double max_pack_v = 60.0;        // 14 LiPo cells
constexpr double min_pack_v = 2.5;         // one cell, empty
constexpr double min_voltage_part = 0.55;  // 2.3 V of a cell that began full
constexpr double varied_current = 2.0;     // its 95th over its 5th percentile, for a voltage to vary with it
constexpr double max_dead_part = 0.5;      // of the samples with an open throttle: with more the energy is not measured
constexpr double min_dead_s = 30.0;        // the throttle of a motor that is not armed may be open for less
constexpr double min_mean_power_w = 3.0;
constexpr double max_mean_power_w = 20e3;  // of some 100 kg in the air

using Test = bool (*)(const PowerRecord&, std::size_t);

constexpr Test always = [](const PowerRecord&, std::size_t) { return true; };
constexpr Test in_flight = [](const PowerRecord& r, std::size_t i) { return r.is_flown(i); };
constexpr Test in_powered_flight = [](const PowerRecord& r, std::size_t i) {
    return r.is_flown(i) && r.has_open_throttle(i);
};
constexpr Test is_powerless = [](const PowerRecord& r, std::size_t i) {
    return std::abs(r.power_w[i]) <= r.powerless_w;
};

/// Basis of a rule's share.
enum class Share { samples, time, energy, time_or_energy };

constexpr double infinite = std::numeric_limits<double>::infinity();

/// A rule for samples has `holds`, a rule for the whole record `when`, and any other one `findings`. The share of the
/// samples, or the value of a finding, is compared with the limits.
struct PowerRule {
    const char* kind = "";  ///< of its diagnostics
    const char* text = "";  ///< with the arguments of format_finding()
    bool (*when)(const PowerRecord&) = nullptr;
    Findings (*findings)(const PowerRecord&) = nullptr;
    Test applies = in_flight;  ///< selects the samples
    Test holds = nullptr;      ///< of these samples it finds runs
    Test continues = always;   ///< compares a sample with the one before it; a run ends where it is false
    std::size_t min_run = 1;   ///< samples of a run; if above 1, also four updates of a sensor slower than the log
    double min_level_s = 0.0;  ///< duration of a run; if above 0, the aircraft must not sink
    std::size_t min_samples = 0;
    double min_s = 0.0;  ///< of all runs together
    Share share = Share::samples;
    double (*energy_w)(const PowerRecord&, std::size_t) = [](const PowerRecord& r, std::size_t i) {
        return r.power_w[i];
    };
    double warn_above = infinite;
    double fault_above = infinite;
    bool needs_energy = true;      ///< of a warning: skipped if the energy in flight is not positive (a fault)
    bool unless_previous = false;  ///< skipped if the rule directly above it in the table has a finding
};

/// No load draws a negative current, so that less of it is the sensor's offset.
bool is_loaded_at_rest(const PowerRecord& r) {
    if (!r.at_rest || std::ranges::none_of(r.in_flight, &IndexSpan::size)) return false;
    if (r.at_rest->mean_a <= -negative_rest_a && r.rest_percent() >= negative_rest_percent) return true;
    return std::abs(r.at_rest->mean_a) >= suspect_rest_a || r.rest_percent() >= suspect_rest_percent;
}

bool is_constant_in_flight(const PowerRecord& r) {
    constexpr std::size_t enough = 10;
    return std::ranges::any_of(r.in_flight, [&](const IndexSpan& flown) {
        const auto power_w = part_of(r.power_w, flown);
        return power_w.size() >= enough && std::ranges::count(power_w, power_w.front()) == std::ssize(power_w);
    });
}

/// A pack's voltage falls with its current and its charge.
bool has_constant_voltage(const PowerRecord& r) {
    if (r.is_sum_of_circuits || r.voltage_v.size() < stuck_samples || !r.has_current()) return false;
    if (std::ranges::count(r.voltage_v, r.voltage_v.front()) != std::ssize(r.voltage_v)) return false;
    auto currents_a = r.current_a;
    std::ranges::sort(currents_a);
    return quantile(currents_a, 0.95) > varied_current * std::max(quantile(currents_a, 0.05), 0.0);
}

bool has_pack_voltage(const PowerRecord& r) { return r.max_v >= min_pack_v && r.max_v <= max_pack_v; }

/// First and last time of the altitude, or of the power without one.
std::pair<double, double> altitude_span(const PowerRecord& r) {
    const auto& time_s = r.altitude_time_s.empty() ? r.time_s : r.altitude_time_s;
    return {time_s.front(), time_s.back()};
}

/// Altitude without power for longer than this is reported.
double max_missing_s(const PowerRecord& r) {
    const auto [from_s, to_s] = altitude_span(r);
    return std::max(30.0, 0.05 * (to_s - from_s));
}

/// Whether a sample differs from the running medians of power and throttle: power by usual_factor without the throttle,
/// or, if no throttle is known, by a larger factor.
bool is_brief_change(const PowerRecord& r, std::size_t i) {
    const double smooth_w = r.smooth_w[i];
    const double ratio = r.power_w[i] / std::max(smooth_w, 1e-9);
    if (!r.has_throttle()) return ratio < usual_factor_without_throttle || usual_factor_without_throttle * ratio > 1.0;
    const double percent = r.throttle_percent[i];
    const double smooth_percent = r.smooth_percent[i];
    if (ratio < usual_factor) return r.has_open_throttle(i) && percent >= same_throttle_factor * smooth_percent;
    return usual_factor * ratio > 1.0 && percent <= smooth_percent / same_throttle_factor + same_throttle_percent;
}

/// In the order of the reports. Whatever could hide 5 % of the energy is reported (docs/methods.md).
constexpr PowerRule rules[] = {
    {.kind = "current at rest",
     .text = "more than 5 A in {percent:.0f} % of the samples on the ground with the motor off",
     .applies = [](const PowerRecord& r, std::size_t i) { return r.is_at_rest(i) && r.has_current(); },
     .holds = [](const PowerRecord& r, std::size_t i) { return std::abs(r.current_a[i]) > faulty_rest_a; },
     .min_samples = 10,
     .fault_above = 0.10},
    {.kind = "counter runs back", .findings = counter_return, .fault_above = 0.05},
    {.kind = "negative power",
     .text = "power is negative on average in flight",
     .when = [](const PowerRecord& r) { return r.power_sum_w < 0.0; },
     .fault_above = 0.0},
    {.kind = "constant power",
     .text = "power does not change in flight",
     .when = is_constant_in_flight,
     .fault_above = 0.0},
    {.kind = "current at rest",
     .text = "the current is {rest_a:.2f} A at rest on the ground, {rest_percent:.0f} % of the mean in flight: "
             "electronics, or an offset of the sensor and its counters; --correct-idle-offset removes it",
     .when = [](const PowerRecord& r) { return r.has_throttle() && is_loaded_at_rest(r); },
     .warn_above = 0.0,
     .needs_energy = false},
    {.kind = "current at rest",
     .text = "the current is {rest_a:.2f} A at rest on the ground, {rest_percent:.0f} % of the mean in flight: idling "
             "motors, as no throttle shows them off, electronics, or an offset of the sensor",
     .when = [](const PowerRecord& r) { return !r.has_throttle() && is_loaded_at_rest(r); },
     .warn_above = 0.0,
     .needs_energy = false},
    {.kind = "sensor drift", .findings = rest_current_drift, .warn_above = 0.05, .needs_energy = false},
    {.kind = "implausible voltage",
     .text = "the voltage of {max_v:.4g} V is that of more than 14 LiPo cells: is its unit V?",
     .when = [](const PowerRecord& r) { return r.max_v > max_pack_v; },
     .warn_above = 0.0,
     .needs_energy = false},
    {.kind = "implausible voltage",
     .text = "the voltage of {max_v:.4g} V is less than a LiPo cell's: is its unit V?",
     .when = [](const PowerRecord& r) { return r.max_v < min_pack_v; },
     .warn_above = 0.0,
     .needs_energy = false},
    {.kind = "implausible voltage",
     .text = "the voltage falls from {max_v:.4g} to {min_v:.4g} V, too far for a pack: is its sensor damaged?",
     .when = [](const PowerRecord& r) { return has_pack_voltage(r) && r.min_v < min_voltage_part * r.max_v; },
     .warn_above = 0.0,
     .needs_energy = false},
    {.kind = "sensor stuck",
     .text = "the voltage is {max_v:.4g} V throughout while the current varies: it is not that of the pack (but of a "
             "receiver, or a constant), so that the energy is approximate at most",
     .when = has_constant_voltage,
     .warn_above = 0.0,
     .needs_energy = false},
    {.kind = "sensor stuck",
     .findings = stuck_voltage,
     .warn_above = 0.2,
     .needs_energy = false,
     .unless_previous = true},
    {.kind = "counter disagrees",
     .findings = counter_difference,
     .warn_above = 3.0,
     .fault_above = max_counter_difference_percent},
    {.kind = "counter disagrees", .findings = phase_difference, .warn_above = 1.0},
    {.kind = "power is not voltage times current",
     .findings = product_difference,
     .warn_above = 0.05,
     .fault_above = 0.10},
    {.kind = "gaps in the altitude", .findings = altitude_gaps, .warn_above = 0.06},
    {.kind = "gaps in the power", .findings = power_gaps, .warn_above = 1.0},
    {.kind = "slow power", .findings = slow_samples, .warn_above = 0.05},
    {.kind = "power without throttle",
     .text = "power rises or falls for up to 5 samples without the throttle, in {samples} samples in flight: "
             "{percent:.0f} % of the energy",
     .holds = is_brief_change,
     .share = Share::energy,
     .energy_w = [](const PowerRecord& r, std::size_t i) { return r.power_w[i] - r.smooth_w[i]; },
     .warn_above = 0.02},
    {.kind = "power without throttle",
     .text = "power differs from the usual power at the same throttle in {samples} samples in flight: "
             "{less_percent:.0f} % of the energy less, {more_percent:.0f} % more",
     .holds =
         [](const PowerRecord& r, std::size_t i) {
             const double power_w = r.power_w[i];
             return power_w < usual_factor * r.usual_w[i] || usual_factor * power_w > r.usual_w[i];
         },
     .share = Share::energy,
     .energy_w = [](const PowerRecord& r, std::size_t i) { return r.power_w[i] - r.usual_w[i]; },
     .warn_above = 0.04},
    {.kind = "sensor stuck",
     .text = "power is stuck at {power_w:.2f} W from {from_s:.1f} to {to_s:.1f} s, {percent:.0f} % of the flight",
     .holds = [](const PowerRecord& r, std::size_t i) { return r.power_w[i] != 0.0 || r.has_open_throttle(i); },
     .continues = [](const PowerRecord& r, std::size_t i) { return r.power_w[i] == r.power_w[i - 1]; },
     .min_run = stuck_samples,
     .share = Share::time_or_energy,
     .warn_above = 0.04},
    {.kind = "sensor stuck",
     .text = "the current is stuck in {percent:.0f} % of the samples in flight: is its sensor damaged?",
     .holds =
         [](const PowerRecord& r, std::size_t i) {
             return r.has_current() && r.current_a[i] > 0.0 && !(r.is_clipped && r.current_a[i] == r.max_a);
         },
     .continues = [](const PowerRecord& r, std::size_t i) { return r.current_a[i] == r.current_a[i - 1]; },
     .min_run = stuck_samples,
     .warn_above = 0.04},
    {.kind = "sensor saturated",
     .text = "the current is {max_a:.4g} A, its highest, in {percent:.0f} % of the samples in flight: its sensor is "
             "saturated, and the true energy is higher",
     .holds = [](const PowerRecord& r, std::size_t i) { return r.has_current() && r.current_a[i] == r.max_a; },
     .min_samples = stuck_samples,
     .warn_above = 0.05,
     .unless_previous = true},
    {.kind = "no power in flight",
     .text = "{source} is 0 for {lasts_s:.0f} s in flight without a descent, the longest from {from_s:.0f} s on: "
             "{percent:.0f} % of the flight has no power",
     .holds = [](const PowerRecord& r,
                 std::size_t i) { return r.power_w[i] == 0.0 && (r.has_open_throttle(i) || !r.has_throttle()); },
     .min_level_s = 5.0,
     .share = Share::time,
     .warn_above = 0.02},
    {.kind = "negative power",
     .text = "power is negative in {samples} samples in flight, {percent:.0f} % of the energy",
     .holds = [](const PowerRecord& r, std::size_t i) { return r.power_w[i] < 0.0; },
     .share = Share::energy,
     .warn_above = 0.02},
    {.kind = "no power in flight",
     .text = "no power in {percent:.0f} % of the samples in flight with more than 30 % throttle: its sensor does not "
             "measure what the motor draws there",
     .applies = in_powered_flight,
     .holds = is_powerless,
     .min_s = min_dead_s,
     .fault_above = max_dead_part},
    {.kind = "no power in flight",
     .text = "no power in {percent:.0f} % of the samples in flight with more than 30 % throttle",
     .applies = in_powered_flight,
     .holds = is_powerless,
     .warn_above = 0.15,
     .unless_previous = true},
    {.kind = "power outside of flights",
     .text = "{energy_wh:.3f} Wh, {percent:.0f} % of the energy in flight, were drawn outside of it with more than "
             "30 % throttle: was it a long run-up, or is the altitude wrong?",
     .applies = [](const PowerRecord& r, std::size_t i) { return r.is_outside(i); },
     .holds = [](const PowerRecord& r, std::size_t i) { return r.has_open_throttle(i); },
     .min_s = 30.0,
     .share = Share::energy,
     .warn_above = 0.05},
    {.kind = "climb without power", .findings = powerless_climb, .warn_above = 10.0},
    {.kind = "implausible power",
     .text = "the mean power of {mean_w:.3g} W in flight is less than an aircraft needs: is its unit W?",
     .when = [](const PowerRecord& r) { return r.energy_j / r.duration_s < min_mean_power_w; },
     .warn_above = 0.0},
    {.kind = "implausible power",
     .text = "the mean power of {mean_w:.3g} W in flight is more than a small aircraft draws: is its unit W?",
     .when = [](const PowerRecord& r) { return r.energy_j / r.duration_s > max_mean_power_w; },
     .warn_above = 0.0},
    {.kind = "power logged in part",
     .text =
         "power is logged from {power_from_s:.0f} s, altitude from {altitude_from_s:.0f} s: earlier power is missing",
     .when = [](const PowerRecord& r) { return r.time_s.front() - altitude_span(r).first > max_missing_s(r); },
     .warn_above = 0.0,
     .needs_energy = false},
    {.kind = "power logged in part",
     .text = "power is logged to {power_to_s:.0f} s, altitude to {altitude_to_s:.0f} s: later power is missing",
     .when = [](const PowerRecord& r) { return altitude_span(r).second - r.time_s.back() > max_missing_s(r); },
     .warn_above = 0.0,
     .needs_energy = false},
};

/// Samples that a rule found.
struct Found {
    std::size_t applied = 0;
    std::size_t samples = 0;
    double lasts_s = 0.0;
    double more_j = 0.0;  ///< of positive values of the rule's energy_w
    double less_j = 0.0;  ///< of negative values
    IndexSpan longest{0, 0};

    double energy_j() const { return more_j + less_j; }
};

/// Whether the aircraft sinks in a run as in a glide.
bool sinks(const PowerRecord& record, const IndexSpan& run) {
    if (record.altitude_m.empty()) return true;
    const double sunk_m = record.altitude_m[run.begin] - record.altitude_m[run.end - 1];
    return sunk_m > gliding_sink_m_per_s * (record.time_s[run.end - 1] - record.time_s[run.begin]);
}

Found scan(const PowerRule& rule, const PowerRecord& record) {
    const auto count = record.time_s.size();
    Found found;
    for (std::size_t i = 0; i < count; ++i) found.applied += rule.applies(record, i) ? 1 : 0;
    const auto min_run = rule.min_run > 1 ? std::max(rule.min_run, stuck_updates * record.update_samples) : 1;
    const auto joins = [&](std::size_t i) { return rule.applies(record, i) && rule.holds(record, i); };
    const auto continues = [&](std::size_t i) { return rule.continues(record, i); };
    for (const auto& run : runs_of({0, count}, joins, continues)) {
        const double run_s = record.time_s[run.end - 1] - record.time_s[run.begin];
        if (run.size() < min_run || run_s < rule.min_level_s) continue;
        if (rule.min_level_s > 0.0 && sinks(record, run)) continue;
        found.samples += run.size();
        for (auto i = run.begin; i < run.end; ++i) {
            const double energy_j = rule.energy_w(record, i) * record.step_s[i];
            found.lasts_s += record.step_s[i];
            (energy_j < 0.0 ? found.less_j : found.more_j) += std::abs(energy_j);
        }
        if (run.size() > found.longest.size()) found.longest = run;
    }
    return found;
}

double share_of(const PowerRule& rule, const Found& found, const PowerRecord& record) {
    const double of_time = found.lasts_s / record.duration_s;
    const double of_energy = found.energy_j() / record.energy_j;
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

std::string format_finding(const PowerRule& rule, const PowerRecord& record, const Found& found, double share) {
    const auto last = std::max<std::size_t>(found.longest.end, 1) - 1;
    return fmt::format(
        fmt::runtime(rule.text), fmt::arg("percent", share * units::percent_per_whole),
        fmt::arg("samples", found.samples), fmt::arg("lasts_s", found.lasts_s),
        fmt::arg("from_s", record.time_s[found.longest.begin]), fmt::arg("to_s", record.time_s[last]),
        fmt::arg("power_w", record.power_w[found.longest.begin]), fmt::arg("max_a", record.max_a),
        fmt::arg("energy_wh", units::wh_from_joule(found.energy_j())), fmt::arg("source", record.power_source),
        fmt::arg("less_percent", units::percentage(found.less_j, record.energy_j)),
        fmt::arg("more_percent", units::percentage(found.more_j, record.energy_j)),
        fmt::arg("rest_a", record.at_rest ? record.at_rest->mean_a : 0.0),
        fmt::arg("rest_percent", record.at_rest ? record.rest_percent() : 0.0), fmt::arg("max_v", record.max_v),
        fmt::arg("min_v", record.min_v), fmt::arg("mean_w", record.energy_j / record.duration_s),
        fmt::arg("power_from_s", record.time_s.front()), fmt::arg("power_to_s", record.time_s.back()),
        fmt::arg("altitude_from_s", altitude_span(record).first),
        fmt::arg("altitude_to_s", altitude_span(record).second));
}

Findings apply(const PowerRule& rule, const PowerRecord& record) {
    if (rule.findings != nullptr) return rule.findings(record);
    if (rule.when != nullptr)
        return rule.when(record) ? Findings{{1.0, format_finding(rule, record, {}, 1.0)}} : Findings{};
    const auto found = scan(rule, record);
    if (found.samples == 0 || found.samples < rule.min_samples || found.lasts_s < rule.min_s) return {};
    const double share = share_of(rule, found, record);
    return {{share, format_finding(rule, record, found, share)}};
}

}  // namespace

void apply_power_rules(const PowerRecord& record, PowerReport& report) {
    bool was_reported = false;
    for (const auto& rule : rules) {
        if (rule.unless_previous && was_reported) continue;
        was_reported = false;
        for (const auto& [value, text] : apply(rule, record)) {
            const bool is_fault = value > rule.fault_above;
            if (!is_fault && !(value > rule.warn_above && (!rule.needs_energy || record.energy_j > 0.0))) continue;
            if (is_fault)
                report.power_faults.push_back(text);
            else
                report.warnings.push_back({Severity::warning, rule.kind, text});
            was_reported = true;
        }
    }
}

}  // namespace flightwatt::flight
