#include "flight/segmentation/flight_grid.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "flight/chosen_track.h"
#include "flight/segmentation/altitude_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

/// The altitude at the grid's times, piece by piece: nothing is interpolated over a jump.
void add_altitude(FlightGrid& grid, const AltitudeRecord& record, const std::vector<double>& time_s) {
    const auto& track = record.altitude;
    std::size_t begin = 0;
    std::size_t sample = 0;
    for (std::size_t p = 0; p <= record.jumps_s.size(); ++p) {
        const bool last = p == record.jumps_s.size();
        const auto index_at = [](const std::vector<double>& times, double t) {
            return static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), t) - times.begin());
        };
        const auto end = last ? time_s.size() : index_at(time_s, record.jumps_s[p]);
        const auto next_sample = last ? track.time_s.size() : index_at(track.time_s, record.jumps_s[p]);
        if (end > begin && next_sample > sample) {
            const auto part = [](const std::vector<double>& all, std::size_t from, std::size_t to) {
                return std::vector<double>(all.begin() + static_cast<std::ptrdiff_t>(from),
                                           all.begin() + static_cast<std::ptrdiff_t>(to));
            };
            const Track piece{.time_s = part(track.time_s, sample, next_sample),
                              .value = part(track.value, sample, next_sample)};
            const auto altitude_m = without_spikes<5>(resample(piece, part(time_s, begin, end)));
            grid.altitude_m.insert(grid.altitude_m.end(), altitude_m.begin(), altitude_m.end());
            grid.pieces.push_back({begin, end});
            begin = end;
        }
        sample = next_sample;
    }
}

/// Where no speed tells rest from flight: the points from which it comes down by the height of a flight, or more, before
/// the motor runs again. There it glides, though it may keep its height for a while.
std::vector<bool> gliding_points(const FlightGrid& grid, double idle_percent, double height_m) {
    std::vector<bool> gliding(grid.size(), false);
    if (grid.motor_percent.empty() || !grid.ground_speed_m_per_s.empty()) return gliding;
    for (const auto& piece : grid.pieces) {
        double lowest_m = std::numeric_limits<double>::infinity();  // until the motor runs
        for (auto i = piece.end; i-- > piece.begin;) {
            if (grid.motor_percent[i] > idle_percent) lowest_m = std::numeric_limits<double>::infinity();
            lowest_m = std::min(lowest_m, grid.altitude_m[i]);
            gliding[i] = lowest_m <= grid.altitude_m[i] - height_m;
        }
    }
    return gliding;
}

/// The grid's times. Throws InputError where they are none.
std::vector<double> grid_times(const FlightSeries& series, const FlightGrid& grid, double end_s) {
    const double span_s = end_s - grid.start_s;
    constexpr double longest_s = 30.0 * 24.0 * units::seconds_per_hour;
    if (!(span_s <= longest_s)) {
        throw InputError({series.file}, fmt::format("lasts {:.4g} s, more than a month", span_s),
                         "are its times in seconds?");
    }
    std::vector<double> time_s(static_cast<std::size_t>(std::floor(span_s / grid.step_s)) + 1);
    for (std::size_t i = 0; i < time_s.size(); ++i) time_s[i] = grid.time_s(i);
    return time_s;
}

void refuse_without_altitude(const FlightSeries& series, const Track& altitude) {
    if (!altitude.empty()) return;
    const auto warnings = warnings_of(series);
    throw InputError(
        {series.file.empty() ? series.flight : series.file}, "has no altitude, so its phases cannot be told apart",
        fmt::format("expected ESTIMATOR, GPS, GPS_INT, AIR_DATA or ROTORCRAFT_FP, or a column altitude_m{}{}",
                    warnings.empty() ? "" : "; ", fmt::join(warnings, "; ")));
}

}  // namespace

FlightGrid make_grid(const ChosenTracks& tracks) {
    const auto& series = tracks.series();
    const auto& raw = tracks["altitude_m"];
    refuse_without_altitude(series, raw);
    FlightGrid grid;
    const auto& power = tracks["power_w"];
    const auto& clock = power.empty() ? raw : power;
    grid.start_s = clock.time_s.front();
    const auto time_s = grid_times(series, grid, clock.time_s.back());
    auto altitude = clean_altitude(raw);  // on its own clock, before the grid's
    grid.unusable = std::move(altitude.unusable);
    grid.warnings = std::move(altitude.warnings);
    if (altitude.altitude.empty()) {
        grid.altitude_m.assign(time_s.size(), 0.0);
        grid.pieces = {{0, time_s.size()}};
    } else {
        add_altitude(grid, altitude, time_s);
    }
    auto motor = motor_record(tracks, altitude.altitude);
    grid.motor_sign = motor.sign;
    grid.motor_evidence = std::move(motor.evidence);
    grid.warnings.insert(grid.warnings.end(), motor.warnings.begin(), motor.warnings.end());
    if (!motor.percent.empty()) grid.motor_percent = resample(motor.percent, time_s);
    if (motor.sign == MotorSign::throttle) grid.throttle_percent = grid.motor_percent;
    const auto& speed = tracks["ground_speed_m_per_s"];
    if (!speed.empty()) grid.ground_speed_m_per_s = without_spikes<5>(resample(speed, time_s));
    return grid;
}

