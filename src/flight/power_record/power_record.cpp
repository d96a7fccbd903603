#include "flight/power_record/power_record.h"

#include "flight/chosen_track.h"
#include "flight/segmentation/flight_grid.h"
#include "flight/sources/device_sum.h"

#include <algorithm>
#include <utility>

namespace flightwatt::flight {

PowerRecord record_of(const FlightSeries& series, const FlightPhases& phases) {
    auto power = power_track(series);
    const auto on_clock = [&](const char* name) { return chosen_at(series, name, power.time_s); };
    PowerRecord record;
    record.voltage_v = on_clock("voltage_v");
    record.current_a = on_clock("current_a");
    record.charge_ah = on_clock("charge_ah");
    record.energy_wh = on_clock("energy_wh");
    record.throttle_percent = on_clock("throttle_percent");
    const auto altitude = chosen_track(series, "altitude_m");
    if (!altitude.empty()) record.altitude_m = resample(altitude, power.time_s);
    record.altitude_time_s = altitude.time_s;
    record.is_sum = is_sum_over_devices(power);
    record.time_s = std::move(power.time_s);
    record.power_w = std::move(power.value);
    const auto& time_s = record.time_s;
    for (const auto& sortie : phases.sorties) {
        const auto first = std::lower_bound(time_s.begin(), time_s.end(), sortie.start_s());
        const auto last = std::upper_bound(first, time_s.end(), sortie.end_s());
        record.flown.push_back(
            {static_cast<std::size_t>(first - time_s.begin()), static_cast<std::size_t>(last - time_s.begin())});
    }
    return record;
}

std::vector<std::size_t> resting_samples(const FlightSeries& series, const PowerRecord& record,
                                         const SegmentationOptions& options) {
    std::vector<std::size_t> indices;
    const bool motor_known = !record.throttle_percent.empty();
    const auto is_off = [&](std::size_t i) {
        if (motor_known) return record.throttle_percent[i] <= options.idle_throttle_percent;
        return std::ranges::none_of(record.flown,
                                    [&](const SampleRange& flown) { return i >= flown.first && i < flown.last; });
    };
    const auto grid = make_grid(ChosenTracks(series));
    const auto rests = find_rests(grid, options);
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        const auto at = static_cast<std::size_t>((record.time_s[i] - grid.start_s) / grid.step_s);
        const bool resting = std::any_of(rests.begin(), rests.end(),
                                         [&](const GridSpan& rest) { return at >= rest.begin && at < rest.end; });
        if (resting && is_off(i)) indices.push_back(i);
    }
    return indices;
}

}  // namespace flightwatt::flight
