#include "flight/segment/phase_edges.h"

#include "base/statistics.h"

#include <cmath>
#include <iterator>

namespace flightwatt::flight {
namespace {

// A rotorcraft whose motors stop falls by 3 m within a second.
constexpr double min_ground_s = 1.5;  // of a rest after a flight, or it is as low as the one before
constexpr double max_still_m = 3.0;

/// Ground level next to an activity: the last (or first) twenty seconds with an altitude of the rest there; of a
/// rotorcraft, which may fly low while the altitude drifts, five.
std::optional<GroundLevel> adjacent_ground(const ResampledFlight& grid, IndexSpan rest, bool before) {
    const auto length = grid.steps(grid.hovers.empty() ? 20.0 : 5.0) + 1;
    std::vector<double> near_m;
    for (std::size_t k = 0; k < rest.size() && near_m.size() < length; ++k) {
        const auto i = before ? rest.end - 1 - k : rest.begin + k;
        if (grid.has_altitude[i]) near_m.push_back(grid.altitude_m[i]);
    }
    if (near_m.empty()) return std::nullopt;
    const auto [low_m, high_m] = std::ranges::minmax(near_m);
    return GroundLevel{median_high(near_m), high_m - low_m};
}

/// Whether a rotorcraft has not come down where its log ends soon after its motors stop.
bool is_in_the_air(const ResampledFlight& grid, const Activity& activity, IndexSpan rest) {
    const auto& [moving, span, before, after] = activity;
    if (grid.hovers.empty() || !before || !after || after->altitude_m - before->altitude_m <= max_still_m) return false;
    return rest.size() < grid.steps(min_ground_s) || after->wander_m > max_still_m;
}

/// Leaves out what is before the first altitude of the log, where that comes so late that nothing shows how high, or
/// whether, the aircraft flies there.
void begin_with_altitude(const ResampledFlight& grid, Activity& activity) {
    auto& [begin, end] = activity.moving;
    if (activity.ground_before || grid.altitude_time_s.empty() || grid.has_altitude[begin]) return;
    auto first = begin;
    while (first < end && grid.time_s(first) < grid.altitude_time_s.front()) ++first;
    if (first < end) activity.span.begin = begin = first;
}

double median_of_upper_half(const std::vector<double>& heights, double highest) {
    std::vector<double> upper;
    upper.reserve(heights.size());
    std::copy_if(heights.begin(), heights.end(), std::back_inserter(upper),
                 [&](double h) { return h > 0.5 * highest; });
    return upper.empty() ? highest : median_high(std::move(upper));
}

/// One sortie on the grid.
struct Flown {
    const ResampledFlight& grid;
    const Activity& activity;
    const Heights& heights;
    const SegmentationOptions& options;
    std::size_t lift_off = 0;   ///< index in heights.height_m
    std::size_t touchdown = 0;  ///< the last point

