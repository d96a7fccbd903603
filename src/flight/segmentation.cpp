#include "flight/segmentation.h"

#include "base/error.h"
#include "base/statistics.h"
#include "flight/chosen_track.h"
#include "flight/segmentation/flight_grid.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

/// What lies between two rests: something moved, or the motor ran.
struct Activity {
    GridSpan moving;
    GridSpan span;                          ///< with the ends of the rests beside it, which reach up to the last metres
    std::optional<double> ground_before_m;  ///< absent if the log begins with it
    std::optional<double> ground_after_m;   ///< absent if the log ends with it
};

/// The ground beside an activity: the last (or first) twenty seconds of the rest there.
double ground_beside(const FlightGrid& grid, GridSpan rest, bool before) {
    const auto length = std::min(grid.steps(20.0) + 1, rest.end - rest.begin);
    return median_altitude_m(
        grid, before ? GridSpan{rest.end - length, rest.end} : GridSpan{rest.begin, rest.begin + length});
}

std::vector<Activity> find_activities(const FlightGrid& grid, const std::vector<GridSpan>& rests,
                                      const SegmentationOptions& options) {
    const auto reach = grid.steps(options.rest_s);
    std::vector<Activity> activities;
    std::size_t begin = 0;
    for (std::size_t r = 0; r <= rests.size(); ++r) {
        const bool last = r == rests.size();
        const auto end = last ? grid.size() : rests[r].begin;
        if (end > begin) {
            Activity activity{{begin, end}, {begin, end}, std::nullopt, std::nullopt};
            if (r > 0) {
                activity.ground_before_m = ground_beside(grid, rests[r - 1], true);
                activity.span.begin -= std::min(reach, rests[r - 1].end - rests[r - 1].begin);
            }
            if (!last) {
                activity.ground_after_m = ground_beside(grid, rests[r], false);
                activity.span.end += std::min(reach, rests[r].end - rests[r].begin);
            }
            activities.push_back(activity);
        }
        if (!last) begin = rests[r].end;
    }
    return activities;
}

/// The heights of one activity above its ground; the ground rises or falls evenly from before to after.
struct Heights {
    std::vector<double> height_m;
    double ground_m = 0.0;
    double top_m = 0.0;  ///< median of the upper half: the flight's own height
    double highest_m = 0.0;
};

double median_of_upper_half(const std::vector<double>& heights, double highest) {
    std::vector<double> upper;
    std::copy_if(heights.begin(), heights.end(), std::back_inserter(upper),
                 [&](double h) { return h > 0.5 * highest; });
    return upper.empty() ? highest : upper_median(std::move(upper));
}

/// The ground on both sides. An estimator without a fix rests at any level: where the two differ by more than
/// a third of the height flown, the later one counts.
struct Grounds {
    double before_m = 0.0;
    double after_m = 0.0;
    bool disagreed = false;
};

Grounds grounds_of(const FlightGrid& grid, const Activity& activity, const std::optional<double>& planned_ground_m) {
    const auto first = grid.altitude_m.begin() + static_cast<std::ptrdiff_t>(activity.span.begin);
    const auto last = grid.altitude_m.begin() + static_cast<std::ptrdiff_t>(activity.span.end);
    const auto [lowest, highest] = std::minmax_element(first, last);
    if (!activity.ground_before_m && !activity.ground_after_m) {
        // In the air from the first to the last line: the flight plan's ground, unless the log goes below it.
        const double ground_m = std::min(planned_ground_m.value_or(*lowest), *lowest);
        return {ground_m, ground_m};
    }
    const double after_m = activity.ground_after_m ? *activity.ground_after_m : *activity.ground_before_m;
    const double before_m = activity.ground_before_m.value_or(after_m);
    const bool disagree = std::abs(before_m - after_m) > std::max(10.0, (*highest - after_m) / 3.0);
    return {disagree ? after_m : before_m, after_m, disagree};
}

