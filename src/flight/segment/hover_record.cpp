#include "flight/segment/hover_record.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <span>

namespace flightwatt::flight {
namespace {

constexpr double lifting_fraction = 0.7;  // of the usual effort in flight: an idling motor has less, a descent more
constexpr double idle_fraction = 0.5;     // of lifting effort: below it for three seconds it does not fly
constexpr double min_hover_s = 5.0;
constexpr double max_detector_s = 1.5;
constexpr double max_rest_m = 3.0;      // of descent in 1.5 s: a fall is faster
constexpr double clear_m = 0.5;         // of the ground: a barometer's noise is less
constexpr double max_early_s = 2.0;     // of lift-off, before the motors lift: a ramp of the throttle
constexpr double max_wait_s = 15.0;     // of lift-off, after it: a rotorcraft may idle at much throttle
constexpr double level_m_per_s = 0.2;   // a climb at this rate takes some 2 % more power than hovering
constexpr double level_s = 3.0;         // of a hover; a landing may pause for less
constexpr double drift_m = 3.0;         // of an altitude during a flight,
constexpr double drift_fraction = 0.1;  // and of its height, if the log begins or ends on the ground

constexpr std::size_t steps(double duration_s) { return static_cast<std::size_t>(duration_s / segmentation_step_s); }

/// Climb rate over a second before and after a point.
double climb_rate(const std::vector<double>& height_m, std::size_t point) {
    constexpr auto reach = steps(1.0);
    const double climbed_m =
        height_m[std::min(point + reach, height_m.size() - 1)] - height_m[point - std::min(reach, point)];
    return climbed_m / (2.0 * segmentation_step_s * static_cast<double>(reach));
}

/// Where the climb from the first point of a span ends: in the air, with no more of it for a while (else at the highest
/// point), less what follows at a small part of the climb's mean rate.
std::size_t end_of_climb(const std::vector<double>& height_m, IndexSpan span, double airborne_m) {
    const auto heights = part_of(height_m, span);
    auto end = span.begin + static_cast<std::size_t>(std::ranges::max_element(heights) - heights.begin());
    const auto holds = [](const IndexSpan& run) { return run.size() > steps(level_s); };
    const auto levels = runs_of(
        span, [&](std::size_t i) { return height_m[i] >= airborne_m && climb_rate(height_m, i) <= level_m_per_s; });
    if (const auto level = std::ranges::find_if(levels, holds); level != levels.end()) end = level->begin;
    const double climb_s = segmentation_step_s * std::max(1.0, static_cast<double>(end - span.begin));
    const double least_m_per_s =
        std::max(level_m_per_s, least_of_climb * (height_m[end] - height_m[span.begin]) / climb_s);
    auto climbs = runs_of({span.begin, end}, [&](std::size_t i) { return climb_rate(height_m, i) >= least_m_per_s; });
    std::erase_if(climbs, std::not_fn(holds));
    return climbs.empty() ? end : climbs.back().end;
}

/// The last point, near the one at which the motors begin to lift, before the aircraft stays clear of the ground, less
/// the time of the climb to there; that one if the altitude shows none.
std::size_t lift_off_of(std::span<const double> altitude_m, double clear_altitude_m, std::size_t lifting) {
    const auto from = lifting - std::min(lifting, steps(max_early_s));
    const auto until = std::min(lifting + steps(max_wait_s + level_s), altitude_m.size());
    for (const auto& run : runs_of({from, until}, [&](std::size_t i) { return altitude_m[i] > clear_altitude_m; })) {
        if (run.size() <= steps(level_s)) continue;
        if (run.begin == from) return lifting;
        const double climbed_m = altitude_m[run.begin + steps(level_s)] - altitude_m[run.begin];
        const double climb = clear_m / std::max(climbed_m, clear_m) * static_cast<double>(steps(level_s));
        const auto back = climbed_m > clear_m ? std::min(run.begin - 1, static_cast<std::size_t>(climb)) : 0;
        return run.begin <= lifting ? run.begin - 1 : std::max(lifting, run.begin - 1 - back);
    }
    return lifting;
}

/// Whether the altitude jumps before a point.
bool jumps_at(const ResampledFlight& grid, std::size_t point) {
    return std::ranges::binary_search(grid.pieces, point, {}, &IndexSpan::begin);
}

/// Where an aircraft whose motors stopped is at rest, within a span; its end if it falls until there.
std::size_t end_of_fall(const ResampledFlight& grid, IndexSpan after) {
    constexpr auto half = steps(0.5 * level_s);
    const auto& altitude_m = grid.altitude_m;
    if (after.size() < 2 * half) return after.begin;
    for (auto i = after.begin; i + 2 * half <= after.end; ++i) {
        const double fall_m =
            mean(part_of(altitude_m, {i, i + half})) - mean(part_of(altitude_m, {i + half, i + 2 * half}));
        if (fall_m <= max_rest_m) return i;
    }
    return after.end;
}

/// Whether the altitude changes by `moved_m` within some seconds: that of a receiver on the ground wanders more slowly.
bool altitude_moves(std::span<const double> altitude_m, double moved_m) {
    constexpr auto within = steps(20.0);
    const auto ahead = std::min(within, altitude_m.size() - 1);
    for (std::size_t i = 0; i + ahead < altitude_m.size(); ++i)
        if (std::abs(altitude_m[i + ahead] - altitude_m[i]) >= moved_m) return true;
    return false;
}

/// The spans in which the motors give much less than usual, but carry the aircraft: without the payload of
/// another flight, or after it was dropped. They do not idle, and the altitude changes. Each has a usual effort of its
/// own.
std::vector<IndexSpan> lighter_flights(const ResampledFlight& grid, const std::vector<double>& effort, double lifting) {
    constexpr double most = 0.98;
    const double range_m = quantile_of(grid.altitude_m, most) - quantile_of(grid.altitude_m, 1.0 - most);
    const double moved_m = std::max(drift_m, drift_fraction * range_m);
    const auto is_lighter = [&](std::size_t i) { return effort[i] < lifting && effort[i] >= idle_fraction * lifting; };
    std::vector<IndexSpan> lighter;
    for (const auto& span : runs_of({0, grid.size()}, is_lighter, [&](std::size_t i) { return !jumps_at(grid, i); })) {
        if (span.size() <= steps(min_hover_s) || !altitude_moves(part_of(grid.altitude_m, span), moved_m)) continue;
        const auto efforts = part_of(effort, span);
        const double own_lifting = lifting_fraction * usual_effort({efforts.begin(), efforts.end()});
        std::ranges::copy(runs_of(span, [&](std::size_t i) { return effort[i] >= own_lifting; }),
                          std::back_inserter(lighter));
    }
    return lighter;
}

/// Whether the log pauses within a span.
bool has_pause(const ResampledFlight& grid, IndexSpan within, double pause_s) {
    for (auto i = within.begin; i < within.end; ++i)
        if (interval_around_s(grid.altitude_time_s, grid.time_s(i)) > pause_s) return true;
    return false;
}

}  // namespace

bool changes_to(const Track& state, double value, double from_s, double to_s) {
    for (auto i = first_after(state.time_s, from_s); i < state.time_s.size() && state.time_s[i] <= to_s; ++i)
        if (state.value[i] == value) return true;
    return false;
}

std::vector<IndexSpan> find_hovers(const FlightData& data, const ResampledFlight& grid) {
    const auto& armed = data.armed;
    const auto& landed = data.landed;
    if (data.firmware != "rotorcraft" || grid.motor_percent.empty()) return {};
    if (grid.motor_indicator == MotorIndicator::power && usual_effort(data.current_a.value) < min_lifting_a) return {};
    const auto effort = running_median<5>(grid.motor_percent);
    const double lifting = lifting_fraction * usual_effort(effort);
    if (!(lifting > 0.0)) return {};
    const auto idles = [&](std::size_t i) { return effort[i] < idle_fraction * lifting; };
    const double pause_s = std::max(level_s, gap_threshold_s(grid.altitude_time_s));
    const auto lands = [&](IndexSpan between) {
        const double from_s = grid.time_s(between.begin);
        const double to_s = grid.time_s(between.end);
        if (changes_to(landed, 1.0, from_s, to_s) || changes_to(armed, 0.0, from_s, to_s)) return true;
        const bool is_stated = !armed.empty() || !landed.empty();
        return std::ranges::any_of(runs_of(between, idles), [&](const IndexSpan& run) {
            return run.size() > steps(level_s) && (!is_stated || has_pause(grid, run, pause_s));
        });
    };
    auto lifts = runs_of({0, grid.size()}, [&](std::size_t i) { return effort[i] >= lifting; });
    std::ranges::move(lighter_flights(grid, effort, lifting), std::back_inserter(lifts));
    std::ranges::sort(lifts, {}, &IndexSpan::begin);
    std::vector<IndexSpan> hovers;
    for (const auto& run : lifts) {
        if (!hovers.empty()) hovers.back().end = end_of_fall(grid, {hovers.back().end, run.begin});
        if (!hovers.empty() && (hovers.back().end == run.begin || !lands({hovers.back().end - 1, run.begin})))
            hovers.back().end = run.end;
        else
            hovers.push_back(run);
    }
    if (!hovers.empty()) hovers.back().end = end_of_fall(grid, {hovers.back().end, grid.size()});
    std::erase_if(hovers, [&](const IndexSpan& hover) { return hover.size() <= steps(min_hover_s); });
    return hovers;
}

std::vector<IndexSpan> rests_between(const std::vector<IndexSpan>& hovers, const ResampledFlight& grid) {
    std::vector<bool> rests(grid.size(), true);
    for (const auto& hover : hovers) set_part(rests, hover, false);
    // A rest does not extend across a jump of the altitude.
    return runs_of(
        {0, grid.size()}, [&](std::size_t i) { return rests[i]; }, [&](std::size_t i) { return !jumps_at(grid, i); });
}

SortieEdges find_hover_edges(const ResampledFlight& grid, const Activity& activity, const Heights& heights) {
    const auto& [moving, span, ground_before, ground_after] = activity;
    auto height_m = heights.height_m;
    const double airborne_m = airborne_fraction * heights.cruise_height_m;
    const auto time_s = [&](std::size_t i) { return grid.time_s(activity.span.begin + i); };
    auto first = moving.begin - span.begin;
    const auto last = moving.end - 1 - span.begin;
    const double ground_m = std::max(clear_m, std::min(drift_m, drift_fraction * heights.max_m));
    const auto is_on_ground = [&](std::size_t i) { return std::abs(height_m[i]) <= ground_m; };
    SortieEdges edges;
    if (ground_before || (ground_after && is_on_ground(first))) {
        const double clear_altitude_m = heights.ground_m + heights.lift_off_m + std::min(clear_m, airborne_m);
        first = lift_off_of(part_of(grid.altitude_m, {span.begin, moving.end}), clear_altitude_m, first);
        edges.lift_off_s = time_s(first);
    }
    if (ground_after || (ground_before && is_on_ground(last))) edges.touchdown_s = time_s(last);
    const auto takeoff_end = edges.lift_off_s ? end_of_climb(height_m, {first, last + 1}, airborne_m) : first;
    std::ranges::reverse(height_m);  // a descent is a climb from touchdown
    const auto end = height_m.size() - 1;
    const auto landing_start =
        std::max(end - end_of_climb(height_m, {end - last, end - first + 1}, airborne_m), takeoff_end);
    if (takeoff_end > first) edges.takeoff_end_s = time_s(takeoff_end);
    // A log that ends in the air ends in the landing if most of the height is lost, above a ground that is known.
    const bool is_low = edges.lift_off_s && heights.height_m[last] < 0.5 * heights.height_m[landing_start];
    if ((edges.touchdown_s || is_low) && landing_start < last) edges.landing_start_s = time_s(landing_start);
    return edges;
}

double confirmed_by_detector(const Track& detector, double edge_s, bool landed) {
    constexpr std::size_t min_reports = 10;
    if (detector.time_s.size() < min_reports) return edge_s;
    double nearest_s = edge_s + 2.0 * max_detector_s;
    for (std::size_t i = 1; i < detector.value.size(); ++i) {
        const bool turns = detector.value[i] != detector.value[i - 1] && (detector.value[i] == 1.0) == landed;
        if (turns && std::abs(detector.time_s[i] - edge_s) < std::abs(nearest_s - edge_s))
            nearest_s = detector.time_s[i];
    }
    return std::abs(nearest_s - edge_s) <= max_detector_s ? nearest_s : edge_s;
}

}  // namespace flightwatt::flight
