#include "flight/segment/flight_grid.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "flight/segment/altitude_record.h"

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
        const auto end = last ? time_s.size() : first_at_or_after(time_s, record.jumps_s[p]);
        const auto next_sample = last ? track.time_s.size() : first_at_or_after(track.time_s, record.jumps_s[p]);
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

/// The time of the last sample of power, without power of altitude. After a slow power, the altitude of one interval
/// counts too: there is the touchdown in a log that ends when the motors are disarmed.
double segmented_until_s(const FlightData& data) {
    const auto& altitude_s = data.altitude_m.time_s;
    const auto& power_s = data.power_w.time_s;
    if (power_s.empty()) return altitude_s.back();
    const double interval_s = median_interval_s(power_s);
    if (interval_s <= slow_power_s) return power_s.back();
    return std::clamp(altitude_s.back(), power_s.back(), power_s.back() + interval_s);
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

/// The altitude where it is known: that of ESTIMATOR, of Paparazzi's wings, is a receiver's, which has none without a
/// fix. After a reboot it is 0.
Track altitude_with_fix(const FlightData& data) {
    Track altitude = data.altitude_m;
    const auto& fix = data.fix;
    if (!altitude.source.starts_with("ESTIMATOR") || std::ranges::count(fix.value, 1.0) == 0) return altitude;
    std::size_t after = 0;
    erase_samples(altitude, [&](std::size_t i) {
        while (after < fix.time_s.size() && fix.time_s[after] <= altitude.time_s[i]) ++after;
        return fix.value[std::max<std::size_t>(after, 1) - 1] == 0.0 ||
               fix.value[std::min(after, fix.value.size() - 1)] == 0.0;
    });
    return altitude;
}

/// The longest interval between samples between which a quantity is known [s].
double known_interval_s(const std::vector<double>& sample_s) {
    return std::max(long_gap_s, 3.0 * median_interval_s(sample_s));
}

/// The speed at other times; where it is not known, the lower one of both sides, and 0 beyond the ends.
std::vector<double> shown_speed(const Track& speed, const std::vector<double>& time_s) {
    auto speed_m_per_s = resample(speed, time_s);
    const double known_s = known_interval_s(speed.time_s);
    for (std::size_t i = 0; i < time_s.size(); ++i) {
        if (interval_around_s(speed.time_s, time_s[i]) <= known_s) continue;
        const auto after = std::ranges::upper_bound(speed.time_s, time_s[i]) - speed.time_s.begin();
        const bool is_outside = after == 0 || after == std::ssize(speed.time_s);
        const auto* const at = speed.value.data() + after;
        speed_m_per_s[i] = is_outside ? 0.0 : std::min(*(at - 1), *at);
    }
    return speed_m_per_s;
}

/// An aircraft whose motor runs on both sides of a jump flies on: these do not separate pieces.
void keep_jumps_in_flight(ResampledFlight& grid, const Track& motor_percent, CleanedAltitude& record) {
    if (motor_percent.empty()) return;
    const auto& time_s = record.altitude.time_s;
    const auto& altitude_m = record.altitude.value;
    const auto runs_at = [&](double t) { return value_at(motor_percent, t) > idle_motor_percent(grid, {}); };
    std::erase_if(record.jumps_s, [&](double t) {
        const auto i = first_at_or_after(time_s, t);
        if (!runs_at(time_s[i - 1]) || !runs_at(t)) return false;
        grid.jumps_in_flight.time_s.push_back(t);
        grid.jumps_in_flight.value.push_back(std::abs(altitude_m[i] - altitude_m[i - 1]));
        return true;
    });
}

void require_altitude(const FlightData& data, const Track& altitude) {
    if (!altitude.empty()) return;
    const auto warnings = texts_of(selection_diagnostics(data));
    throw InputError(
        {data.file.empty() ? data.flight : data.file}, "has no altitude, so phases cannot be found",
        fmt::format("expected ESTIMATOR, GPS, GPS_INT, AIR_DATA or ROTORCRAFT_FP, or a column altitude_m{}{}",
                    warnings.empty() ? "" : "; ", fmt::join(warnings, "; ")));
}

}  // namespace

double interval_around_s(const std::vector<double>& sample_s, double time_s) {
    if (sample_s.empty()) return std::numeric_limits<double>::infinity();
    const auto after = std::ranges::upper_bound(sample_s, time_s);
    if (after == sample_s.begin()) return *after - time_s;
    return after == sample_s.end() ? time_s - sample_s.back() : *after - *(after - 1);
}