Heights heights_of(const FlightGrid& grid, const Activity& activity, const Grounds& grounds) {
    Heights heights;
    const auto count = activity.span.end - activity.span.begin;
    for (std::size_t i = 0; i < count; ++i) {
        const double part = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.0;
        const double ground_m = std::lerp(grounds.before_m, grounds.after_m, part);
        heights.height_m.push_back(grid.altitude_m[activity.span.begin + i] - ground_m);
    }
    heights.ground_m = grounds.before_m;
    heights.highest_m = *std::max_element(heights.height_m.begin(), heights.height_m.end());
    heights.top_m = median_of_upper_half(heights.height_m, heights.highest_m);
    return heights;
}

double highest_throttle(const FlightGrid& grid, GridSpan span) {
    if (grid.throttle_percent.empty()) return 0.0;
    return *std::max_element(grid.throttle_percent.begin() + static_cast<std::ptrdiff_t>(span.begin),
                             grid.throttle_percent.begin() + static_cast<std::ptrdiff_t>(span.end));
}

/// Why an activity is no flight; empty if it is one.
std::string why_no_flight(const FlightGrid& grid, const Activity& activity, const Heights& heights,
                          const SegmentationOptions& options) {
    const double throttle = highest_throttle(grid, activity.span);
    const bool motor_known = !grid.throttle_percent.empty();
    if (heights.highest_m < options.flight_height_m) {
        const double height_m = std::max(heights.highest_m, 0.0);
        return motor_known && throttle > options.idle_throttle_percent
                   ? fmt::format("run-up, taxi or hop: throttle to {:.0f} %, height to {:.1f} m", throttle, height_m)
                   : fmt::format("carried or rolled: height to {:.1f} m, motor off", height_m);
    }
    if (!motor_known || throttle >= options.flight_throttle_percent) return "";
    return fmt::format("altitude moved by {:.0f} m with the motor off: an estimator without a fix", heights.highest_m);
}

/// Between two neighbouring points of the grid, where the height crosses `level`.
double crossing_s(const FlightGrid& grid, std::size_t begin, const std::vector<double>& height_m, std::size_t i,
                  double level) {
    const double step = height_m[i + 1] - height_m[i];
    const double part = step == 0.0 ? 0.0 : std::clamp((level - height_m[i]) / step, 0.0, 1.0);
    return grid.time_s(begin + i) + part * grid.step_s;
}

/// The edges of one sortie; absent where the log begins or ends in the air.
struct SortieEdges {
    std::optional<double> lift_off_s;
    std::optional<double> takeoff_end_s;
    std::optional<double> landing_start_s;
    std::optional<double> touchdown_s;
};

/// The first point from which the height, reached on the way from `begin` on, does not grow by more than the
/// hold fraction within the hold time; the height held is then the highest of that time. `height` maps a
/// count of steps from `begin` to a height, so that landings are searched backwards by the same rule.
template <typename Height>
double held_height(Height&& height, std::size_t count, std::size_t hold, double top_m,
                   const SegmentationOptions& options) {
    std::vector<double> highest(count);
    for (std::size_t i = 0; i < count; ++i) highest[i] = std::max(height(i), i > 0 ? highest[i - 1] : height(0));
    for (std::size_t i = 0; i < count; ++i) {
        const double later = highest[std::min(i + hold, count - 1)];
        const bool holds = later - highest[i] <= options.hold_fraction * top_m;
        // Lower down it waits for the final approach, or trims after the launch.
        if (holds && highest[i] > 0.5 * top_m) return later;
    }
    return highest[count - 1];
}

