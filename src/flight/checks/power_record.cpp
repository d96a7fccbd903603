#include "flight/checks/power_record.h"

#include "base/piecewise_linear.h"
#include "base/statistics.h"
#include "flight/link_gaps.h"
#include "flight/select/device_sum.h"

#include <map>
#include <utility>

namespace flightwatt::flight {
namespace {

constexpr double powerless_fraction = 0.05;    // of the upper quartile of the power with an open throttle
constexpr double powerless_of_largest = 0.01;  // power rises at most with the cube of the throttle: 2.7 % at 30 %
constexpr std::size_t min_step_samples = 10;   // of a step of throttle

/// The decimal place to which a counter is rounded, from 1 down to a millionth: the first of which all values are
/// multiples.
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

/// Compares the integral of `rate` over all sorties with the counter, if that counted.
void close(const PowerRecord& record, const std::vector<double>& rate, OnBoardCounter& counter) {
    if (rate.empty() || counter.value.empty()) return;
    double integral = 0.0;
    double difference = 0.0;
    for (const auto& sortie : record.sorties) {
        integral += integrated(record.time_s, rate, sortie.start_s(), sortie.end_s()) / units::seconds_per_hour;
        difference += counter_change(record, counter, sortie.start_s(), sortie.end_s());
    }
    if (!(difference > 0.0)) return;
    counter.closure_percent = (integral / difference - 1.0) * units::percent_per_whole;
    counter.rounding_percent = units::percentage(2.0 * counter.resolution, difference);
}

/// An armed motor may idle at throttle 0, so the samples while the aircraft is `armed` do not count.
std::vector<std::size_t> resting_samples(const PowerRecord& record, const std::vector<TimeInterval>& rests,
                                         const Track& armed, const SegmentationOptions& options) {
    std::vector<std::size_t> indices;
    const auto is_off = [&](std::size_t i) {
        const bool is_known = !armed.empty() && record.time_s[i] >= armed.time_s.front();
        if (is_known && state_at(armed, record.time_s[i]) == 1.0) return false;
        if (record.has_throttle()) return record.throttle_percent[i] <= options.idle_throttle_percent;
        return std::ranges::none_of(record.in_flight,
                                    [&](const IndexSpan& flown) { return i >= flown.begin && i < flown.end; });
    };
    auto rest = rests.begin();
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        while (rest != rests.end() && record.time_s[i] >= rest->end_s) ++rest;
        if (rest != rests.end() && record.time_s[i] >= rest->start_s && is_off(i)) indices.push_back(i);
    }
    return indices;
}

/// Mean and standard deviation of the current at rest, without outliers: the autopilot switches loads on the ground
/// too.
std::optional<IdleCurrent> idle_current(const std::vector<double>& current_a, const std::vector<std::size_t>& resting) {
    constexpr std::size_t enough = 10;
    if (current_a.empty() || resting.size() < enough) return std::nullopt;
    std::vector<double> values(resting.size());
    std::ranges::transform(resting, values.begin(), [&](auto i) { return current_a[i]; });
    const double middle = median_high(values);
    std::vector<double> distances(values.size());
    std::ranges::transform(values, distances.begin(), [&](double value) { return std::abs(value - middle); });
    const double max_distance = 5.0 * std::max(median_high(std::move(distances)), 1e-6);  // some 3 sigma
    std::erase_if(values, [&](double value) { return std::abs(value - middle) > max_distance; });
    return IdleCurrent{mean(values), values.size() > 1 ? std::sqrt(sample_variance(values)) : 0.0, values.size()};
}

/// Median power of each 5 % step of the throttle with at least `min_step_samples`; NaN elsewhere, and everywhere if
/// there are fewer than two such steps (a switch, or a constant throttle).
std::vector<double> usual_power_w(const PowerRecord& record) {
    constexpr double step_percent = 5.0;
    std::vector<double> usual_w(record.time_s.size(), std::numeric_limits<double>::quiet_NaN());
    std::map<int, std::vector<std::size_t>> by_throttle;
    for (std::size_t i = 0; i < usual_w.size(); ++i) {
        if (record.is_flown(i) && record.has_open_throttle(i))
            by_throttle[static_cast<int>(record.throttle_percent[i] / step_percent)].push_back(i);
    }
    std::erase_if(by_throttle, [](const auto& step) { return step.second.size() < min_step_samples; });
    if (by_throttle.size() < 2) return usual_w;
    for (const auto& [step, samples] : by_throttle) {
        std::vector<double> powers_w(samples.size());
        std::ranges::transform(samples, powers_w.begin(), [&](auto i) { return record.power_w[i]; });
        const double median_w = median_high(std::move(powers_w));
        for (const auto i : samples) usual_w[i] = median_w;
    }
    return usual_w;
}

/// Median length of the runs of equal values in flight.
std::size_t update_samples(const PowerRecord& record) {
    const auto& values = record.has_current() ? record.current_a : record.power_w;
    std::vector<double> lengths;
    for (const auto& run : runs_of_equal(values, 1))
        if (record.is_flown(run.begin)) lengths.push_back(static_cast<double>(run.size()));
    return lengths.empty() ? 1 : static_cast<std::size_t>(median_high(std::move(lengths)));
}

/// Whether the current stays at its highest value in three runs or more; a sensor that hangs does so once.
bool is_clipped(const PowerRecord& record) {
    constexpr std::ptrdiff_t min_runs = 3;
    const auto runs = runs_of_equal(record.current_a, 2);
    return std::ranges::count_if(runs, [&](const IndexSpan& run) {
               return record.is_flown(run.begin) && record.current_a[run.begin] == record.max_a;
           }) >= min_runs;
}

/// Sums and extremes over the samples in flight.
void add_sums(PowerRecord& record) {
    std::vector<double> currents_a;
    std::vector<double> voltages_v;
    std::vector<double> running_w;
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        if (!record.is_flown(i)) continue;
        record.power_sum_w += record.power_w[i];
        if (record.has_current()) currents_a.push_back(record.current_a[i]);
        if (!record.voltage_v.empty()) voltages_v.push_back(record.voltage_v[i]);
        if (record.has_open_throttle(i)) running_w.push_back(std::abs(record.power_w[i]));
    }
    if (!currents_a.empty()) {
        record.mean_a = mean(currents_a);
        record.max_a = std::max(0.0, std::ranges::max(currents_a));
    }
    if (!voltages_v.empty()) {
        record.min_v = std::ranges::min(voltages_v);
        record.max_v = std::ranges::max(voltages_v);
    }
    std::ranges::sort(running_w);
    if (!running_w.empty())
        record.powerless_w =
            std::max(powerless_fraction * quantile(running_w, 0.75), powerless_of_largest * running_w.back());
}

}  // namespace

