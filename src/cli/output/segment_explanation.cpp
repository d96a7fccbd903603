#include "cli/output/segment_explanation.h"

#include "flight/chosen_track.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::cli {

std::string witness_text(const flight::ExplainedEdge& edge) {
    std::string text;
    const auto add = [&](const flight::EdgeWitness& event, const char* how) {
        text += fmt::format("{}{}{} at {:.1f} s ({:+.1f} s)", text.empty() ? "" : "; ", how, event.what,
                            event.time_s, event.after_s);
    };
    for (const auto& witness : edge.witnesses) add(witness, "");
    for (const auto& event : edge.nearby) add(event, "nearby: ");
    return text.empty() ? "-" : text;
}

TextTable edges_table(const flight::FlightSeries& series, const flight::FlightPhases& phases) {
    TextTable table{
        {"sortie", "edge", "time s", "altitude m", "height %", "throttle %", "gap s", "verdict", "witnesses"},
        {}};
    for (std::size_t s = 0; s < phases.sorties.size(); ++s) {
        for (const auto& explained : explain_edges(series, phases.sorties[s])) {
            const auto& edge = explained.edge;
            table.rows.push_back({fmt::format("{}", s + 1), std::string(to_string(explained.kind)),
                                  fmt::format("{:.1f}", edge.time_s), fmt::format("{:.1f}", edge.altitude_m),
                                  fmt::format("{:.1f}", explained.height_percent),
                                  edge.throttle_percent ? fmt::format("{:.0f}", *edge.throttle_percent) : "-",
                                  fmt::format("{:.1f}", edge.gap_s), explained.verdict,
                                  witness_text(explained)});
        }
    }
    return table;
}

namespace {

/// How far the power record can be trusted, a line each.
std::string power_text(const flight::FlightSeries& series, const flight::PowerReport& power) {
    std::string text =
        fmt::format("power: {}, current {}\n", power_track(series).source, to_string(power.origin));
    if (power.idle) {
        text += fmt::format("idle current on the ground: {:.4f} A, standard deviation {:.4f} A, {} samples\n",
                            power.idle->mean_a, power.idle->deviation_a, power.idle->samples);
    }
    if (power.energy_closure_percent) {
        text += fmt::format("integral of power over the on-board energy counter: {:+.2f} %\n",
                            *power.energy_closure_percent);
    }
    if (power.charge_closure_percent) {
        text += fmt::format("integral of current over the on-board charge counter: {:+.2f} %\n",
                            *power.charge_closure_percent);
    }
    double longest_s = 0.0;
    for (const auto& gap : power.gaps) longest_s = std::max(longest_s, gap.duration_s);
    text += fmt::format("gaps in flight: {}, the longest {:.1f} s\n", power.gaps.size(), longest_s);
    for (const auto& fault : power.power_faults) text += fmt::format("power fault: {}\n", fault);
    return text;
}

}  // namespace

std::string explanation(const flight::FlightSeries& series, const flight::FlightPhases& phases,
                        const flight::PowerReport& power) {
    std::string text = to_text(edges_table(series, phases));
    for (const auto& other : phases.ground_events) {
        text +=
            fmt::format("no flight from {:.0f} to {:.0f} s: {}\n", other.start_s, other.end_s, other.what);
    }
    return text + power_text(series, power);
}

}  // namespace flightwatt::cli