SortieEdges find_edges(const FlightGrid& grid, const Activity& activity, const Heights& heights,
                       const SegmentationOptions& options) {
    const auto& height = heights.height_m;
    const auto begin = activity.span.begin;
    const auto count = height.size();
    const double ground_level = options.ground_fraction * heights.top_m;
    const double airborne_level = 0.25 * heights.top_m;
    const auto is_high = [&](double h) { return h > airborne_level; };
    const auto up = static_cast<std::size_t>(std::find_if(height.begin(), height.end(), is_high) - height.begin());
    const auto down =
        static_cast<std::size_t>(std::find_if(height.rbegin(), height.rend(), is_high).base() - height.begin()) - 1;
    SortieEdges edges;
    std::size_t lift_off = up;
    while (lift_off > 0 && height[lift_off] > ground_level) --lift_off;
    if (height[lift_off] <= ground_level) edges.lift_off_s = crossing_s(grid, begin, height, lift_off, ground_level);
    std::size_t touchdown = down;
    while (touchdown + 1 < count && height[touchdown] > ground_level) ++touchdown;
    if (height[touchdown] <= ground_level) {
        edges.touchdown_s = crossing_s(grid, begin, height, touchdown - 1, ground_level);
    }
    const auto hold = grid.steps(options.hold_s);
    const auto span = touchdown - lift_off + 1;
    const double after_takeoff =
        held_height([&](std::size_t i) { return height[lift_off + i]; }, span, hold, heights.top_m, options);
    const double before_landing =
        held_height([&](std::size_t i) { return height[touchdown - i]; }, span, hold, heights.top_m, options);
    const double reached = options.cruise_fraction * after_takeoff;
    const double left = options.cruise_fraction * before_landing;
    std::size_t takeoff_end = lift_off;
    while (takeoff_end < touchdown && height[takeoff_end] < reached) ++takeoff_end;
    std::size_t landing_start = touchdown;
    while (landing_start > takeoff_end && height[landing_start] < left) --landing_start;
    // A log that begins (or ends) in the air, and not low, begins (or ends) in cruise: that it climbs (or
    // dives) there is no take-off (or landing).
    if (!edges.lift_off_s && height[lift_off] >= airborne_level) takeoff_end = lift_off;
    if (!edges.touchdown_s && height[touchdown] >= airborne_level) landing_start = touchdown;
    if (takeoff_end > lift_off) edges.takeoff_end_s = crossing_s(grid, begin, height, takeoff_end - 1, reached);
    if (landing_start < touchdown) {
        const bool below = height[landing_start + 1] < left && height[landing_start] >= left;
        edges.landing_start_s =
            below ? crossing_s(grid, begin, height, landing_start, left) : grid.time_s(begin + landing_start);
    }
    return edges;
}

/// Between the last sample at or before a time and the first one after it; 0 outside of the samples.
double gap_around_s(const std::vector<double>& sample_s, double time_s) {
    const auto after = std::upper_bound(sample_s.begin(), sample_s.end(), time_s);
    return after == sample_s.begin() || after == sample_s.end() ? 0.0 : *after - *(after - 1);
}

/// What is noted beside an edge.
struct Witnesses {
    Track altitude;
    Track mode;
    Track block;
    Track takeoff;
};

PhaseEdge describe_edge(const Witnesses& witnesses, const FlightGrid& grid, double exact_s) {
    PhaseEdge edge;
    const double time_s = to_millisecond(exact_s);
    edge.time_s = time_s;
    const auto nearest = [&](const std::vector<double>& channel) {
        const auto index = std::lround((time_s - grid.start_s) / grid.step_s);
        return channel[std::min(static_cast<std::size_t>(std::max(index, 0L)), channel.size() - 1)];
    };
    edge.altitude_m = nearest(grid.altitude_m);
    edge.gap_s = gap_around_s(witnesses.altitude.time_s, time_s);
    if (!grid.throttle_percent.empty()) edge.throttle_percent = nearest(grid.throttle_percent);
    if (!witnesses.mode.empty()) edge.mode = static_cast<int>(state_at(witnesses.mode, time_s));
    if (!witnesses.block.empty()) edge.block = static_cast<int>(state_at(witnesses.block, time_s));
    for (const double takeoff : witnesses.takeoff.time_s) {
        const double after = takeoff - time_s;
        if (!edge.takeoff_after_s || std::abs(after) < std::abs(*edge.takeoff_after_s)) edge.takeoff_after_s = after;
    }
    return edge;
}

