#include "flight/segmentation/flight_rejection.h"

#include "base/statistics.h"
#include "base/units.h"
#include "flight/selected_track.h"
#include "flight/series_file.h"
#include "flight/sources/outliers.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

double max_motor_percent(const ResampledFlight& grid, GridSpan span) {
    if (grid.motor_percent.empty()) return 0.0;
    return *std::max_element(grid.motor_percent.begin() + static_cast<std::ptrdiff_t>(span.begin),
                             grid.motor_percent.begin() + static_cast<std::ptrdiff_t>(span.end));
}

/// What stays below the height of a flight.
std::string low_text(const ResampledFlight& grid, double motor_percent, double height_m,
                     const SegmentationOptions& options) {
    height_m = std::max(height_m, 0.0);
    if (grid.motor_sign == MotorIndicator::unknown) {
        return fmt::format("carried, rolled or hop: height to {:.1f} m; nothing tells of the motor", height_m);
    }
    const bool by_power = grid.motor_sign == MotorIndicator::power;
    if (motor_percent <= (by_power ? idle_power_percent : options.idle_throttle_percent)) {
        return fmt::format("carried or rolled: height to {:.1f} m, {}", height_m,
                           by_power ? "power at its idle" : "motor off");
    }
    return by_power
               ? fmt::format("run-up, taxi or hop: power of a running motor, height to {:.1f} m", height_m)
               : fmt::format("run-up, taxi or hop: throttle to {:.0f} %, height to {:.1f} m", motor_percent, height_m);
}

/// How fast the altitude changes at most over a time within the span [m/s].
double max_m_per_s(const ResampledFlight& grid, GridSpan span, double over_s) {
    const auto steps = grid.steps(over_s);
    double fastest = 0.0;
    for (auto i = span.begin; i + steps < span.end; ++i) {
        fastest = std::max(fastest, std::abs(grid.altitude_m[i + steps] - grid.altitude_m[i]) / over_s);
    }
    return fastest;
}

/// From the 5th to the 95th percentile.
double spread_of(std::vector<double> values) {
    std::ranges::sort(values);
    return quantile(values, 0.95) - quantile(values, 0.05);
}

/// The values of a track within a time, as far as they are altitudes.
std::vector<double> altitudes_within(const Track& track, double start_s, double end_s) {
    const auto bounds = physical_bounds("altitude_m").value();
    std::vector<double> values;
    const auto first = std::ranges::lower_bound(track.time_s, start_s) - track.time_s.begin();
    values.reserve(track.time_s.size() - static_cast<std::size_t>(first));
    for (auto i = static_cast<std::size_t>(first); i < track.time_s.size() && track.time_s[i] <= end_s; ++i) {
        if (track.value[i] >= bounds.low && track.value[i] <= bounds.high) values.push_back(track.value[i]);
    }
    return values;
}

/// Whether a receiver is alive: without a fix it repeats its last value.
bool is_alive(const std::vector<double>& values) {
    constexpr std::size_t enough = 10;
    std::size_t changes = 0;
    for (std::size_t i = 1; i < values.size(); ++i) changes += values[i] != values[i - 1] ? 1 : 0;
    return values.size() >= enough && 2 * changes >= values.size();
}

/// A GPS that says that nothing moved, where no other altitude of the log does: "ESTIMATOR.z moves by 40 m, GPS.alt by
/// 2.0 m"; empty if there is none.
std::string contradiction(const SelectedTracks& tracks, const ResampledFlight& grid, const Activity& activity,
                          const SegmentationOptions& options) {
    const double start_s = grid.time_s(activity.moving.begin);
    const double end_s = grid.time_s(activity.moving.end - 1);
    const auto& chosen = tracks["altitude_m"];
    const auto own = altitudes_within(chosen, start_s, end_s);
    const double own_m = own.empty() ? 0.0 : spread_of(own);
    if (own_m < options.flight_height_m) return "";
    std::string contradicts;
    for (const auto& track : tracks.series().tracks) {
        if (track.name != "altitude_m" || track.source == chosen.source) continue;
        const auto other = altitudes_within(track, start_s, end_s);
        const double other_m = other.empty() ? 0.0 : spread_of(other);
        if (other_m >= min_confirming_fraction * own_m) return "";
        const bool stands =
            is_alive(other) && other_m < max_gps_motion_fraction * own_m && other_m < 0.5 * options.flight_height_m;
        if (stands && track.source.starts_with("GPS")) {
            contradicts = fmt::format("{} moves by {:.0f} m, {} by {:.1f} m: an estimator that ran away", chosen.source,
                                      own_m, track.source, other_m);
        }
    }
    return contradicts;
}

