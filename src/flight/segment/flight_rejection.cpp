#include "flight/segment/flight_rejection.h"

#include "base/statistics.h"
#include "base/units.h"
#include "flight/segment/hover_record.h"
#include "flight/select/outliers.h"
#include "flight/series_file.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

// Reasons: docs/methods.md.
constexpr double max_climb_5_s_m_per_s = 60.0;
constexpr double max_climb_30_s_m_per_s = 30.0;
constexpr double max_gps_motion_fraction = 0.25;  // of the altitude's, if it contradicts it
constexpr double min_confirming_fraction = 0.5;   // of the altitude's, if it confirms it
constexpr double min_hover_m = 0.3;               // of motion, above a barometer's noise
constexpr double min_time_aloft_s = 15.0;         // above half of its height, without motor data
constexpr double min_height_factor = 2.0;         // of flight_height_m, without motor data and speed
constexpr double road_slope = 0.03;
constexpr double road_tolerance_m = 2.0;  // error of an altitude
constexpr double position_window_s = 10.0;
constexpr double standing_extent_m = 30.0;
// At this airspeed, such a gain of energy height in this time takes a motor or a thermal.
constexpr double min_airspeed_m_per_s = 7.0;
constexpr double climb_window_s = 20.0;
constexpr double climbed_by_motor_m = 15.0;
constexpr double min_cruise_s = 60.0;    // of a log without ground, at flying speed
constexpr std::size_t min_reports = 10;  // of a land detector that reports all the time, not only changes
constexpr std::size_t min_changes = 10;  // of values: a receiver without a fix repeats its last one

std::vector<double> sorted(std::span<const double> values) {
    std::vector<double> in_order(values.begin(), values.end());
    std::ranges::sort(in_order);
    return in_order;
}

/// The speed that is exceeded for a tenth of the time.
double fast_speed(std::span<const double> speeds) { return quantile(sorted(speeds), 0.9); }

/// The value that is exceeded for nine tenths of the time.
double usual_least(std::span<const double> values) { return quantile(sorted(values), 0.1); }

/// Range from the 5th to the 95th percentile.
double spread_of(std::span<const double> values) {
    const auto in_order = sorted(values);
    return quantile(in_order, 0.95) - quantile(in_order, 0.05);
}

const std::string& altitude_source(const FlightCandidate& c) { return c.data.altitude_m.source; }

/// The altitude of a rotorcraft is above the ground.
bool is_above_ground(const FlightCandidate& c) { return altitude_source(c).starts_with("ROTORCRAFT_FP"); }