PowerRecord make_power_record(const FlightData& data, const FlightPhases& phases, const SegmentationOptions& options) {
    const auto& power = data.power_w;
    const auto on_clock = [&](const Track& track) { return resample(track, power.time_s); };
    PowerRecord record;
    record.time_s = power.time_s;
    record.power_w = power.value;
    record.voltage_v = on_clock(data.voltage_v);
    record.current_a = on_clock(data.current_a);
    record.charge_ah.value = on_clock(data.charge_ah);
    record.energy_wh.value = on_clock(data.energy_wh);
    record.charge_ah.resolution = resolution_of(data.charge_ah);
    record.energy_wh.resolution = resolution_of(data.energy_wh);
    record.throttle_percent = on_clock(data.throttle_percent);
    record.altitude_m = on_clock(data.altitude_m);
    record.altitude_time_s = data.altitude_m.time_s;
    record.is_sum_of_circuits =
        data.circuits.size() > 1 || (is_sum_over_devices(power) && power.source.starts_with("POWER_DEVICE"));
    record.power_source = power.source;
    record.sorties = phases.sorties;
    record.part = phases.part;
    const auto& time_s = record.time_s;
    for (const auto& sortie : phases.sorties) {
        record.in_flight.push_back({first_at_or_after(time_s, sortie.start_s()), first_after(time_s, sortie.end_s())});
        if (!time_s.empty()) record.energy_j += integrated(time_s, record.power_w, sortie.start_s(), sortie.end_s());
        record.duration_s += sortie.end_s() - sortie.start_s();
    }
    const auto restarts_in_flight = [&](const Track& counter) {
        return std::ranges::any_of(phases.sorties,
                                   [&](const Sortie& of) { return restarts(counter, of.start_s(), of.end_s()); });
    };
    if (restarts_in_flight(data.charge_ah)) record.charge_ah.value.clear();  // the autopilot restarted: power is sound
    if (restarts_in_flight(data.energy_wh)) record.energy_wh.value.clear();
    close(record, record.power_w, record.energy_wh);
    close(record, record.current_a, record.charge_ah);
    derive_facts(record, resting_samples(record, phases.rests, data.armed, options));
    return record;
}

void derive_facts(PowerRecord& record, const std::vector<std::size_t>& resting) {
    using State = PowerRecord::State;
    const auto& time_s = record.time_s;
    record.gaps = find_flight_gaps(time_s, record.sorties);
    record.at_rest = idle_current(record.current_a, resting);
    record.states.assign(time_s.size(), State::neither);
    if (record.has_throttle())
        for (const auto i : resting) record.states[i] = State::rest;
    auto rest = resting.begin();
    for (const auto& flown : record.in_flight) {
        const auto lift_off = std::lower_bound(rest, resting.end(), flown.begin);
        record.rests.push_back(idle_current(record.current_a, {rest, lift_off}));
        rest = lift_off;
        set_part(record.states, flown, State::flight);
    }
    record.rests.push_back(idle_current(record.current_a, {rest, resting.end()}));
    record.step_s.assign(time_s.size(), 0.0);
    const double max_s = gap_threshold_s(time_s);
    for (std::size_t i = 1; i < time_s.size(); ++i) {
        const double half_s = 0.5 * std::min(time_s[i] - time_s[i - 1], max_s);
        record.step_s[i - 1] += half_s;
        record.step_s[i] += half_s;
    }
    record.update_samples = update_samples(record);
    record.usual_w = usual_power_w(record);
    record.smooth_w = running_median<11>(record.power_w);
    record.smooth_percent = running_median<11>(record.throttle_percent);
    add_sums(record);
    record.is_clipped = is_clipped(record);
}

double counter_change(const PowerRecord& record, const OnBoardCounter& counter, double start_s, double end_s) {
    return interpolate_clamped(record.time_s, counter.value, end_s) -
           interpolate_clamped(record.time_s, counter.value, start_s);
}

std::vector<SampleGap> find_flight_gaps(const std::vector<double>& time_s, const std::vector<Sortie>& sorties) {
    const double gap_s = gap_threshold_s(time_s);
    std::vector<SampleGap> gaps;
    for (std::size_t i = 1; i < time_s.size(); ++i) {
        const double start_s = time_s[i - 1];
        const double duration_s = time_s[i] - start_s;
        if (duration_s <= gap_s) continue;
        for (const auto& sortie : sorties) {
            if (time_s[i] <= sortie.start_s() || start_s >= sortie.end_s()) continue;
            gaps.push_back({start_s, duration_s, i, start_s >= sortie.start_s() && time_s[i] <= sortie.end_s()});
        }
    }
    return gaps;
}

}  // namespace flightwatt::flight