/// Those of an activity's values that were taken above half of its height, in order of size.
std::vector<double> sorted_when_high(const std::vector<double>& values, const Heights& heights) {
    std::vector<double> high;
    high.reserve(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        if (heights.height_m[i] > 0.5 * heights.max_m) high.push_back(values[i]);
    std::ranges::sort(high);
    return high;
}

/// Whether an activity that shows no ground, and no climb, is as slow as what drives.
std::string why_only_driven(const SelectedTracks& tracks, const ResampledFlight& grid, const Activity& activity,
                            const SegmentationOptions& options) {
    if (activity.ground_before_m || activity.ground_after_m || grid.ground_speed_m_per_s.empty()) return "";
    // A rotorcraft hovers, its altitude is that above the ground; and who writes a CSV knows what it is of.
    const auto& source = tracks["altitude_m"].source;
    if (source.starts_with("ROTORCRAFT_FP") || source == plain_source) return "";
    const auto part = [&](const std::vector<double>& all) {
        const auto [begin, end] = activity.moving;
        std::vector<double> values(all.begin() + static_cast<std::ptrdiff_t>(begin),
                                   all.begin() + static_cast<std::ptrdiff_t>(end));
        std::ranges::sort(values);
        return values;
    };
    const auto altitude_m = part(grid.altitude_m);
    const double moved_m = altitude_m.back() - altitude_m.front();
    const double speed = quantile(part(grid.ground_speed_m_per_s), 0.9);
    if (moved_m >= options.flight_height_m || speed >= min_flight_m_per_s) return "";
    return fmt::format(
        "altitude moves by no more than {:.1f} m and the ground is not seen, at {:.1f} m/s over ground: "
        "driven or carried",
        moved_m, speed);
}

/// Whether what only an altitude shows is as short, low or slow as an estimator that settles.
std::string why_only_settling(const SelectedTracks& tracks, const ResampledFlight& grid, const Activity& activity,
                              const Heights& heights, const SegmentationOptions& options) {
    if (grid.motor_sign != MotorIndicator::unknown) return "";
    const auto seen = fmt::format("altitude alone shows a height of {:.0f} m", heights.max_m);
    const double high_s = static_cast<double>(sorted_when_high(heights.height_m, heights).size()) * grid.step_s;
    if (high_s < min_time_aloft_s) return fmt::format("{}, for {:.0f} s: an estimator that settles", seen, high_s);
    if (grid.ground_speed_m_per_s.empty())
        return heights.max_m < min_height_factor * options.flight_height_m ? seen + ": an estimator that settles" : "";
    const auto first = grid.ground_speed_m_per_s.begin() + static_cast<std::ptrdiff_t>(activity.span.begin);
    const std::vector<double> speeds(first, first + std::ssize(heights.height_m));
    const double speed = quantile(sorted_when_high(speeds, heights), 0.9);
    if (tracks["altitude_m"].source.starts_with("ROTORCRAFT_FP") || speed >= min_flight_m_per_s) return "";
    return fmt::format("{}, at {:.1f} m/s over ground: an estimator that settles", seen, speed);
}

/// Whether an activity from ground to ground, faster than what is carried, goes up and down as roads do.
std::string why_on_a_road(const SelectedTracks& tracks, const ResampledFlight& grid, const Activity& activity) {
    if (!activity.ground_before_m || !activity.ground_after_m || grid.ground_speed_m_per_s.empty()) return "";
    constexpr double often_s = 5.0;  // of what is seen more seldom no slope is known
    const double start_s = grid.time_s(activity.span.begin);
    const double end_s = grid.time_s(activity.span.end - 1);
    const auto seen = altitudes_within(tracks["altitude_m"], start_s, end_s).size();
    if (static_cast<double>(seen) * often_s < end_s - start_s) return "";
    std::vector<double> way_m{0.0};
    for (auto i = activity.span.begin; i < activity.span.end; ++i)
        way_m.push_back(way_m.back() + grid.ground_speed_m_per_s[i] * grid.step_s);
    for (const double over_s : {5.0, 10.0, 30.0}) {
        const auto steps = grid.steps(over_s);
        for (auto i = activity.span.begin; i + steps < activity.span.end; ++i) {
            const auto k = i - activity.span.begin;
            const double climbed_m = std::abs(grid.altitude_m[i + steps] - grid.altitude_m[i]);
            if (climbed_m > road_slope * (way_m[k + steps] - way_m[k]) + road_slack_m) return "";
        }
    }
    return fmt::format("altitude never moves by more than {:.0f} % of the way, from ground to ground: driven",
                       units::percentage(road_slope, 1.0));
}

bool changes_often(const Track& track, double start_s, double end_s) {
    constexpr std::size_t enough = 10;
    std::size_t changes = 0;
    for (std::size_t i = 1; i < track.value.size(); ++i) {
        const bool is_within = track.time_s[i - 1] >= start_s && track.time_s[i] <= end_s;
        changes += is_within && track.value[i] != track.value[i - 1] ? 1 : 0;
    }
    return changes >= enough;
}

/// How fast positions move, from so long before to each of the times [m/s].
std::vector<double> speeds_by_position(const ResampledFlight& grid, const std::vector<double>& east_m,
                                       const std::vector<double>& north_m) {
    const auto steps = grid.steps(position_window_s);
    std::vector<double> speeds(east_m.size(), 0.0);
    for (std::size_t i = steps; i < speeds.size(); ++i)
        speeds[i] = std::hypot(east_m[i] - east_m[i - steps], north_m[i] - north_m[i - steps]) / position_window_s;
    return speeds;
}

/// Whether ground speed and position, both measured, show that it stood still or was carried while its altitude shows a
/// height. A rotorcraft hovers, and a fixed wing may stand against the wind, but not within the width of a field.
std::string why_standing(const SelectedTracks& tracks, const ResampledFlight& grid, const Activity& activity,
                         const Heights& heights) {
    const auto& source = tracks["altitude_m"].source;
    if (source == plain_source || source.starts_with("ROTORCRAFT_FP") || tracks.series().firmware == "rotorcraft")
        return "";
    const auto time_s = grid.times_s(activity.span);
    const auto is_alive = [&](const char* name) { return changes_often(tracks[name], time_s.front(), time_s.back()); };
    if (!is_alive("ground_speed_m_per_s") || !is_alive("east_m") || !is_alive("north_m")) return "";
    const auto east_m = resample(tracks["east_m"], time_s);
    const auto north_m = resample(tracks["north_m"], time_s);
    const auto fast = [&](const std::vector<double>& speeds) {
        return quantile(sorted_when_high(speeds, heights), 0.9);
    };
    const double speed = fast(resample(tracks["ground_speed_m_per_s"], time_s));
    if (speed >= min_flight_m_per_s) return "";
    if (fast(speeds_by_position(grid, east_m, north_m)) >= min_flight_m_per_s) return "";
    const double extent_m =
        std::max(spread_of(sorted_when_high(east_m, heights)), spread_of(sorted_when_high(north_m, heights)));
    if (!tracks["airspeed_m_per_s"].empty() && extent_m >= standing_extent_m) return "";
    return fmt::format(
        "altitude shows a height of {:.0f} m, but it moves at {:.1f} m/s over ground, within {:.0f} m: "
        "it stood still or was carried",
        heights.max_m, speed, extent_m);
}

/// Whether the airspeed shows flight: so much energy of height and speed is gained within a window of flying speed.
bool flies_by_airspeed(const SelectedTracks& tracks, const ResampledFlight& grid, const Activity& activity) {
    const auto& airspeed = tracks["airspeed_m_per_s"];
    if (airspeed.empty()) return false;
    const auto speed = resample(airspeed, grid.times_s(activity.span));
    const auto energy_height_m = [&](std::size_t i) {
        return grid.altitude_m[activity.span.begin + i] +
               speed[i] * speed[i] / (2.0 * units::standard_gravity_m_per_s2);
    };
    const auto steps = grid.steps(climb_window_s);
    std::size_t flying = 0;  // points in a row at flying speed
    for (std::size_t i = 0; i < speed.size(); ++i) {
        flying = speed[i] >= least_airspeed_m_per_s ? flying + 1 : 0;
        if (flying > steps && energy_height_m(i) - energy_height_m(i - steps) >= climbed_by_motor_m) return true;
    }
    return false;
}

/// How many times as much `b` moves as `a` (as long), where one of them moves; std::nullopt where they hardly do, or
/// have nothing to do with each other.
std::optional<double> times_as_much(const std::vector<double>& a, const std::vector<double>& b) {
    constexpr std::size_t enough = 5;
    constexpr double moves_m = 5.0;
    constexpr double min_correlation = 0.8;
    std::size_t moves = 0;
    double aa = 0.0;
    double ab = 0.0;
    double bb = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (std::max(std::abs(a[i]), std::abs(b[i])) < moves_m) continue;
        ++moves;
        aa += a[i] * a[i];
        ab += a[i] * b[i];
        bb += b[i] * b[i];
    }
    if (moves < enough || aa == 0.0 || ab < min_correlation * std::sqrt(aa * bb)) return std::nullopt;
    return ab / aa;
}

