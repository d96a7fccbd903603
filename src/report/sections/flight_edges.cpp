#include "report/sections/flight_edges.h"

#include "flight/chosen_track.h"
#include "flight/edge_witness.h"

#include <cmath>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

/// Where a phase begins or ends, in words.
std::string explained(const flight::PhaseEdge& edge) {
    auto text = fmt::format("altitude {:.1f} m", edge.altitude_m);
    if (edge.throttle_percent) text += fmt::format(", throttle {:.0f} %", *edge.throttle_percent);
    if (edge.takeoff_after_s && std::abs(*edge.takeoff_after_s) < flight::witness_reach_s) {
        text += fmt::format(", nearest TAKEOFF message {:.1f} s {}", std::abs(*edge.takeoff_after_s),
                            *edge.takeoff_after_s < 0.0 ? "before" : "after");
    }
    if (edge.mode) text += fmt::format(", mode {}", *edge.mode);
    if (edge.block) text += fmt::format(", block {}", *edge.block);
    return text + fmt::format("; known within {:.1f} s", edge.gap_s);
}

std::string edge_name(const flight::PhaseSpan& span, bool begin) {
    switch (span.phase) {
        case flight::Phase::takeoff:
            return begin ? "lift-off" : "end of take-off";
        case flight::Phase::landing:
            return begin ? "start of landing" : "touchdown";
        case flight::Phase::cruise:
            break;
    }
    return begin ? "start of cruise" : "end of cruise, start of landing";
}

/// An incomplete phase begins or ends there because the log does.
bool is_end_of_log(const flight::Track& power, double time_s) {
    constexpr double near_s = 2.0;  // altitude and power have clocks of their own
    return time_s - power.time_s.front() < near_s || power.time_s.back() - time_s < near_s;
}

/// What the autopilot says of the edge, if that was recorded.
std::string verdict_at(const ReportFlight& flight, double time_s) {
    constexpr double same_edge_s = 2e-3;  // edges are rounded to the millisecond
    for (const auto& verdict : flight.verdicts) {
        if (std::abs(verdict.time_s - time_s) < same_edge_s) return verdict.text;
    }
    return "-";
}

}  // namespace

std::vector<NamedEdge> edges_of(const ReportFlight& flight) {
    std::vector<NamedEdge> edges;
    if (flight.phases.sorties.empty()) return edges;
    const auto power = power_track(flight.series);
    for (const auto& sortie : flight.phases.sorties) {
        for (std::size_t i = 0; i < sortie.phases.size(); ++i) {
            const auto& span = sortie.phases[i];
            const bool continues = i > 0 && sortie.phases[i - 1].end.time_s == span.start.time_s;
            const auto add = [&](const flight::PhaseEdge& edge, bool begin) {
                const bool cut = !span.complete && is_end_of_log(power, edge.time_s);
                edges.push_back({edge.time_s,
                                 cut ? (begin ? "the log begins" : "the log ends") : edge_name(span, begin),
                                 explained(edge), verdict_at(flight, edge.time_s)});
            };
            if (!continues) add(span.start, true);
            add(span.end, false);
        }
    }
    return edges;
}

TextTable edge_table(const ReportFlight& flight) {
    TextTable table{{"edge", "time [s]", "evidence", "the autopilot"}, {}};
    for (const auto& edge : edges_of(flight)) {
        table.rows.push_back({edge.name, fmt::format("{:.1f}", edge.time_s), edge.evidence, edge.verdict});
    }
    return table;
}

}  // namespace flightwatt::report