/// Some airframes never report less than a trimmed or armed idle. Where the speed tells rest from flight too, the least
/// throttle of the log is taken for that.
double idle_motor_percent(const FlightGrid& grid, const SegmentationOptions& options) {
    if (grid.motor_sign == MotorSign::power) return idle_power_percent;
    if (grid.motor_percent.empty() || grid.ground_speed_m_per_s.empty()) return options.idle_throttle_percent;
    const double least = *std::min_element(grid.motor_percent.begin(), grid.motor_percent.end());
    return std::max(least, 0.0) + options.idle_throttle_percent;
}

double flight_motor_percent(const FlightGrid& grid, const SegmentationOptions& options) {
    return grid.motor_sign == MotorSign::power ? flight_power_percent : options.flight_throttle_percent;
}

std::vector<GridSpan> find_rests(const FlightGrid& grid, const SegmentationOptions& options) {
    const double idle_percent = idle_motor_percent(grid, options);
    const auto within = [&](const std::vector<double>& channel, std::size_t i, double limit) {
        return channel.empty() || channel[i] <= limit;
    };
    const auto is_still = [&](std::size_t begin, std::size_t end, double height_m) {
        double low = grid.altitude_m[begin];
        double high = low;
        for (std::size_t i = begin; i < end; ++i) {
            low = std::min(low, grid.altitude_m[i]);
            high = std::max(high, grid.altitude_m[i]);
            if (high - low > height_m || !within(grid.motor_percent, i, idle_percent) ||
                !within(grid.ground_speed_m_per_s, i, options.rest_speed_m_per_s)) {
                return false;
            }
        }
        return true;
    };
    // Where neither motor nor speed is known, a height that is kept is that of a rest only near the ground.
    const bool by_altitude = grid.motor_percent.empty() && grid.ground_speed_m_per_s.empty();
    const auto highest_rest_m = [&](const GridSpan& piece) {
        const auto [low, high] = std::minmax_element(grid.altitude_m.begin() + static_cast<std::ptrdiff_t>(piece.begin),
                                                     grid.altitude_m.begin() + static_cast<std::ptrdiff_t>(piece.end));
        return by_altitude ? *low + std::max(options.flight_height_m, 0.25 * (*high - *low)) : *high;
    };
    std::vector<bool> resting(grid.size(), false);
    const auto mark = [&](std::size_t begin, std::size_t end) {
        std::fill(resting.begin() + static_cast<std::ptrdiff_t>(begin),
                  resting.begin() + static_cast<std::ptrdiff_t>(end), true);
    };
    const auto window = grid.steps(options.rest_s) + 1;
    const auto edge = grid.steps(0.3 * options.rest_s) + 1;
    for (const auto& piece : grid.pieces) {
        const double highest_m = highest_rest_m(piece);
        for (std::size_t begin = piece.begin; begin + window <= piece.end; ++begin) {
            if (grid.altitude_m[begin] <= highest_m && is_still(begin, begin + window, options.rest_height_m))
                mark(begin, begin + window);
        }
        if (piece.begin + edge > piece.end) continue;
        // The log may begin just before lift-off or end just after touchdown: there less time does, within less height.
        if (grid.altitude_m[piece.begin] <= highest_m &&
            is_still(piece.begin, piece.begin + edge, 0.3 * options.rest_height_m)) {
            mark(piece.begin, piece.begin + edge);
        }
        if (grid.altitude_m[piece.end - 1] <= highest_m &&
            is_still(piece.end - edge, piece.end, 0.3 * options.rest_height_m))
            mark(piece.end - edge, piece.end);
    }
    const auto gliding = gliding_points(grid, idle_percent, options.flight_height_m);
    std::vector<GridSpan> rests;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        if (!resting[i]) continue;
        const bool begins_piece = std::ranges::binary_search(grid.pieces, i, {}, &GridSpan::begin);
        if (rests.empty() || rests.back().end != i || begins_piece) rests.push_back({i, i});
        rests.back().end = i + 1;
    }
    std::erase_if(rests, [&](const GridSpan& rest) { return gliding[rest.end - 1]; });
    return rests;
}

double median_altitude_m(const FlightGrid& grid, GridSpan span) {
    std::vector<double> values(grid.altitude_m.begin() + static_cast<std::ptrdiff_t>(span.begin),
                               grid.altitude_m.begin() + static_cast<std::ptrdiff_t>(span.end));
    return upper_median(std::move(values));
}

}  // namespace flightwatt::flight
