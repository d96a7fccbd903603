#include "flight/segmentation/flight_grid.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "flight/flight_data.h"
#include "flight/segmentation/altitude_record.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

/// The altitude at the grid's times, piece by piece, without interpolation across jumps.
void add_altitude(ResampledFlight& grid, const CleanedAltitude& record, const std::vector<double>& time_s) {
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
            const auto copy = [](const std::vector<double>& all, IndexSpan span) {
                const auto part = part_of(all, span);
                return std::vector<double>(part.begin(), part.end());
            };
            const Track piece{.time_s = copy(track.time_s, {sample, next_sample}),
                              .value = copy(track.value, {sample, next_sample})};
            const auto altitude_m = running_median<5>(resample(piece, copy(time_s, {begin, end})));
            grid.altitude_m.insert(grid.altitude_m.end(), altitude_m.begin(), altitude_m.end());
            grid.pieces.push_back({begin, end});
            begin = end;
        }
        sample = next_sample;
    }
}

/// Without a speed: the points from which the aircraft descends by the height of a flight or more before the motor runs
/// again. There it glides, even if it keeps its height for a while.
std::vector<bool> gliding_points(const ResampledFlight& grid, double idle_percent, double height_m) {
    std::vector<bool> gliding(grid.size(), false);
    if (grid.motor_percent.empty() || !grid.ground_speed_m_per_s.empty()) return gliding;
    for (const auto& piece : grid.pieces) {
        double min_m = std::numeric_limits<double>::infinity();  // until the motor runs
        for (auto i = piece.end; i-- > piece.begin;) {
            if (grid.motor_percent[i] > idle_percent) min_m = std::numeric_limits<double>::infinity();
            min_m = std::min(min_m, grid.altitude_m[i]);
            gliding[i] = min_m <= grid.altitude_m[i] - height_m;
        }
    }
    return gliding;
}

/// Number of points of the grid. Throws InputError for an implausible duration.
std::size_t size_until(const FlightData& data, const ResampledFlight& grid, double end_s) {
    const double span_s = end_s - grid.start_s;
    constexpr double max_s = 30.0 * 24.0 * units::seconds_per_hour;
    if (!(span_s <= max_s)) {
        throw InputError({data.file}, fmt::format("lasts {:.4g} s, more than a month", span_s),
                         "are its times in seconds?");
    }
    return static_cast<std::size_t>(std::floor(span_s / grid.step_s)) + 1;
}

void require_altitude(const FlightData& data, const Track& altitude) {
    if (!altitude.empty()) return;
    const auto warnings = selection_warnings(data);
    throw InputError(
        {data.file.empty() ? data.flight : data.file}, "has no altitude, so phases cannot be found",
        fmt::format("expected ESTIMATOR, GPS, GPS_INT, AIR_DATA or ROTORCRAFT_FP, or a column altitude_m{}{}",
                    warnings.empty() ? "" : "; ", fmt::join(warnings, "; ")));
}

}  // namespace

std::vector<double> ResampledFlight::times_s(IndexSpan span) const {
    std::vector<double> times(span.end - span.begin);
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = time_s(span.begin + i);
    return times;
}

ResampledFlight make_grid(const FlightData& data) {
    const auto& raw = data.altitude_m;
    require_altitude(data, raw);
    ResampledFlight grid;
    const auto& power = data.power_w;
    const auto& clock = power.empty() ? raw : power;
    grid.start_s = clock.time_s.front();
    const auto time_s = grid.times_s({0, size_until(data, grid, clock.time_s.back())});
    auto altitude = clean_altitude(raw);  // on its own clock
    grid.unusable = std::move(altitude.unusable_reason);
    grid.warnings = std::move(altitude.warnings);
    if (altitude.altitude.empty()) {
        grid.altitude_m.assign(time_s.size(), 0.0);
        grid.pieces = {{0, time_s.size()}};
    } else {
        add_altitude(grid, altitude, time_s);
    }
    auto motor = motor_record(data, altitude.altitude);
    grid.motor_indicator = motor.indicator;
    grid.motor_evidence = std::move(motor.evidence);
    grid.warnings.insert(grid.warnings.end(), motor.warnings.begin(), motor.warnings.end());
    if (!motor.percent.empty()) {
        grid.motor_percent = resample(motor.percent, time_s);
        grid.min_motor_percent = *std::ranges::min_element(grid.motor_percent);
    }
    if (motor.indicator == MotorIndicator::throttle) grid.throttle_percent = grid.motor_percent;
    const auto& speed = data.ground_speed_m_per_s;
    if (!speed.empty()) grid.ground_speed_m_per_s = running_median<5>(resample(speed, time_s));
    return grid;
}

