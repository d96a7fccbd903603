#include "flight/segmentation/flight_grid.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "flight/chosen_track.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

/// Running median of an odd number of values: takes out spikes of less than half as many, and leaves climbs
/// as they are.
template <std::size_t Width>
std::vector<double> without_spikes(const std::vector<double>& values) {
    constexpr auto reach = static_cast<std::ptrdiff_t>(Width / 2);
    std::vector<double> smooth = values;
    for (std::ptrdiff_t i = reach; i + reach < static_cast<std::ptrdiff_t>(values.size()); ++i) {
        std::array<double, Width> near{};
        std::copy_n(values.begin() + i - reach, Width, near.begin());
        std::nth_element(near.begin(), near.begin() + reach, near.end());
        smooth[static_cast<std::size_t>(i)] = near[Width / 2];
    }
    return smooth;
}

/// What counts as idle: some airframes never report less than a trimmed or armed idle. Where the speed tells
/// rest from flight too, the least throttle of the log is taken for that.
double idle_throttle_percent(const FlightGrid& grid, const SegmentationOptions& options) {
    if (grid.throttle_percent.empty() || grid.ground_speed_m_per_s.empty()) return options.idle_throttle_percent;
    const double least = *std::min_element(grid.throttle_percent.begin(), grid.throttle_percent.end());
    return std::max(least, 0.0) + options.idle_throttle_percent;
}

}  // namespace

FlightGrid make_grid(const FlightSeries& series) {
    auto altitude = chosen_track(series, "altitude_m");
    if (altitude.empty()) {
        const auto warnings = warnings_of(series);
        throw InputError(
            {series.file.empty() ? series.flight : series.file}, "has no altitude, so its phases cannot be told apart",
            fmt::format("expected ESTIMATOR, GPS, GPS_INT, AIR_DATA or ROTORCRAFT_FP, or a column altitude_m{}{}",
                        warnings.empty() ? "" : "; ", fmt::join(warnings, "; ")));
    }
    FlightGrid grid;
    const auto power = power_track(series);
    grid.start_s = power.time_s.front();
    const double span_s = power.time_s.back() - grid.start_s;
    constexpr double longest_s = 30.0 * 24.0 * units::seconds_per_hour;
    if (!(span_s <= longest_s)) {
        throw InputError({series.file}, fmt::format("lasts {:.4g} s, more than a month", span_s),
                         "are its times in seconds?");
    }
    const auto count = static_cast<std::size_t>(std::floor(span_s / grid.step_s)) + 1;
    std::vector<double> time_s(count);
    for (std::size_t i = 0; i < count; ++i) time_s[i] = grid.time_s(i);
    altitude.value = without_spikes<3>(altitude.value);  // on its own clock, before the grid's
    grid.altitude_m = without_spikes<5>(resample(altitude, time_s));
    // As it was when power was sampled: the clock that throttle is asked for on everywhere.
    if (const auto throttle = chosen_at(series, "throttle_percent", power.time_s); !throttle.empty()) {
        grid.throttle_percent = resample(Track{.time_s = power.time_s, .value = throttle}, time_s);
    }
    const auto speed = chosen_at(series, "ground_speed_m_per_s", time_s);
    if (!speed.empty()) grid.ground_speed_m_per_s = without_spikes<5>(speed);
    return grid;
}

std::vector<GridSpan> find_rests(const FlightGrid& grid, const SegmentationOptions& options) {
    const double idle_percent = idle_throttle_percent(grid, options);
    const auto within = [&](const std::vector<double>& channel, std::size_t i, double limit) {
        return channel.empty() || channel[i] <= limit;
    };
    const auto is_still = [&](std::size_t begin, std::size_t end, double height_m) {
        double low = grid.altitude_m[begin];
        double high = low;
        for (std::size_t i = begin; i < end; ++i) {
            low = std::min(low, grid.altitude_m[i]);
            high = std::max(high, grid.altitude_m[i]);
            if (high - low > height_m || !within(grid.throttle_percent, i, idle_percent) ||
                !within(grid.ground_speed_m_per_s, i, options.rest_speed_m_per_s)) {
                return false;
            }
        }
        return true;
    };
    std::vector<bool> resting(grid.size(), false);
    const auto mark = [&](std::size_t begin, std::size_t end) {
        std::fill(resting.begin() + static_cast<std::ptrdiff_t>(begin),
                  resting.begin() + static_cast<std::ptrdiff_t>(end), true);
    };
    const auto window = grid.steps(options.rest_s) + 1;
    for (std::size_t begin = 0; begin + window <= grid.size(); ++begin) {
        if (is_still(begin, begin + window, options.rest_height_m)) mark(begin, begin + window);
    }
    // The log may begin just before lift-off or end just after touchdown: there less time does, within less height.
    const auto edge = grid.steps(0.3 * options.rest_s) + 1;
    if (edge <= grid.size()) {
        if (is_still(0, edge, 0.3 * options.rest_height_m)) mark(0, edge);
        if (is_still(grid.size() - edge, grid.size(), 0.3 * options.rest_height_m))
            mark(grid.size() - edge, grid.size());
    }
    std::vector<GridSpan> rests;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        if (!resting[i]) continue;
        if (rests.empty() || rests.back().end != i) rests.push_back({i, i});
        rests.back().end = i + 1;
    }
    return rests;
}

double median_altitude_m(const FlightGrid& grid, GridSpan span) {
    std::vector<double> values(grid.altitude_m.begin() + static_cast<std::ptrdiff_t>(span.begin),
                               grid.altitude_m.begin() + static_cast<std::ptrdiff_t>(span.end));
    return upper_median(std::move(values));
}

}  // namespace flightwatt::flight
