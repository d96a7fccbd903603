#include "battery/discharge_record.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "battery/identification/pack_changes.h"
#include "flight/flight_phases.h"
#include "flight/phase_statistics.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::battery {
namespace {

constexpr double rest_s = 30.0;
constexpr double idle_throttle_percent = 5.0;
constexpr double flight_throttle_percent = 20.0;
constexpr double idle_current_a = 1.0;   // more than electronics draw
constexpr double fine_counter_a = 0.05;  // error of a mean current by the counter's resolution
constexpr std::size_t min_samples = 50;

constexpr auto needed = "a battery is identified from measured voltage and current";

void require_samples(const flight::FlightData& data, std::size_t samples) {
    if (samples >= min_samples) return;
    throw InputError({data.file},
                     fmt::format("{}: has {} samples, expected at least {}", data.flight, samples, min_samples),
                     needed);
}

void require_channels(const flight::FlightData& data, const PackRecord& record) {
    const auto refuse = [&](const std::string& reason, const std::string& hint) {
        throw InputError({data.file}, fmt::format("{}: {}", data.flight, reason), hint);
    };
    if (data.current_origin == flight::CurrentOrigin::throttle) {
        refuse("its current was computed from throttle, not measured", "use flights with a current sensor");
    }
    if (record.voltage_v.empty()) refuse("has no voltage", needed);
    if (record.current_a.empty()) refuse("has no current", needed);
    require_samples(data, record.time_s.size());
    for (const auto& [name, values] : {std::pair{"voltage", &record.voltage_v}, {"current", &record.current_a}}) {
        const auto [low, high] = std::minmax_element(values->begin(), values->end());
        if (*low == *high) refuse(fmt::format("its {} is {} throughout", name, *low), needed);
    }
    if (*std::ranges::min_element(record.voltage_v) <= 0.0) refuse("its voltage is not positive throughout", needed);
}

/// The minimum difference between two of the values, above rounding.
double min_difference(std::vector<double> values) {
    std::ranges::sort(values);
    double min = values.back() - values.front();
    constexpr double rounding = 1e-9;
    for (std::size_t i = 1; i < values.size(); ++i) {
        const double difference = values[i] - values[i - 1];
        if (difference > rounding) min = std::min(min, difference);
    }
    return min;
}

/// `counter_ah` is the on-board counter's charge, or empty.
void add_charge(const std::vector<double>& counter_ah, DischargeRecord& record) {
    const auto& time_s = record.time_s;
    const bool counted = !counter_ah.empty() && counter_ah.back() > counter_ah.front();
    record.charge_ah = counted ? counter_ah : integrated_charge_ah(record.time_s, record.current_a);
    for (auto& charge : record.charge_ah) charge -= counted ? counter_ah.front() : 0.0;
    // A counter in whole mAh is too coarse for single intervals, but bridges gaps.
    const bool fine = counted && units::coulomb_from_ah(min_difference(counter_ah)) <
                                     fine_counter_a * flight::median_interval_s(time_s);
    const double counted_from_s = fine ? 0.0 : flight::gap_threshold_s(time_s);
    record.mean_current_a = record.current_a;
    for (std::size_t i = 1; i < time_s.size(); ++i) {
        const double interval_s = time_s[i] - time_s[i - 1];
        if (counted && interval_s > counted_from_s) {
            const double charge_ah = record.charge_ah[i] - record.charge_ah[i - 1];
            record.mean_current_a[i] = units::coulomb_from_ah(charge_ah) / interval_s;
        } else {
            record.mean_current_a[i] = (record.current_a[i - 1] + record.current_a[i]) / 2.0;
        }
    }
}

/// Not used are bursts of current that the motor did not draw.
void mark_used(const std::vector<double>& throttle_percent, DischargeRecord& record) {
    record.used.assign(record.time_s.size(), true);
    if (throttle_percent.empty() || *std::ranges::max_element(throttle_percent) < flight_throttle_percent) return;
    for (std::size_t i = 0; i < throttle_percent.size(); ++i) {
        record.used[i] = throttle_percent[i] > idle_throttle_percent || std::abs(record.current_a[i]) <= idle_current_a;
    }
}

void add_rest(const flight::FlightData& data, DischargeRecord& record) {
    double max_a = 0.0;
    for (std::size_t i = 0; i < record.used.size(); ++i)
        if (record.used[i]) max_a = std::max(max_a, record.current_a[i]);
    const double load_a = load_threshold_a(max_a);
    std::size_t end = 0;
    while (end < record.current_a.size() && record.current_a[end] < load_a) ++end;
    if (end == 0 || end == record.current_a.size()) {
        const auto* const reason =
            end == 0 ? "its log does not begin at rest: its initial charge is unknown" : "nothing loads the battery";
        throw InputError({data.file}, fmt::format("{}: {}", data.flight, reason),
                         "a log that begins before take-off is needed");
    }
    std::vector<double> voltages_v;
    std::vector<double> currents_a;
    for (std::size_t i = end; i-- > 0 && record.time_s[i] >= record.time_s[end - 1] - rest_s;) {
        voltages_v.push_back(record.voltage_v[i]);
        currents_a.push_back(record.current_a[i]);
    }
    record.rest_samples = end;
    record.resting_voltage_v = median_high(std::move(voltages_v));
    record.resting_current_a = median_high(std::move(currents_a));
}

void fill_record(const flight::FlightData& data, const PackRecord& part, DischargeRecord& record) {
    require_samples(data, part.time_s.size());
    record.time_s = part.time_s;
    record.voltage_v = part.voltage_v;
    record.current_a = part.current_a;
    add_charge(part.counter_ah, record);
    mark_used(part.throttle_percent, record);
    add_rest(data, record);
    record.resolution_v = min_difference(record.voltage_v);
    record.stated_cells = data.stated_cells;
    record.monitors = data.monitors;
    const auto temperature_c = resample(data.air_temperature_c, record.time_s);
    if (!temperature_c.empty()) record.air_temperature_c = mean(temperature_c);
    const auto battery_c = resample(data.battery_temperature_c, record.time_s);
    if (battery_c.empty()) return;
    record.battery_temperature_c = mean(battery_c);
    record.battery_start_c = battery_c[record.rest_samples];
}

}  // namespace