/// Some airframes never report less than a trimmed or armed idle. With a speed to identify rests, the minimum throttle
/// of the log counts as idle.
double idle_motor_percent(const ResampledFlight& grid, const SegmentationOptions& options) {
    if (grid.motor_indicator == MotorIndicator::power) return idle_power_percent;
    if (grid.motor_percent.empty() || grid.ground_speed_m_per_s.empty()) return options.idle_throttle_percent;
    return std::max(grid.min_motor_percent, 0.0) + options.idle_throttle_percent;
}

double flight_motor_percent(const ResampledFlight& grid, const SegmentationOptions& options) {
    return grid.motor_indicator == MotorIndicator::power ? flight_power_percent : options.flight_throttle_percent;
}

std::vector<IndexSpan> find_rests(const ResampledFlight& grid, const SegmentationOptions& options) {
    const double idle_percent = idle_motor_percent(grid, options);
    const auto within = [&](const std::vector<double>& channel, std::size_t i, double limit) {
        return channel.empty() || channel[i] <= limit;
    };
    const auto is_idle = [&](std::size_t i) {
        return within(grid.motor_percent, i, idle_percent) &&
               within(grid.ground_speed_m_per_s, i, options.rest_speed_m_per_s);
    };
    const auto is_still = [&](std::size_t begin, std::size_t end, double height_m) {
        const auto [low_m, high_m] = std::ranges::minmax(part_of(grid.altitude_m, {begin, end}));
        for (auto i = begin; i < end; ++i)
            if (!is_idle(i)) return false;
        return high_m - low_m <= height_m;
    };
    // Without motor and speed, a constant height is that of a rest only near the ground.
    const bool by_altitude = grid.motor_percent.empty() && grid.ground_speed_m_per_s.empty();
    const auto max_rest_m = [&](const IndexSpan& piece) {
        const auto [low_m, high_m] = std::ranges::minmax(part_of(grid.altitude_m, piece));
        return by_altitude ? low_m + std::max(options.flight_height_m, 0.25 * (high_m - low_m)) : high_m;
    };
    std::vector<bool> resting(grid.size(), false);
    const auto window = grid.steps(options.rest_s) + 1;
    const auto edge = grid.steps(0.3 * options.rest_s) + 1;
    for (const auto& piece : grid.pieces) {
        const double max_m = max_rest_m(piece);
        std::size_t idle = 0;  // consecutive points
        auto marked = piece.begin;
        for (auto end = piece.begin + 1; end <= piece.end; ++end) {
            idle = is_idle(end - 1) ? idle + 1 : 0;
            if (idle < window || grid.altitude_m[end - window] > max_m) continue;
            const auto [low_m, high_m] = std::ranges::minmax(part_of(grid.altitude_m, {end - window, end}));
            if (high_m - low_m > options.rest_height_m) continue;
            set_part(resting, {std::max(marked, end - window), end}, true);
            marked = end;
        }
        if (piece.begin + edge > piece.end) continue;
        // The log may begin just before lift-off or end just after touchdown: there a shorter rest is enough, if its
        // height is more constant.
        if (grid.altitude_m[piece.begin] <= max_m &&
            is_still(piece.begin, piece.begin + edge, 0.3 * options.rest_height_m)) {
            set_part(resting, {piece.begin, piece.begin + edge}, true);
        }
        if (grid.altitude_m[piece.end - 1] <= max_m &&
            is_still(piece.end - edge, piece.end, 0.3 * options.rest_height_m))
            set_part(resting, {piece.end - edge, piece.end}, true);
    }
    const auto gliding = gliding_points(grid, idle_percent, options.flight_height_m);
    // A rest does not extend across a jump of the altitude.
    auto rests = runs_of(
        {0, grid.size()}, [&](std::size_t i) { return resting[i]; },
        [&](std::size_t i) { return !std::ranges::binary_search(grid.pieces, i, {}, &IndexSpan::begin); });
    std::erase_if(rests, [&](const IndexSpan& rest) { return gliding[rest.end - 1]; });
    return rests;
}

double median_altitude_m(const ResampledFlight& grid, IndexSpan span) {
    const auto altitude_m = part_of(grid.altitude_m, span);
    return median_high({altitude_m.begin(), altitude_m.end()});
}

}  // namespace flightwatt::flight
