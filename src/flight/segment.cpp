#include "flight/segment.h"

#include "base/error.h"
#include "flight/segment/flight_grid.h"
#include "flight/segment/flight_rejection.h"
#include "flight/segment/hover_record.h"
#include "flight/segment/phase_edges.h"
#include "flight/select.h"
#include "flight/vtol_flight.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

constexpr double min_flight_s = 5.0;
constexpr double min_motion_m = 0.5;  // above the noise of an altitude

/// A state as a whole number; none beyond those of an int, as MAVLink's custom_mode may be.
std::optional<int> whole_number(double state) {
    constexpr double most = std::numeric_limits<int>::max();
    return std::abs(state) <= most ? std::optional(static_cast<int>(state)) : std::nullopt;
}

/// An edge with its evidence.
PhaseEdge describe_edge(const FlightData& data, const ResampledFlight& grid, double exact_s) {
    PhaseEdge edge;
    const double time_s = to_millisecond(exact_s);
    edge.time_s = time_s;
    const auto nearest = [&](const std::vector<double>& channel) {
        const auto index = std::lround((time_s - grid.start_s) / grid.step_s);
        return channel[std::min(static_cast<std::size_t>(std::max(index, 0L)), channel.size() - 1)];
    };
    edge.altitude_m = nearest(grid.altitude_m);
    edge.gap_s = interval_around_s(grid.altitude_time_s, time_s);
    if (!grid.throttle_percent.empty()) edge.throttle_percent = nearest(grid.throttle_percent);
    if (const auto& mode = data.mode; !mode.empty()) edge.mode = whole_number(state_at(mode, time_s));
    if (const auto& block = data.block; !block.empty()) edge.block = whole_number(state_at(block, time_s));
    for (const double takeoff : data.takeoff.time_s) {
        const double after = takeoff - time_s;
        if (!edge.takeoff_after_s || std::abs(after) < std::abs(*edge.takeoff_after_s)) edge.takeoff_after_s = after;
    }
    return edge;
}

SortieEdges edges_of(const FlightCandidate& flown) {
    const auto& [data, grid, activity, heights, options] = flown;
    if (is_cruise_alone(flown)) return {};
    return grid.hovers.empty() ? find_edges(grid, activity, heights, options)
                               : find_hover_edges(grid, activity, heights);
}

Sortie make_sortie(const FlightCandidate& flown) {
    const auto& grid = flown.grid;
    auto edges = edges_of(flown);
    if (edges.lift_off_s) edges.lift_off_s = confirmed_by_detector(grid.detector, *edges.lift_off_s, false);
    if (edges.touchdown_s) edges.touchdown_s = confirmed_by_detector(grid.detector, *edges.touchdown_s, true);
    const double first_s = edges.lift_off_s.value_or(grid.time_s(flown.activity.span.begin));
    const double last_s = edges.touchdown_s.value_or(grid.time_s(flown.activity.span.end - 1));
    if (const auto wing =
            wing_flight(flown.data, first_s, last_s)) {  // hover and transitions are no part of the cruise
        if (edges.takeoff_end_s) edges.takeoff_end_s = std::max(*edges.takeoff_end_s, wing->start_s);
        if (edges.landing_start_s) edges.landing_start_s = std::min(*edges.landing_start_s, wing->end_s);
    }
    const double cruise_from = edges.takeoff_end_s.value_or(first_s);
    const double cruise_to = std::max(edges.landing_start_s.value_or(last_s), cruise_from);
    Sortie sortie;
    sortie.ground_altitude_m = flown.heights.ground_m;
    sortie.height_m = flown.heights.cruise_height_m;
    const auto add = [&](Phase phase, double start_s, double end_s, bool complete) {
        if (end_s <= start_s) return;
        sortie.phases.push_back(
            {phase, describe_edge(flown.data, grid, start_s), describe_edge(flown.data, grid, end_s), complete});
    };
    if (edges.takeoff_end_s) add(Phase::takeoff, first_s, cruise_from, edges.lift_off_s.has_value());
    add(Phase::cruise, cruise_from, cruise_to, edges.takeoff_end_s.has_value() && edges.landing_start_s.has_value());
    if (edges.landing_start_s) add(Phase::landing, cruise_to, last_s, edges.touchdown_s.has_value());
    return sortie;
}