/// The values of an activity above half of its height.
std::vector<double> when_high(std::span<const double> values, const Heights& heights) {
    std::vector<double> high;
    high.reserve(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        if (heights.height_m[i] > 0.5 * heights.max_m) high.push_back(values[i]);
    return high;
}

/// The values of a track within a span and the bounds of altitudes.
std::vector<double> altitudes_within(const Track& track, const ResampledFlight& grid, IndexSpan span) {
    const double end_s = grid.time_s(span.end - 1);
    const auto bounds = physical_bounds("altitude_m").value();
    std::vector<double> values;
    const auto first = first_at_or_after(track.time_s, grid.time_s(span.begin));
    values.reserve(track.time_s.size() - first);
    for (auto i = first; i < track.time_s.size() && track.time_s[i] <= end_s; ++i) {
        if (track.value[i] >= bounds.low && track.value[i] <= bounds.high) values.push_back(track.value[i]);
    }
    return values;
}

/// The values of an activity in which it is in the air, if anywhere: with the motor of a flight, else above half of its
/// height.
std::vector<double> when_flown(std::span<const double> values, const FlightCandidate& c) {
    if (c.grid.motor_indicator == MotorIndicator::unknown || c.is_motor_off()) return when_high(values, c.heights);
    const auto motor_percent = part_of(c.grid.motor_percent, c.activity.span);
    std::vector<double> flown;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (motor_percent[i] >= flight_motor_percent(c.grid, c.options)) flown.push_back(values[i]);
    return flown;
}

/// Whether motor and motion show a flight while the altitude cannot.
bool flies_by_motion(const FlightCandidate& c) {
    if (!c.heights.are_unknown() || c.heights.wander_m < c.options.flight_height_m || c.is_motor_off()) return false;
    const auto& speed = c.grid.ground_speed_m_per_s;
    return !c.grid.motor_percent.empty() && !speed.empty() &&
           fast_speed(when_flown(part_of(speed, c.activity.span), c)) >= min_flight_m_per_s;
}

std::size_t changes_within(const Track& track, const ResampledFlight& grid, IndexSpan span) {
    const double start_s = grid.time_s(span.begin);
    const double end_s = grid.time_s(span.end - 1);
    std::size_t changes = 0;
    for (std::size_t i = 1; i < track.value.size(); ++i) {
        const bool is_within = track.time_s[i - 1] >= start_s && track.time_s[i] <= end_s;
        changes += is_within && track.value[i] != track.value[i - 1] ? 1 : 0;
    }
    return changes;
}

std::string has_no_altitude(const FlightCandidate& c) {
    const auto& moving = c.activity.moving;
    for (auto i = moving.begin; i < moving.end; ++i)
        if (c.grid.has_altitude[i]) return "";
    return fmt::format("no altitude is known{}: nothing shows a flight", c.data.fix.empty() ? "" : ", without a fix");
}

std::string stays_low(const FlightCandidate& c) {
    if (c.heights.max_m >= c.options.flight_height_m || flies_by_motion(c) || is_cruise_alone(c)) return "";
    const double height_m = std::max(c.heights.max_m, 0.0);
    const double motor_percent = c.max_motor_percent();
    const bool by_power = c.grid.motor_indicator == MotorIndicator::power;
    if (c.grid.motor_indicator == MotorIndicator::unknown)
        return fmt::format("carried, rolled or hop: height to {:.1f} m, motor unknown", height_m);
    if (motor_percent <= (by_power ? idle_power_percent : c.options.idle_throttle_percent))
        return fmt::format("carried or rolled: height to {:.1f} m, {}", height_m,
                           by_power ? "power at its idle" : "motor off");
    const auto motor =
        by_power ? std::string("power of a running motor")
                 : fmt::format("{} to {:.0f} %",
                               c.grid.motor_indicator == MotorIndicator::throttle ? "throttle" : "motor speed",
                               motor_percent);
    return fmt::format("run-up, taxi or hop: {}, height to {:.1f} m", motor, height_m);
}

/// A rotorcraft's motors run as in flight, but it does not leave the ground.
std::string stays_on_ground(const FlightCandidate& c) {
    const auto& moving = c.activity.moving;
    const auto& detector = c.grid.detector;
    const double start_s = c.grid.time_s(moving.begin);
    if (!detector.empty() && state_at(detector, start_s) == 1.0 &&
        !changes_to(detector, 0.0, start_s, c.grid.time_s(moving.end - 1)))
        return "run-up: the autopilot states that it is on the ground";
    const bool is_stated_aloft = !c.activity.begins_at_rest() && !c.activity.ends_at_rest() &&
                                 detector.value.size() >= min_reports &&
                                 std::ranges::count(detector.value, 0.0) == std::ssize(detector.value);
    const auto [low_m, high_m] = std::ranges::minmax(part_of(c.grid.altitude_m, moving));
    const bool leaves_ground = is_stated_aloft || high_m - low_m >= min_hover_m;
    if (c.max_motor_percent() >= c.options.flight_throttle_percent && leaves_ground) return "";
    return fmt::format("run-up: motors to {:.0f} %, altitude within {:.1f} m", c.max_motor_percent(), high_m - low_m);
}

/// Whether energy height is gained within a window of flying speed.
bool flies_by_airspeed(const FlightCandidate& c) {
    if (!c.data.airspeed_is_measured()) return false;
    const auto speed = resample(c.data.airspeed_m_per_s, c.grid.times_s(c.activity.span));
    const auto altitude_m = part_of(c.grid.altitude_m, c.activity.span);
    const auto energy_height_m = [&](std::size_t i) {
        return altitude_m[i] + speed[i] * speed[i] / (2.0 * units::standard_gravity_m_per_s2);
    };
    const auto steps = c.grid.steps(climb_window_s);
    std::size_t flying = 0;  // points in a row at flying speed
    for (std::size_t i = 0; i < speed.size(); ++i) {
        flying = speed[i] >= min_airspeed_m_per_s ? flying + 1 : 0;
        if (flying > steps && energy_height_m(i) - energy_height_m(i - steps) >= climbed_by_motor_m) return true;
    }
    return false;
}

std::string rises_without_motor(const FlightCandidate& c) {
    if (!c.is_motor_off() || flies_by_airspeed(c)) return "";
    return fmt::format("altitude changed by {:.0f} m with {}: its estimator has no fix", c.heights.max_m,
                       c.grid.motor_indicator == MotorIndicator::power ? "the power at its idle" : "the motor off");
}

std::string climbs_too_fast(const FlightCandidate& c) {
    if (flies_by_motion(c)) return "";
    const auto altitude_m = part_of(c.grid.altitude_m, c.activity.span);
    for (const auto& [over_s, limit] :
         {std::pair{5.0, max_climb_5_s_m_per_s}, std::pair{30.0, max_climb_30_s_m_per_s}}) {
        const auto steps = c.grid.steps(over_s);
        double max_m_per_s = 0.0;
        for (std::size_t i = 0; i + steps < altitude_m.size(); ++i)
            max_m_per_s = std::max(max_m_per_s, std::abs(altitude_m[i + steps] - altitude_m[i]) / over_s);
        if (max_m_per_s > limit) {
            return fmt::format(
                "altitude changes by {:.0f} m/s for {:.0f} s: its estimator diverged, or its unit is not m",
                max_m_per_s, over_s);
        }
    }
    return "";
}

/// A GPS with a fix shows no motion, and no other altitude confirms the motion.
std::string is_contradicted(const FlightCandidate& c) {
    const auto& chosen = c.data.altitude_m;
    const auto own = altitudes_within(chosen, c.grid, c.activity.moving);
    const double own_m = own.empty() ? 0.0 : spread_of(own);
    if (own_m < c.options.flight_height_m) return "";
    std::string contradicts;
    for (const auto& track : c.data.other_altitudes) {
        const auto other = altitudes_within(track, c.grid, c.activity.moving);
        const double other_m = other.empty() ? 0.0 : spread_of(other);
        if (other_m >= min_confirming_fraction * own_m) return "";
        const bool is_alive =
            other.size() >= min_changes && 2 * changes_within(track, c.grid, c.activity.moving) >= other.size();
        const bool is_still = other_m < max_gps_motion_fraction * own_m && other_m < 0.5 * c.options.flight_height_m;
        if (is_alive && is_still && track.source.starts_with("GPS")) {
            contradicts = fmt::format("{} changes by {:.0f} m, {} by {:.1f} m: its estimator diverged", chosen.source,
                                      own_m, track.source, other_m);
        }
    }
    return contradicts;
}

/// Only the altitude shows a flight, and it is as short, low or slow as the convergence of an estimator.
std::string only_settles(const FlightCandidate& c) {
    if (c.grid.motor_indicator != MotorIndicator::unknown) return "";
    const auto seen = fmt::format("only the altitude shows a height of {:.0f} m", c.heights.max_m);
    const auto high_s = static_cast<double>(when_high(c.heights.height_m, c.heights).size()) * c.grid.step_s;
    if (high_s < min_time_aloft_s) return fmt::format("{}, for {:.0f} s: its estimator converged", seen, high_s);
    if (c.grid.ground_speed_m_per_s.empty()) {
        const bool is_low = c.heights.max_m < min_height_factor * c.options.flight_height_m;
        return is_low ? seen + ": its estimator converged" : "";
    }
    const double speed = fast_speed(when_high(part_of(c.grid.ground_speed_m_per_s, c.activity.span), c.heights));
    if (is_above_ground(c) || speed >= min_flight_m_per_s) return "";
    return fmt::format("{}, at {:.1f} m/s over ground: its estimator converged", seen, speed);
}

/// From ground to ground, with slopes of roads.
std::string moves_on_a_road(const FlightCandidate& c) {
    const auto& span = c.activity.span;
    if (!c.activity.begins_at_rest() || !c.activity.ends_at_rest() || c.grid.ground_speed_m_per_s.empty()) return "";
    constexpr double max_interval_s = 5.0;  // rarer altitudes give no slope
    const auto altitudes = altitudes_within(c.data.altitude_m, c.grid, span).size();
    if (static_cast<double>(altitudes) * max_interval_s < c.grid.time_s(span.end - 1) - c.grid.time_s(span.begin))
        return "";
    std::vector<double> way_m{0.0};
    way_m.reserve(span.end - span.begin + 1);
    for (const double speed : part_of(c.grid.ground_speed_m_per_s, span))
        way_m.push_back(way_m.back() + speed * c.grid.step_s);
    const auto altitude_m = part_of(c.grid.altitude_m, span);
    for (const double over_s : {5.0, 10.0, 30.0}) {
        const auto steps = c.grid.steps(over_s);
        for (std::size_t i = 0; i + steps < altitude_m.size(); ++i) {
            const double climbed_m = std::abs(altitude_m[i + steps] - altitude_m[i]);
            if (climbed_m > road_slope * (way_m[i + steps] - way_m[i]) + road_tolerance_m) return "";
        }
    }
    return fmt::format("altitude never changes by more than {:.0f} % of the distance, from ground to ground: driven",
                       units::percentage(road_slope, 1.0));
}

/// No ground, no climb, and the speed of a ground vehicle. Not for a rotorcraft, which hovers, nor for a user's CSV.
std::string only_drives(const FlightCandidate& c) {
    const auto& moving = c.activity.moving;
    if (c.activity.begins_at_rest() || c.activity.ends_at_rest() || c.grid.ground_speed_m_per_s.empty()) return "";
    if (is_above_ground(c) || altitude_source(c) == plain_source) return "";
    const auto [low_m, high_m] = std::ranges::minmax(part_of(c.grid.altitude_m, moving));
    const double speed = fast_speed(part_of(c.grid.ground_speed_m_per_s, moving));
    if (high_m - low_m >= c.options.flight_height_m || speed >= min_flight_m_per_s) return "";
    return fmt::format(
        "altitude changes by at most {:.1f} m, without a rest, at {:.1f} m/s over ground: driven or carried",
        high_m - low_m, speed);
}

/// Measured ground speed and position show no flight while the altitude does. Not for a rotorcraft, which hovers; a
/// fixed wing may fly against the wind, but not within the width of a field.
std::string stands_still(const FlightCandidate& c) {
    if (altitude_source(c) == plain_source || is_above_ground(c) || c.data.firmware == "rotorcraft") return "";
    const auto time_s = c.grid.times_s(c.activity.span);
    const auto is_dead = [&](const Track& track) {
        return changes_within(track, c.grid, c.activity.span) < min_changes;
    };
    if (is_dead(c.data.ground_speed_m_per_s) || is_dead(c.data.east_m) || is_dead(c.data.north_m)) return "";
    const auto east_m = resample(c.data.east_m, time_s);
    const auto north_m = resample(c.data.north_m, time_s);
    const double speed = fast_speed(when_flown(resample(c.data.ground_speed_m_per_s, time_s), c));
    if (speed >= min_flight_m_per_s) return "";
    const auto steps = c.grid.steps(position_window_s);
    std::vector<double> by_position(time_s.size(), 0.0);  // speed over the window
    for (std::size_t i = steps; i < by_position.size(); ++i)
        by_position[i] = std::hypot(east_m[i] - east_m[i - steps], north_m[i] - north_m[i - steps]) / position_window_s;
    if (fast_speed(when_flown(by_position, c)) >= min_flight_m_per_s) return "";
    const double extent_m = std::max(spread_of(when_flown(east_m, c)), spread_of(when_flown(north_m, c)));
    if (c.data.airspeed_is_measured() && extent_m >= standing_extent_m) return "";
    return fmt::format(
        "altitude shows a height of {:.0f} m, but the aircraft moves at {:.1f} m/s over ground, within {:.0f} m: not "
        "moved or carried",
        c.heights.max_m, speed, extent_m);
}

using Rejection = std::string (*)(const FlightCandidate&);

/// The first reason counts.
constexpr Rejection rejections[] = {has_no_altitude, stays_low,       rises_without_motor,
                                    climbs_too_fast, is_contradicted, only_settles,
                                    moves_on_a_road, only_drives,     stands_still};

constexpr Rejection rotorcraft_rejections[] = {stays_on_ground, climbs_too_fast};

}  // namespace

