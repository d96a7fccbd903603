#include "flight/edge_witness.h"

#include "base/units.h"
#include "flight/chosen_track.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr int manual_mode = 0;
constexpr int auto2_mode = 2;

/// A change of a state (mode or block).
struct Change {
    double time_s;
    int from;
    int to;
};

std::vector<Change> changes_of(const Track& state) {
    std::vector<Change> changes;
    for (std::size_t i = 1; i < state.value.size(); ++i) {
        if (state.value[i] == state.value[i - 1]) continue;
        changes.push_back(
            {state.time_s[i], static_cast<int>(state.value[i - 1]), static_cast<int>(state.value[i])});
    }
    return changes;
}

/// The change nearest to the edge among those that match, if one is within reach.
void add_nearest(std::vector<EdgeWitness>& witnesses, double edge_s, const std::vector<Change>& changes,
                 const std::function<bool(const Change&)>& matches,
                 const std::function<std::string(const Change&)>& describe) {
    const Change* nearest = nullptr;
    for (const auto& change : changes) {
        const double distance = std::abs(change.time_s - edge_s);
        if (distance > witness_reach_s || !matches(change)) continue;
        if (nearest == nullptr || distance < std::abs(nearest->time_s - edge_s)) nearest = &change;
    }
    if (nearest != nullptr)
        witnesses.push_back({describe(*nearest), nearest->time_s, nearest->time_s - edge_s});
}

bool name_contains(const std::map<int, std::string>& names, int block, std::string_view word) {
    const auto found = names.find(block);
    if (found == names.end()) return false;
    std::string lower;
    for (const char c : found->second) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) continue;  // "Take-off" and "Take Off" alike
        lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return lower.find(word) != std::string::npos;
}

std::vector<EdgeWitness> events_of(const FlightSeries& series, EdgeKind kind, double edge_s) {
    std::vector<EdgeWitness> witnesses;
    const auto modes = changes_of(chosen_track(series, "mode"));
    const auto blocks = changes_of(chosen_track(series, "block"));
    const auto mode_text = [](const Change& c) { return fmt::format("mode {} -> {}", c.from, c.to); };
    const auto block_text = [&](const Change& c) {
        const auto name = [&](int block) {
            const auto found = series.block_names.find(block);
            return found == series.block_names.end() ? fmt::format("{}", block) : found->second;
        };
        return fmt::format("block {} -> {}", name(c.from), name(c.to));
    };
    const auto& names = series.block_names;
    switch (kind) {
        case EdgeKind::lift_off: {
            std::vector<Change> messages;
            for (const double time_s : chosen_track(series, "takeoff").time_s)
                messages.push_back({time_s, 0, 0});
            add_nearest(
                witnesses, edge_s, messages, [](const Change&) { return true; },
                [](const Change&) { return std::string("TAKEOFF"); });
            break;
        }
        case EdgeKind::takeoff_end:
            add_nearest(
                witnesses, edge_s, blocks,
                [&](const Change& c) { return name_contains(names, c.from, "takeoff"); }, block_text);
            add_nearest(
                witnesses, edge_s, modes, [](const Change& c) { return c.to == auto2_mode; }, mode_text);
            break;
        case EdgeKind::landing_start:
            add_nearest(
                witnesses, edge_s, blocks,
                [&](const Change& c) {
                    return name_contains(names, c.to, "land") && !name_contains(names, c.from, "land");
                },
                block_text);
            add_nearest(
                witnesses, edge_s, modes, [](const Change& c) { return c.from == auto2_mode; }, mode_text);
            break;
        case EdgeKind::touchdown:
            add_nearest(
                witnesses, edge_s, modes, [](const Change& c) { return c.to == manual_mode; }, mode_text);
            break;
    }
    return witnesses;
}

/// Whether what events_of finds happens at the edge itself, and not somewhere about it.
bool marks_edge(EdgeKind kind) { return kind == EdgeKind::lift_off || kind == EdgeKind::landing_start; }

}  // namespace

std::string_view to_string(EdgeKind kind) {
    switch (kind) {
        case EdgeKind::lift_off:
            return "lift-off";
        case EdgeKind::takeoff_end:
            return "end of take-off";
        case EdgeKind::landing_start:
            return "start of landing";
        case EdgeKind::touchdown:
            return "touchdown";
    }
    return "";
}

std::vector<ExplainedEdge> explain_edges(const FlightSeries& series, const Sortie& sortie) {
    std::vector<ExplainedEdge> edges;
    const auto add = [&](EdgeKind kind, const PhaseEdge& edge) {
        ExplainedEdge explained;
        explained.kind = kind;
        explained.edge = edge;
        explained.height_percent =
            units::percent_per_whole * (edge.altitude_m - sortie.ground_altitude_m) / sortie.height_m;
        (marks_edge(kind) ? explained.witnesses : explained.nearby) = events_of(series, kind, edge.time_s);
        if (explained.witnesses.empty()) {
            explained.verdict = "no witness";
        } else {
            const double apart_s = std::abs(explained.witnesses.front().after_s);
            explained.verdict =
                apart_s <= agreement_s ? "agrees" : fmt::format("differs by {:.0f} s", apart_s);
        }
        edges.push_back(std::move(explained));
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