Sortie make_sortie(const Witnesses& witnesses, const FlightGrid& grid, const Activity& activity, const Heights& heights,
                   const SegmentationOptions& options) {
    const auto edges = find_edges(grid, activity, heights, options);
    const double first_s = edges.lift_off_s.value_or(grid.time_s(activity.span.begin));
    const double last_s = edges.touchdown_s.value_or(grid.time_s(activity.span.end - 1));
    const double cruise_from = edges.takeoff_end_s.value_or(first_s);
    const double cruise_to = std::max(edges.landing_start_s.value_or(last_s), cruise_from);
    Sortie sortie;
    sortie.ground_altitude_m = heights.ground_m;
    sortie.height_m = heights.top_m;
    const auto add = [&](Phase phase, double start_s, double end_s, bool complete) {
        if (end_s <= start_s) return;
        sortie.phases.push_back(
            {phase, describe_edge(witnesses, grid, start_s), describe_edge(witnesses, grid, end_s), complete});
    };
    if (edges.takeoff_end_s) add(Phase::takeoff, first_s, cruise_from, edges.lift_off_s.has_value());
    add(Phase::cruise, cruise_from, cruise_to, edges.takeoff_end_s.has_value() && edges.landing_start_s.has_value());
    if (edges.landing_start_s) add(Phase::landing, cruise_to, last_s, edges.touchdown_s.has_value());
    return sortie;
}

}  // namespace

void validate(const SegmentationOptions& options) {
    const auto require = [](bool good, const char* name, double value, const char* expected) {
        if (!good) throw UsageError(fmt::format("{} is {}, expected {}", name, value, expected));
    };
    const auto between = [](double value, double low, double high) { return value > low && value < high; };
    require(between(options.ground_fraction, 0.0, 0.25), "ground fraction", options.ground_fraction, "0 to 0.25");
    require(between(options.cruise_fraction, 0.25, 1.0), "cruise fraction", options.cruise_fraction, "0.25 to 1");
    require(between(options.flight_height_m, 0.0, 1e4), "flight height", options.flight_height_m, "more than 0 m");
    const double idle_percent = options.idle_throttle_percent;
    require(idle_percent >= 0.0 && idle_percent <= 100.0, "idle throttle", idle_percent, "0 to 100 %");
    require(options.rest_s >= 1.0, "rest", options.rest_s, "1 s or more");
    require(options.hold_s > 0.0, "hold", options.hold_s, "more than 0 s");
}

FlightPhases segment(const FlightSeries& series, const SegmentationOptions& options) {
    validate(options);
    const auto grid = make_grid(series);
    const Witnesses witnesses{chosen_track(series, "altitude_m"), chosen_track(series, "mode"),
                              chosen_track(series, "block"), chosen_track(series, "takeoff")};
    const auto ground_m = ground_altitude_m(series);
    FlightPhases phases;
    if (grid.throttle_percent.empty()) phases.warnings.emplace_back("no throttle: segmented by altitude alone");
    for (const auto& activity : find_activities(grid, find_rests(grid, options), options)) {
        const auto grounds = grounds_of(grid, activity, ground_m);
        const auto heights = heights_of(grid, activity, grounds);
        auto why = why_no_flight(grid, activity, heights, options);
        if (!why.empty()) {
            phases.ground_events.push_back(
                {grid.time_s(activity.moving.begin), grid.time_s(activity.moving.end - 1), std::move(why)});
            continue;
        }
        if (grounds.disagreed) {
            phases.warnings.push_back(fmt::format(
                "the ground before the sortie at {:.0f} s was read as {:.0f} m and after it as {:.0f} m: the "
                "latter counts",
                grid.time_s(activity.moving.begin), *activity.ground_before_m, *activity.ground_after_m));
        }
        phases.sorties.push_back(make_sortie(witnesses, grid, activity, heights, options));
        phases.sorties.back().number = phases.sorties.size();
    }
    return phases;
}

void require_sortie(const FlightSeries& series, const FlightPhases& phases, const std::string& file) {
    if (!phases.sorties.empty()) return;
    std::vector<std::string> events;
    for (const auto& other :
         std::span(phases.ground_events).first(std::min<std::size_t>(phases.ground_events.size(), 3))) {
        events.push_back(fmt::format("{} ({:.0f} to {:.0f} s)", other.what, other.start_s, other.end_s));
    }
    const auto seen = events.empty() ? std::string("it stood still throughout")
                                     : fmt::format("seen instead: {}", fmt::join(events, "; "));
    const auto power = power_track(series);
    throw InputError({file}, fmt::format("holds no flight in {:.0f} s", power.time_s.back() - power.time_s.front()),
                     seen);
}

}  // namespace flightwatt::flight
