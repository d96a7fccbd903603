#include "flight/checks/power_record.h"

#include "flight/phase_statistics.h"
#include "flight/sources/device_sum.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::flight {

namespace {

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

PowerRecord make_power_record(const SelectedTracks& tracks, const FlightPhases& phases) {
    const auto& power = tracks["power_w"];
    const auto on_clock = [&](const char* name) {
        const auto& track = tracks[name];
        return track.empty() ? std::vector<double>{} : resample(track, power.time_s);
    };
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

std::vector<std::size_t> resting_samples(const PowerRecord& record, const std::vector<Rest>& rests,
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