/// The changes of the grid's altitude within windows that follow each other, piece by piece.
std::vector<double> changes_seen(const ResampledFlight& grid, double window_s) {
    std::vector<double> changes_m;
    const auto steps = grid.steps(window_s);
    changes_m.reserve(grid.size() / steps + 1);
    for (const auto& piece : grid.pieces) {
        for (auto i = piece.begin; i + steps < piece.end; i += steps) {
            changes_m.push_back(grid.altitude_m[i + steps] - grid.altitude_m[i]);
        }
    }
    return changes_m;
}

/// The same as another altitude, or the integral of a climb rate, tells them; what is absurd of it tells nothing.
std::vector<double> changes_said(const ResampledFlight& grid, const Track& track, double window_s) {
    std::vector<double> changes_m;
    const auto steps = grid.steps(window_s);
    changes_m.reserve(grid.size() / steps + 1);
    const double max_m = physical_bounds("altitude_m").value().high;
    std::vector<double> middles_s(track.name == "altitude_m" ? 0 : grid.size());
    for (std::size_t i = 0; i < middles_s.size(); ++i) middles_s[i] = grid.time_s(i) + 0.5 * grid.step_s;
    const auto climb_m_per_s = resample(track, middles_s);
    for (const auto& piece : grid.pieces) {
        for (auto i = piece.begin; i + steps < piece.end; i += steps) {
            double change_m = 0.0;
            if (track.name == "altitude_m") {
                change_m = value_at(track, grid.time_s(i + steps)) - value_at(track, grid.time_s(i));
            } else {
                for (std::size_t k = 0; k < steps; ++k) change_m += grid.step_s * climb_m_per_s[i + k];
            }
            changes_m.push_back(std::abs(change_m) <= max_m ? change_m : 0.0);
        }
    }
    return changes_m;
}