    double height(std::size_t i) const { return heights.height_m[i]; }
    double time_s(std::size_t i) const { return grid.time_s(activity.span.begin + i); }
    double airborne_m() const { return airborne_fraction * heights.cruise_height_m; }
    double ground_m() const { return options.ground_fraction * heights.cruise_height_m; }
};

/// Time between two consecutive points at which the height crosses `level`.
double crossing_s(const Flown& flown, std::size_t i, double level) {
    const double step = flown.height(i + 1) - flown.height(i);
    const double part = step == 0.0 ? 0.0 : std::clamp((level - flown.height(i)) / step, 0.0, 1.0);
    return flown.time_s(i) + part * flown.grid.step_s;
}

/// Start of the search for lift-off: where the motor first runs after a rest, or earlier if the log begins in the air.
std::size_t first_flyable(const Flown& flown) {
    const auto& motor = flown.grid.motor_percent;
    if (motor.empty()) return 0;
    const double idle = idle_motor_percent(flown.grid, flown.options);
    const auto begin = flown.activity.span.begin;
    const auto count = flown.heights.height_m.size();
    std::size_t runs = 0;
    while (runs < count && motor[begin + runs] <= idle) ++runs;
    if (runs == count) return 0;
    while (!flown.activity.begins_at_rest() && runs > 0 && flown.height(runs) > flown.airborne_m()) --runs;
    return runs;
}

/// Finds lift-off and touchdown by motor and motion, where the heights are unknown: the last start of the motor before
/// flying speed, and the rest.
void find_edges_of_motion(Flown& flown, SortieEdges& edges) {
    const auto& moving = flown.activity.moving;
    const auto& motor = flown.grid.motor_percent;
    const auto& speed = flown.grid.ground_speed_m_per_s;
    const double percent = flight_motor_percent(flown.grid, flown.options);
    auto first = moving.begin;
    while (first + 1 < moving.end && (motor[first] < percent || speed[first] < min_flight_m_per_s)) ++first;
    while (first > moving.begin && motor[first - 1] >= percent) --first;
    flown.lift_off = first - flown.activity.span.begin;
    flown.touchdown = moving.end - 1 - flown.activity.span.begin;
    if (flown.activity.begins_at_rest()) edges.lift_off_s = flown.time_s(flown.lift_off);
    if (flown.activity.ends_at_rest()) edges.touchdown_s = flown.time_s(flown.touchdown);
}

/// The ground below the lift-off, in terms of the heights: that before, where the motor starts near it. An estimator may
/// find its altitude only at the end of the rest.
double lift_off_ground_m(const Flown& flown, std::size_t flyable) {
    const double before_m = flown.heights.lift_off_m;
    return flyable > 0 && std::abs(flown.height(flyable) - before_m) <= flown.airborne_m() ? before_m : 0.0;
}

/// Finds lift-off and touchdown, as grid points and interpolated times.
void find_ground_edges(Flown& flown, SortieEdges& edges) {
    const auto& height = flown.heights.height_m;
    const auto is_high = [&](double h) { return h > flown.airborne_m(); };
    const auto flyable = first_flyable(flown);
    const double lift_off_m = lift_off_ground_m(flown, flyable);
    auto from = height.begin() + static_cast<std::ptrdiff_t>(flyable);
    if (std::find_if(from, height.end(), is_high) == height.end()) from = height.begin();
    auto first = std::find_if(from, height.end(), [&](double h) { return is_high(h - lift_off_m); });
    if (first == height.end()) first = std::find_if(from, height.end(), is_high);
    const auto up = static_cast<std::size_t>(first - height.begin());
    const auto down =
        static_cast<std::size_t>(std::find_if(height.rbegin(), height.rend(), is_high).base() - height.begin()) - 1;
    const double ground = flown.ground_m();
    flown.lift_off = up;
    while (flown.lift_off > 0 && height[flown.lift_off] > lift_off_m + ground) --flown.lift_off;
    if (height[flown.lift_off] <= lift_off_m + ground)
        edges.lift_off_s = crossing_s(flown, flown.lift_off, lift_off_m + ground);
    flown.touchdown = down;
    while (flown.touchdown + 1 < height.size() && height[flown.touchdown] > ground) ++flown.touchdown;
    if (height[flown.touchdown] <= ground) edges.touchdown_s = crossing_s(flown, flown.touchdown - 1, ground);
    // An altitude that wanders may not be that of the ground where the aircraft is at rest.
    const auto rest_begin = flown.activity.moving.end - flown.activity.span.begin;
    if (!edges.lift_off_s && flown.activity.begins_at_rest()) {
        flown.lift_off = std::min(flyable, up);
        edges.lift_off_s = flown.time_s(flown.lift_off);
    }
    if (!edges.touchdown_s && flown.activity.ends_at_rest()) {
        flown.touchdown = std::max(rest_begin, flown.lift_off + 1);
        edges.touchdown_s = flown.time_s(flown.touchdown);
    }
}

/// The height held after the take-off: the highest of the first hold time, seen from lift-off on, in which what was
/// reached so far does not grow by more than the hold fraction.
double height_after_takeoff(const Flown& flown) {
    const auto count = flown.touchdown - flown.lift_off + 1;
    const auto hold = flown.grid.steps(flown.options.hold_s);
    std::vector<double> highest(count);
    for (std::size_t i = 0; i < count; ++i) {
        highest[i] = std::max(flown.height(flown.lift_off + i), i > 0 ? highest[i - 1] : flown.height(flown.lift_off));
    }
    for (std::size_t i = 0; i < count; ++i) {
        const double later = highest[std::min(i + hold, count - 1)];
        const bool holds = later - highest[i] <= flown.options.hold_fraction * flown.heights.cruise_height_m;
        // At lower heights it trims after the launch.
        if (holds && highest[i] > 0.5 * flown.heights.cruise_height_m) return later;
    }
    return highest[count - 1];
}

/// The point up to which a climb from the ground, or in reverse a descent to it, continues beyond the end found.
std::size_t end_of_motion(const Flown& flown, std::size_t ground, std::size_t end) {
    const auto next = [is_climb = ground < end](std::size_t i) { return is_climb ? i + 1 : i - 1; };
    const auto steps = static_cast<double>(std::max(ground, end) - std::min(ground, end));
    const double least_m = least_of_climb * (flown.height(end) - flown.height(ground)) / steps;
    const auto count = flown.heights.height_m.size();
    while (end > 0 && end + 1 < count && flown.height(next(end)) - flown.height(end) >= least_m) end = next(end);
    return end;
}

/// A held height on the grid, after which the aircraft does not return to a greater one.
struct Hold {
    double height_m;
    std::size_t begin;
    std::size_t end;  ///< the last point at the cruise fraction of it, or the first of the sortie
};

/// The held heights, the last first. Going back from touchdown, a height is held while the maximum of the later heights
/// grows by no more than the hold fraction within the hold time.
std::vector<Hold> holds_before_landing(const Flown& flown) {
    const auto count = flown.touchdown - flown.lift_off + 1;
    const auto hold = flown.grid.steps(flown.options.hold_s);
    const double step_m = flown.options.hold_fraction * flown.heights.cruise_height_m;
    std::vector<double> highest(count);  // of the steps before touchdown
    for (std::size_t i = 0; i < count; ++i) {
        const double height = flown.height(flown.touchdown - i);
        highest[i] = i > 0 ? std::max(height, highest[i - 1]) : height;
    }
    std::vector<Hold> holds;
    for (std::size_t i = 0; i < count;) {
        const double later = highest[std::min(i + hold, count - 1)];
        const bool is_last = i + 1 == count;
        if ((later - highest[i] > step_m || highest[i] <= flown.airborne_m()) && !is_last) {
            ++i;
            continue;
        }
        const double held_m = is_last ? highest[i] : later;
        std::size_t left = 0;
        while (left + 1 < count && flown.height(flown.touchdown - left) < flown.options.cruise_fraction * held_m)
            ++left;
        while (i < count && highest[i] <= held_m + step_m) ++i;
        holds.push_back({held_m, flown.touchdown - (i - 1), flown.touchdown - left});
    }
    return holds;
}

/// The last hold that is no step of the landing, after which landing begins: held long enough for work, or as long as
/// half of an earlier hold in the upper half of the height.
const Hold& last_work_hold(const Flown& flown, const std::vector<Hold>& holds) {
    const auto duration_s = [&](const Hold& hold) { return flown.time_s(hold.end) - flown.time_s(hold.begin); };
    for (auto hold = holds.begin(); hold + 1 != holds.end(); ++hold) {
        const bool is_high = hold->height_m > 0.5 * flown.heights.cruise_height_m;
        const double max_s = duration_s(*std::ranges::max_element(hold + 1, holds.end(), {}, duration_s));
        if (duration_s(*hold) >= min_work_hold_s || (is_high && duration_s(*hold) >= min_work_hold_fraction * max_s))
            return *hold;
    }
    return holds.back();
}

}  // namespace

std::vector<Activity> find_activities(const ResampledFlight& grid, const std::vector<IndexSpan>& rests,
                                      const SegmentationOptions& options) {
    const auto reach = grid.steps(options.rest_s);
    std::vector<Activity> activities;
    std::size_t r = 0;
    for (const auto& piece : grid.pieces) {
        const IndexSpan* before = nullptr;
        for (auto begin = piece.begin; begin < piece.end;) {
            const bool last = r == rests.size() || rests[r].begin >= piece.end;
            const auto end = last ? piece.end : rests[r].begin;
            if (end > begin) {
                Activity activity{{begin, end}, {begin, end}};
                if (before != nullptr) {
                    activity.ground_before = adjacent_ground(grid, *before, true);
                    activity.span.begin -= std::min(reach, before->size());
                }
                begin_with_altitude(grid, activity);
                if (!last) {
                    activity.ground_after = adjacent_ground(grid, rests[r], false);
                    if (is_in_the_air(grid, activity, rests[r])) activity.ground_after.reset();
                    activity.span.end += std::min(reach, rests[r].size());
                }
                activities.push_back(activity);
            }
            if (last) break;
            before = &rests[r++];
            begin = before->end;
        }
    }
    return activities;
}

GroundLevels estimate_ground_levels(const ResampledFlight& grid, const Activity& activity,
                                    const std::optional<double>& planned_ground_m) {
    const auto [lowest_m, highest_m] = std::ranges::minmax(part_of(grid.altitude_m, activity.span));
    if (!activity.ground_before && !activity.ground_after) {
        // In the air throughout the log: the flight plan's ground, unless the log is below it.
        const double ground_m = std::min(planned_ground_m.value_or(lowest_m), lowest_m);
        return {ground_m, ground_m};
    }
    const auto after = activity.ground_after ? *activity.ground_after : *activity.ground_before;
    const auto before = activity.ground_before.value_or(after);
    double wander_m = std::max(before.wander_m, after.wander_m);
    const auto& jumps = grid.jumps_in_flight;
    for (std::size_t i = 0; i < jumps.time_s.size(); ++i)
        if (jumps.time_s[i] >= grid.time_s(activity.span.begin) && jumps.time_s[i] < grid.time_s(activity.span.end))
            wander_m = std::max(wander_m, jumps.value[i]);
    const double allowed_m = std::max({10.0, (highest_m - after.altitude_m) / 3.0, wander_m});
    if (std::abs(before.altitude_m - after.altitude_m) <= allowed_m)
        return {before.altitude_m, after.altitude_m, wander_m};
    return {after.altitude_m, after.altitude_m, wander_m, before.altitude_m};
}

Heights compute_heights(const ResampledFlight& grid, const Activity& activity, const GroundLevels& grounds) {
    Heights heights;
    const auto count = activity.span.end - activity.span.begin;
    heights.height_m.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double part = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.0;
        const double ground_m = std::lerp(grounds.before_m, grounds.after_m, part);
        heights.height_m.push_back(grid.altitude_m[activity.span.begin + i] - ground_m);
    }
    heights.ground_m = grounds.before_m;
    heights.lift_off_m = grounds.lift_off_m.value_or(grounds.before_m) - grounds.before_m;
    heights.wander_m = grounds.wander_m;
    heights.max_m = *std::max_element(heights.height_m.begin(), heights.height_m.end());
    // Of an altitude that is not that of the ground where the aircraft is at rest, all may be below it.
    heights.cruise_height_m = std::max(median_of_upper_half(heights.height_m, heights.max_m), 0.0);
    return heights;
}