std::vector<double> ResampledFlight::times_s(IndexSpan span) const {
    std::vector<double> times(span.end - span.begin);
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = time_s(span.begin + i);
    return times;
}

ResampledFlight make_grid(const FlightData& data) {
    require_altitude(data, data.altitude_m);
    ResampledFlight grid;
    grid.start_s = (data.power_w.empty() ? data.altitude_m : data.power_w).time_s.front();
    const auto time_s = grid.times_s({0, size_until(data, grid, segmented_until_s(data))});
    auto altitude = clean_altitude(altitude_with_fix(data));  // on its own clock
    grid.unusable = std::move(altitude.unusable_reason);
    grid.warnings = std::move(altitude.warnings);
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
    if (!speed.empty()) grid.ground_speed_m_per_s = running_median<5>(shown_speed(speed, time_s));
    keep_jumps_in_flight(grid, motor.percent, altitude);
    if (altitude.altitude.empty()) {
        grid.altitude_m.assign(time_s.size(), 0.0);
        grid.pieces = {{0, time_s.size()}};
    } else {
        add_altitude(grid, altitude, time_s);
    }
    grid.altitude_time_s = std::move(altitude.altitude.time_s);
    const double known_s = known_interval_s(grid.altitude_time_s);
    for (const double t : time_s) grid.has_altitude.push_back(interval_around_s(grid.altitude_time_s, t) <= known_s);
    return grid;
}

/// Some airframes never report less than a trimmed or armed idle. With a speed to identify rests, the minimum throttle
/// of the log counts as idle.
double idle_motor_percent(const ResampledFlight& grid, const SegmentationOptions& options) {
    if (grid.motor_indicator == MotorIndicator::power) return idle_power_percent;
    if (grid.motor_percent.empty() || grid.ground_speed_m_per_s.empty()) return options.idle_throttle_percent;
    return std::min(std::max(grid.min_motor_percent, 0.0) + options.idle_throttle_percent,
                    options.flight_throttle_percent);
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
    // Without motor and speed, a constant height is that of a rest only near the ground.
    const bool by_altitude = grid.motor_percent.empty() && grid.ground_speed_m_per_s.empty();
    const bool by_motion = !grid.motor_percent.empty() && !grid.ground_speed_m_per_s.empty();
    std::vector<bool> resting(grid.size(), false);
    const auto window = grid.steps(options.rest_s) + 1;
    const auto edge = grid.steps(0.3 * options.rest_s) + 1;
    for (const auto& piece : grid.pieces) {
        const auto [low_m, high_m] = std::ranges::minmax(part_of(grid.altitude_m, piece));
        const double max_m = by_altitude ? low_m + std::max(options.flight_height_m, 0.25 * (high_m - low_m)) : high_m;
        const auto is_still = [&](IndexSpan span, double height_m) {
            const auto altitude_m = part_of(grid.altitude_m, span);
            const auto [lowest_m, highest_m] = std::ranges::minmax(altitude_m);
            const double moved_m = by_motion ? altitude_m.front() - altitude_m.back() : highest_m - lowest_m;
            return altitude_m.front() <= max_m && moved_m <= height_m;
        };
        for (const auto& idle : runs_of(piece, is_idle)) {
            auto marked = idle.begin;
            for (auto end = idle.begin + window; end <= idle.end && marked < idle.end; ++end) {
                if (!is_still({end - window, end}, options.rest_height_m)) continue;
                const auto begin = std::max(marked, end - window);
                marked = by_motion ? idle.end : end;  // from the ground, only a running motor lifts it
                set_part(resting, {begin, marked}, true);
            }
            // The log may begin just before lift-off or end just after touchdown: there a shorter rest is enough, if
            // its height is more constant.
            const IndexSpan first{piece.begin, piece.begin + edge};
            const IndexSpan last{piece.end - std::min(edge, piece.size()), piece.end};
            for (const auto& at_edge : {first, last})
                if (at_edge.begin >= idle.begin && at_edge.end <= idle.end &&
                    is_still(at_edge, 0.3 * options.rest_height_m))
                    set_part(resting, at_edge, true);
        }
    }
    const auto gliding = gliding_points(grid, idle_percent, options.flight_height_m);
    // A rest does not extend across a jump of the altitude.
    auto rests = runs_of(
        {0, grid.size()}, [&](std::size_t i) { return resting[i]; },
        [&](std::size_t i) { return !std::ranges::binary_search(grid.pieces, i, {}, &IndexSpan::begin); });
    std::erase_if(rests, [&](const IndexSpan& rest) { return gliding[rest.end - 1]; });
    return rests;
}

}  // namespace flightwatt::flight