double FlightCandidate::max_motor_percent() const {
    return grid.motor_percent.empty() ? 0.0 : std::ranges::max(part_of(grid.motor_percent, activity.span));
}

bool FlightCandidate::is_motor_off() const {
    return grid.motor_indicator != MotorIndicator::unknown && max_motor_percent() < flight_motor_percent(grid, options);
}

bool is_cruise_alone(const FlightCandidate& c) {
    const auto& [moving, span, before, after] = c.activity;
    if (c.data.firmware != "fixedwing" || c.activity.begins_at_rest() || c.activity.ends_at_rest()) return false;
    if (c.grid.motor_percent.empty() || c.grid.ground_speed_m_per_s.empty()) return false;
    return c.heights.max_m < c.options.flight_height_m && moving.size() >= c.grid.steps(min_cruise_s) &&
           usual_least(part_of(c.grid.motor_percent, moving)) >= flight_motor_percent(c.grid, c.options) &&
           usual_least(part_of(c.grid.ground_speed_m_per_s, moving)) >= min_flight_m_per_s;
}

std::string ground_vehicle_reason(const FlightData& data) {
    if (!data.rover_mode.empty()) return "a ground vehicle: it sends ROVER_STATUS";
    if (data.firmware == "rover") return "a ground vehicle: its airframe's firmware is rover";
    return "";
}

std::string no_flight_reason(const FlightCandidate& candidate) {
    const std::span<const Rejection> rules =
        candidate.grid.hovers.empty() ? std::span<const Rejection>(rejections) : rotorcraft_rejections;
    for (const auto rejection : rules)
        if (auto reason = rejection(candidate); !reason.empty()) return reason;
    return "";
}

std::string motor_contradiction(const FlightCandidate& c) {
    if (!c.is_motor_off()) return "";
    return fmt::format(
        "the motor is off by {} from {:.0f} to {:.0f} s, but airspeed and climb show a flight: the latter are used",
        c.grid.motor_evidence, c.grid.time_s(c.activity.moving.begin), c.grid.time_s(c.activity.moving.end - 1));
}

}  // namespace flightwatt::flight