SortieEdges find_edges(const ResampledFlight& grid, const Activity& activity, const Heights& heights,
                       const SegmentationOptions& options) {
    SortieEdges edges;
    Flown flown{grid, activity, heights, options};
    const bool are_by_motion =
        heights.are_unknown() && !grid.motor_percent.empty() && !grid.ground_speed_m_per_s.empty();
    are_by_motion ? find_edges_of_motion(flown, edges) : find_ground_edges(flown, edges);
    const auto lift_off = flown.lift_off;
    const auto touchdown = flown.touchdown;
    const double reached = options.cruise_fraction * height_after_takeoff(flown);
    std::size_t takeoff_end = lift_off;
    while (takeoff_end < touchdown && flown.height(takeoff_end) < reached) ++takeoff_end;
    auto holds = holds_before_landing(flown);
    for (auto& hold : holds) {
        hold.begin = std::max(hold.begin, takeoff_end);
        hold.end = std::max(hold.end, takeoff_end);
    }
    const auto& last_height = last_work_hold(flown, holds);
    const double left = options.cruise_fraction * last_height.height_m;
    std::size_t landing_start = last_height.end;
    // A log that begins (or ends) in the air, and not low, begins (or ends) in cruise, even if it climbs (or descends).
    if (!edges.lift_off_s && flown.height(lift_off) >= flown.airborne_m()) takeoff_end = lift_off;
    if (!edges.touchdown_s && flown.height(touchdown) >= flown.airborne_m()) landing_start = touchdown;
    if (takeoff_end > lift_off) edges.takeoff_end_s = crossing_s(flown, takeoff_end - 1, reached);
    if (landing_start < touchdown) {
        const bool below = flown.height(landing_start + 1) < left && flown.height(landing_start) >= left;
        edges.landing_start_s = below ? crossing_s(flown, landing_start, left) : flown.time_s(landing_start);
    }
    if (grid.detector.empty()) return edges;
    if (edges.takeoff_end_s) edges.takeoff_end_s = flown.time_s(end_of_motion(flown, lift_off, takeoff_end));
    if (edges.landing_start_s) edges.landing_start_s = flown.time_s(end_of_motion(flown, touchdown, landing_start));
    return edges;
}

}  // namespace flightwatt::flight