std::string unit_of(double times) {
    const auto is_near = [&](double factor) { return times > 0.8 * factor && times < 1.25 * factor; };
    return is_near(100.0) ? "cm" : is_near(1000.0) ? "mm" : is_near(3.28084) ? "feet" : "another unit than m";
}

}  // namespace

std::string ground_vehicle_reason(const SelectedTracks& tracks) {
    if (!tracks["rover_mode"].empty()) return "a ground vehicle: it sends ROVER_STATUS";
    if (tracks.series().firmware == "rover") return "a ground vehicle: its airframe's firmware is rover";
    return "";
}

std::string no_flight_reason(const SelectedTracks& tracks, const ResampledFlight& grid, const Activity& activity,
                             const Heights& heights, const SegmentationOptions& options) {
    const double motor_percent = max_motor_percent(grid, activity.span);
    if (heights.max_m < options.flight_height_m) return low_text(grid, motor_percent, heights.max_m, options);
    if (grid.motor_sign != MotorIndicator::unknown && motor_percent < flight_motor_percent(grid, options) &&
        !flies_by_airspeed(tracks, grid, activity)) {
        return fmt::format("altitude moved by {:.0f} m with {}: an estimator without a fix", heights.max_m,
                           grid.motor_sign == MotorIndicator::power ? "the power at its idle" : "the motor off");
    }
    for (const auto& [over_s, limit] :
         {std::pair{5.0, max_climb_5_s_m_per_s}, std::pair{30.0, max_climb_30_s_m_per_s}}) {
        const double fastest = max_m_per_s(grid, activity.span, over_s);
        if (fastest > limit) {
            return fmt::format(
                "altitude changes by {:.0f} m/s for {:.0f} s: an estimator that ran away, or another "
                "unit than m",
                fastest, over_s);
        }
    }
    if (auto why = contradiction(tracks, grid, activity, options); !why.empty()) return why;
    if (auto why = why_only_settling(tracks, grid, activity, heights, options); !why.empty()) return why;
    if (auto why = why_on_a_road(tracks, grid, activity); !why.empty()) return why;
    if (auto why = why_only_driven(tracks, grid, activity, options); !why.empty()) return why;
    return why_standing(tracks, grid, activity, heights);
}