/// Warns of edges in long gaps of the altitude.
void warn_of_gaps(const Sortie& sortie, std::vector<std::string>& warnings) {
    for (std::size_t i = 0; i <= sortie.phases.size(); ++i) {
        const bool last = i == sortie.phases.size();
        const auto& edge = last ? sortie.phases.back().end : sortie.phases[i].start;
        if (edge.gap_s <= long_gap_s) continue;
        warnings.push_back(
            fmt::format("sortie {}: the {} at {:.1f} s is uncertain: {:.0f} s without an altitude", sortie.number,
                        last ? "end" : fmt::format("start of the {}", phase_word(sortie.phases[i].phase)), edge.time_s,
                        edge.gap_s));
    }
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
}

FlightPhases segment(const FlightData& data, const SegmentationOptions& options) {
    validate(options);
    auto grid = make_grid(data);
    grid.hovers = find_hovers(data, grid);
    grid.detector = data.landed;
    FlightPhases phases;
    phases.motor_source = grid.motor_evidence;
    const auto rests = grid.hovers.empty() ? find_rests(grid, options) : rests_between(grid.hovers, grid);
    for (const auto& rest : rests) phases.rests.push_back({grid.time_s(rest.begin), grid.time_s(rest.end)});
    auto reason = ground_vehicle_reason(data);
    if (reason.empty()) reason = grid.unusable;
    if (!reason.empty()) {
        phases.ground_events.push_back({grid.time_s(0), grid.time_s(grid.size() - 1), std::move(reason)});
        return phases;
    }
    phases.warnings = grid.warnings;
    const auto ground_m = stated_ground_altitude_m(data);
    for (const auto& activity : find_activities(grid, rests, options)) {
        const auto grounds = estimate_ground_levels(grid, activity, ground_m);
        const auto heights = compute_heights(grid, activity, grounds);
        const FlightCandidate candidate{data, grid, activity, heights, options};
        auto no_flight = no_flight_reason(candidate);
        if (!no_flight.empty()) {
            phases.ground_events.push_back(
                {grid.time_s(activity.moving.begin), grid.time_s(activity.moving.end - 1), std::move(no_flight)});
            continue;
        }
        if (grounds.lift_off_m) {
            phases.warnings.push_back(fmt::format(
                "the ground is at {:.0f} m before the sortie at {:.0f} s and at {:.0f} m after it: heights are above "
                "the latter",
                *grounds.lift_off_m, grid.time_s(activity.moving.begin), grounds.after_m));
        }
        if (auto warning = motor_contradiction(candidate); !warning.empty())
            phases.warnings.push_back(std::move(warning));
        auto sortie = make_sortie(candidate);
        if (sortie.phases.empty() || sortie.end_s() - sortie.start_s() < min_flight_s) {
            phases.ground_events.push_back(
                {grid.time_s(activity.moving.begin), grid.time_s(activity.moving.end - 1),
                 fmt::format("height of {:.0f} m for less than {:.0f} s: too short for a flight", heights.max_m,
                             min_flight_s)});
            continue;
        }
        if (heights.are_unknown()) {
            phases.warnings.push_back(fmt::format(
                "sortie {}: the altitude is uncertain by {:.0f} m, its height is {:.0f} m: motor and motion show lift-off "
                "and touchdown, take-off and landing are uncertain",
                phases.sorties.size() + 1, heights.wander_m, heights.cruise_height_m));
        }
        phases.sorties.push_back(std::move(sortie));
        phases.sorties.back().number = phases.sorties.size();
        warn_of_gaps(phases.sorties.back(), phases.warnings);
        if (auto warning = hover_in_cruise(data, phases.sorties.back()); !warning.empty())
            phases.warnings.push_back(std::move(warning));
    }
    return phases;
}

void require_sortie(const FlightData& data, const FlightPhases& phases, const std::string& file) {
    if (!phases.sorties.empty()) return;
    std::vector<std::string> events;
    for (const auto& other :
         std::span(phases.ground_events).first(std::min<std::size_t>(phases.ground_events.size(), 3))) {
        events.push_back(fmt::format("{} ({:.0f} to {:.0f} s)", other.what, other.start_s, other.end_s));
    }
    const auto& altitude = data.altitude_m;
    const auto [low_m, high_m] = std::ranges::minmax(altitude.value);
    const auto instead = !events.empty()                 ? fmt::format("it has: {}", fmt::join(events, "; "))
                         : high_m - low_m < min_motion_m ? std::string("no motion")
                                                         : fmt::format("its altitude stays within {:.1f} m (motor: {})",
                                                                       high_m - low_m, phases.motor_source);
    const auto& clock = data.power_w.empty() ? altitude : data.power_w;
    throw InputError({file}, fmt::format("has no flight in {:.0f} s", clock.time_s.back() - clock.time_s.front()),
                     instead);
}

}  // namespace flightwatt::flight
