#include "flight/edge_events.h"

#include "base/units.h"
#include "flight/selected_track.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr int manual_mode = 0;
constexpr int auto2_mode = 2;

/// A change of a state (mode or block), or a message without states.
struct Change {
    double time_s;
    int from = 0;
    int to = 0;
};

/// The changes of a state, or all messages, near a time.
std::vector<Change> changes_near(const Track& state, double near_s, bool is_message) {
    std::vector<Change> changes;
    const auto first = std::ranges::lower_bound(state.time_s, near_s - max_event_distance_s) - state.time_s.begin();
    for (auto i = static_cast<std::size_t>(first); i < state.value.size(); ++i) {
        if (state.time_s[i] > near_s + max_event_distance_s) break;
        if (is_message) {
            changes.push_back({state.time_s[i]});
            continue;
        }
        if (i == 0 || state.value[i] == state.value[i - 1]) continue;
        changes.push_back({state.time_s[i], static_cast<int>(state.value[i - 1]), static_cast<int>(state.value[i])});
    }
    return changes;
}

using BlockNames = std::map<int, std::string>;

bool name_contains(const BlockNames& names, int block, std::string_view word) {
    const auto found = names.find(block);
    if (found == names.end()) return false;
    std::string lower;
    for (const char c : found->second) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) continue;  // "Take-off" and "Take Off" are equal
        lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return lower.find(word) != std::string::npos;
}

/// Changes of a track that belong to an edge.
struct Sign {
    EdgeKind edge;
    const char* track;
    bool (*matches)(const BlockNames& names, const Change& change);
};

bool leaves_takeoff(const BlockNames& names, const Change& c) { return name_contains(names, c.from, "takeoff"); }

bool begins_to_land(const BlockNames& names, const Change& c) {
    return name_contains(names, c.to, "land") && !name_contains(names, c.from, "land");
}

constexpr Sign signs[] = {
    {EdgeKind::lift_off, "takeoff", [](const BlockNames&, const Change&) { return true; }},
    {EdgeKind::takeoff_end, "block", leaves_takeoff},
    {EdgeKind::takeoff_end, "mode", [](const BlockNames&, const Change& c) { return c.to == auto2_mode; }},
    {EdgeKind::landing_start, "block", begins_to_land},
    {EdgeKind::landing_start, "mode", [](const BlockNames&, const Change& c) { return c.from == auto2_mode; }},
    {EdgeKind::touchdown, "mode", [](const BlockNames&, const Change& c) { return c.to == manual_mode; }},
};

std::string event_text(const FlightSeries& series, std::string_view track, const Change& change) {
    if (track == "takeoff") return "TAKEOFF";
    if (track == "mode") return fmt::format("mode {} -> {}", change.from, change.to);
    const auto name = [&](int block) {
        const auto found = series.block_names.find(block);
        return found == series.block_names.end() ? fmt::format("{}", block) : found->second;
    };
    return fmt::format("block {} -> {}", name(change.from), name(change.to));
}

/// The nearest event of each sign of that edge.
std::vector<EdgeEvent> events_of(const SelectedTracks& tracks, EdgeKind kind, double edge_s) {
    const auto& series = tracks.series();
    std::vector<EdgeEvent> events;
    for (const auto& sign : signs) {
        if (sign.edge != kind) continue;
        auto changes = changes_near(tracks[sign.track], edge_s, kind == EdgeKind::lift_off);
        const auto distance_s = [&](const Change& change) { return std::abs(change.time_s - edge_s); };
        std::erase_if(changes, [&](const Change& change) {
            return distance_s(change) > max_event_distance_s || !sign.matches(series.block_names, change);
        });
        if (changes.empty()) continue;
        const auto nearest = *std::ranges::min_element(changes, {}, distance_s);
        events.push_back({event_text(series, sign.track, nearest), nearest.time_s, nearest.time_s - edge_s});
    }
    return events;
}

/// Whether the events of an edge happen at the edge itself.
bool marks_edge(EdgeKind kind) { return kind == EdgeKind::lift_off || kind == EdgeKind::landing_start; }

}  // namespace

std::string_view to_string(EdgeKind kind) {
    constexpr std::array<std::string_view, 4> names{"lift-off", "end of take-off", "start of landing", "touchdown"};
    return names[static_cast<std::size_t>(kind)];
}

std::vector<EdgeReport> compare_edges_with_events(const SelectedTracks& tracks, const Sortie& sortie) {
    std::vector<EdgeReport> edges;
    const auto add = [&](EdgeKind kind, const PhaseEdge& edge) {
        EdgeReport report;
        report.kind = kind;
        report.edge = edge;
        report.height_percent =
            units::percent_per_whole * (edge.altitude_m - sortie.ground_altitude_m) / sortie.height_m;
        (marks_edge(kind) ? report.matching_events : report.other_events) = events_of(tracks, kind, edge.time_s);
        if (report.matching_events.empty()) {
            report.agreement = "no event";
        } else {
            const double distance_s = std::abs(report.matching_events.front().after_s);
            report.agreement = distance_s <= agreement_s ? "agrees" : fmt::format("differs by {:.0f} s", distance_s);
        }
        edges.push_back(std::move(report));
    };
    for (const auto& span : sortie.phases) {
        if (span.phase == Phase::takeoff) {
            if (span.complete) add(EdgeKind::lift_off, span.start);
            add(EdgeKind::takeoff_end, span.end);
        }
        if (span.phase == Phase::landing) {
            add(EdgeKind::landing_start, span.start);
            if (span.complete) add(EdgeKind::touchdown, span.end);
        }
    }
    return edges;
}

}  // namespace flightwatt::flight