std::string motor_doubt(const ResampledFlight& grid, const Activity& activity, const SegmentationOptions& options) {
    if (grid.motor_sign == MotorIndicator::unknown) return "";
    if (max_motor_percent(grid, activity.span) >= flight_motor_percent(grid, options)) return "";
    return fmt::format(
        "{} says that the motor is off from {:.0f} to {:.0f} s, airspeed and climb that it flies: the "
        "latter count",
        grid.motor_evidence, grid.time_s(activity.moving.begin), grid.time_s(activity.moving.end - 1));
}

std::string suspected_unit_error(const SelectedTracks& tracks, const ResampledFlight& grid) {
    constexpr double window_s = 10.0;
    constexpr double factor = 1.7;  // feet are 3.28 times as many
    const auto& chosen = tracks["altitude_m"];
    const auto doubt_by = [&](const Track& said, const char* how) -> std::string {
        const auto times = times_as_much(changes_said(grid, said, window_s), changes_seen(grid, window_s));
        if (!times || (*times<factor&& * times> 1.0 / factor)) return "";
        return fmt::format("{} moves {:.3g} times as much as {}{} says: is one of them in {}?", chosen.source, *times,
                           how, said.source, unit_of(std::max(*times, 1.0 / *times)));
    };
    if (const auto& climb = tracks["climb_m_per_s"]; !climb.empty()) {
        if (auto doubt = doubt_by(climb, "the climb rate of "); !doubt.empty()) return doubt;
    }
    for (const auto& track : tracks.series().tracks) {
        if (track.name != "altitude_m" || track.source == chosen.source || track.empty()) continue;
        if (auto doubt = doubt_by(track, ""); !doubt.empty()) return doubt;
    }
    return "";
}

}  // namespace flightwatt::flight