DischargeRecords discharge_records(const flight::FlightData& data) {
    PackRecord whole;
    whole.time_s = data.power_w.time_s;
    whole.voltage_v = resample(data.voltage_v, whole.time_s);
    whole.current_a = resample(data.current_a, whole.time_s);
    require_channels(data, whole);
    whole.counter_ah = resample(data.charge_ah, whole.time_s);
    whole.throttle_percent = resample(data.throttle_percent, whole.time_s);
    DischargeRecords found;
    const auto stands = [&altitude = data.altitude_m](double time_s) {  // in a glide a pack recovers, too
        constexpr flight::SegmentationOptions rest;
        const auto at_m = [&](double later_s) { return value_at(altitude, time_s + later_s); };
        return altitude.empty() || std::abs(at_m(rest.rest_s) - at_m(-rest.rest_s)) <= rest.rest_height_m;
    };
    const auto parts = split_at_pack_changes(std::move(whole), found.notes, stands);
    for (std::size_t p = 0; p < parts.size(); ++p) {
        DischargeRecord record;
        record.flight = p == 0 ? data.flight : fmt::format("{}#{}", data.flight, p + 1);
        record.is_other_pack = p > 0;
        try {
            fill_record(data, parts[p], record);
            found.records.push_back(std::move(record));
        } catch (const InputError& error) {
            if (parts.size() == 1) throw;
            found.notes.push_back(fmt::format("pack {} is not used: {}", p + 1, error.what()));
        }
    }
    if (found.records.empty()) throw InputError({data.file}, fmt::format("{}", fmt::join(found.notes, "; ")));
    return found;
}

std::ptrdiff_t used_sample_count(const DischargeRecord& record) { return std::ranges::count(record.used, true); }

std::ptrdiff_t rest_sample_count(const DischargeRecord& record) {
    const auto rests = static_cast<std::ptrdiff_t>(std::min(record.rest_samples, record.used.size()));
    return std::count(record.used.begin(), record.used.begin() + rests, true);
}

std::vector<double> rc_branch_current_a(const DischargeRecord& record, double time_constant_s) {
    std::vector<double> settled_a(record.time_s.size());
    settled_a.front() = record.resting_current_a;
    double step_s = 0.0;
    double decay = 1.0;
    for (std::size_t i = 1; i < settled_a.size(); ++i) {
        if (const double own_s = record.time_s[i] - record.time_s[i - 1]; own_s != step_s) {
            step_s = own_s;
            decay = std::exp(-own_s / time_constant_s);
        }
        settled_a[i] = settled_a[i - 1] * decay + record.mean_current_a[i] * (1.0 - decay);
    }
    return settled_a;
}

std::vector<double> heat_a2s(const DischargeRecord& record) {
    std::vector<double> heat(record.time_s.size(), 0.0);
    for (std::size_t i = 1; i < heat.size(); ++i)
        heat[i] = heat[i - 1] + std::pow(record.mean_current_a[i], 2) * (record.time_s[i] - record.time_s[i - 1]);
    return heat;
}

}  // namespace flightwatt::battery
