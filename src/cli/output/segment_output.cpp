#include "cli/output/segment_output.h"

#include "base/duration_text.h"
#include "cli/output/records.h"
#include "cli/stage.h"
#include "flight/flight_identity.h"
#include "flight/phase_statistics.h"
#include "flight/selected_track.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

Json to_json(const flight::PhaseEdge& edge) {
    return {{"altitude_m", edge.altitude_m},
            {"gap_s", edge.gap_s},
            {"throttle_percent", optional_json(edge.throttle_percent)},
            {"mode", optional_json(edge.mode)},
            {"block", optional_json(edge.block)},
            {"takeoff_message_after_s", optional_json(edge.takeoff_after_s)}};
}

Json to_json(const flight::PowerStatistics& power, const flight::PhaseSpan& span) {
    const auto statistics = power.between(span.start.time_s, span.end.time_s);
    const auto known = [&](auto value) { return power.has_power() ? Json(value) : Json(); };
    return {{"phase", to_string(span.phase)},
            {"start_s", span.start.time_s},
            {"end_s", span.end.time_s},
            {"duration_s", span.duration_s()},
            {"samples", known(statistics.samples)},
            {"mean_power_w", known(statistics.mean_power_w)},
            {"energy_wh", known(statistics.energy_wh)},
            {"counter_energy_wh", optional_json(statistics.counter_energy_wh)},
            {"gaps", known(statistics.gaps)},
            {"longest_gap_s", known(statistics.max_gap_s)},
            {"complete", span.complete},
            {"evidence", {{"start", to_json(span.start)}, {"end", to_json(span.end)}}}};
}

Json event_json(const flight::EdgeEvent& event) {
    return {{"what", event.what}, {"time_s", event.time_s}, {"after_s", event.after_s}};
}

Json edge_json(const flight::EdgeReport& explained) {
    return {{"edge", to_string(explained.kind)},
            {"time_s", explained.edge.time_s},
            {"height_percent", explained.height_percent},
            {"witnesses", list_json(explained.matching_events, event_json)},
            {"nearby", list_json(explained.other_events, event_json)},
            {"verdict", explained.agreement}};
}

Json to_json(const flight::SelectedTracks& tracks, const flight::PowerStatistics& power, const flight::Sortie& sortie) {
    const auto held_json = [](const auto& hold) -> Json {
        return {{"height_m", hold.height_m},
                {"start_s", hold.start_s},
                {"end_s", hold.end_s},
                {"of_landing", hold.of_landing}};
    };
    return {{"ground_altitude_m", sortie.ground_altitude_m},
            {"height_m", sortie.height_m},
            {"held_heights", list_json(sortie.held, held_json)},
            {"phases", list_json(sortie.phases, [&](const auto& span) { return to_json(power, span); })},
            {"edges", list_json(compare_edges_with_events(tracks, sortie), edge_json)}};
}

Json to_json(const flight::PowerReport& report) {
    const auto gap_json = [](const auto& gap) -> Json {
        return {{"start_s", gap.start_s}, {"duration_s", gap.duration_s}};
    };
    Json idle;
    if (report.idle) {
        idle = {{"mean_a", report.idle->mean_a}, {"deviation_a", report.idle->sd_a}, {"samples", report.idle->samples}};
    }
    return {{"current_origin", to_string(report.origin)},
            {"idle_current", idle},
            {"energy_closure_percent", optional_json(report.energy_closure_percent)},
            {"charge_closure_percent", optional_json(report.charge_closure_percent)},
            {"gaps", list_json(report.gaps, gap_json)},
            {"power_faults", report.power_faults}};
}

/// The heights that were held, and why the landing begins where it does, a line each.
std::string heights_text(const flight::Sortie& sortie) {
    std::string text;
    for (const auto& hold : sortie.held) {
        text += fmt::format("sortie {}: held {:.1f} m from {:.1f} to {:.1f} s ({}): {}\n", sortie.number, hold.height_m,
                            hold.start_s, hold.end_s, duration_text(hold.duration_s()),
                            hold.of_landing ? "a step of the landing" : "cruise");
    }
    return text;
}

/// How far the power record can be trusted, a line each.
std::string power_text(const flight::FlightSeries& series, const flight::PowerReport& power) {
    if (power_track(series).empty()) return "power: not measured\n";
    std::string text = fmt::format("power: {}, current {}\n", power_track(series).source, to_string(power.origin));
    if (power.idle) {
        text += fmt::format("idle current on the ground: {:.4f} A, standard deviation {:.4f} A, {} samples\n",
                            power.idle->mean_a, power.idle->sd_a, power.idle->samples);
    }
    if (power.energy_closure_percent) {
        text += fmt::format("integral of power over the on-board energy counter: {:+.2f} %\n",
                            *power.energy_closure_percent);
    }
    if (power.charge_closure_percent) {
        text += fmt::format("integral of current over the on-board charge counter: {:+.2f} %\n",
                            *power.charge_closure_percent);
    }
    double max_s = 0.0;
    for (const auto& gap : power.gaps) max_s = std::max(max_s, gap.duration_s);
    text += fmt::format("gaps in flight: {}, the longest {:.1f} s\n", power.gaps.size(), max_s);
    for (const auto& fault : power.power_faults) text += fmt::format("power fault: {}\n", fault);
    for (const auto& warning : power.warnings) text += fmt::format("doubtful: {}\n", warning);
    return text;
}

}  // namespace

std::string witness_text(const flight::EdgeReport& edge) {
    std::string text;
    const auto add = [&](const flight::EdgeEvent& event, const char* how) {
        text += fmt::format("{}{}{} at {:.1f} s ({:+.1f} s)", text.empty() ? "" : "; ", how, event.what, event.time_s,
                            event.after_s);
    };
    for (const auto& witness : edge.matching_events) add(witness, "");
    for (const auto& event : edge.other_events) add(event, "nearby: ");
    return text.empty() ? "-" : text;
}

std::string describe_flight(const flight::FlightSeries& series, const flight::FlightPhases& phases) {
    const auto sorties = phases.sorties.size();
    return fmt::format("{}: aircraft {}, {} sortie{}", series.flight,
                       flight::describe_aircraft(series.aircraft_id, series.aircraft_name), sorties,
                       sorties == 1 ? "" : "s");
}

TextTable edges_table(const flight::FlightSeries& series, const flight::FlightPhases& phases) {
    TextTable table{
        {"sortie", "edge", "time s", "altitude m", "height %", "throttle %", "gap s", "verdict", "witnesses"}, {}};
    const flight::SelectedTracks tracks(series);
    for (std::size_t s = 0; s < phases.sorties.size(); ++s) {
        for (const auto& explained : compare_edges_with_events(tracks, phases.sorties[s])) {
            const auto& edge = explained.edge;
            table.rows.push_back({fmt::format("{}", s + 1), std::string(to_string(explained.kind)),
                                  fixed(edge.time_s, 1), fixed(edge.altitude_m, 1), fixed(explained.height_percent, 1),
                                  fixed(edge.throttle_percent, 0), fixed(edge.gap_s, 1), explained.agreement,
                                  witness_text(explained)});
        }
    }
    return table;
}

std::string explanation(const flight::FlightSeries& series, const flight::FlightPhases& phases,
                        const flight::PowerReport& power, const Screen& screen) {
    const ScreenTable shown{describe_flight(series, phases),
                            {"sortie", "edge", "time s", "verdict", "altitude m", "witnesses"}};
    std::string text = screen_text(edges_table(series, phases), screen, shown);
    for (const auto& sortie : phases.sorties) text += heights_text(sortie);
    for (const auto& other : phases.ground_events) {
        text += fmt::format("no flight from {:.0f} to {:.0f} s: {}\n", other.start_s, other.end_s, other.what);
    }
    if (!phases.motor_source.empty()) text += fmt::format("motor told by {}\n", phases.motor_source);
    return text + power_text(series, power);
}

Json to_json(const flight::FlightSeries& series, const flight::FlightPhases& phases, const flight::PowerReport& power,
             const std::vector<std::string>& warnings) {
    const flight::SelectedTracks tracks(series);
    const flight::PowerStatistics statistics(series);
    const auto sortie_json = [&](const auto& sortie) { return to_json(tracks, statistics, sortie); };
    const auto other_json = [](const auto& other) -> Json {
        return {{"start_s", other.start_s}, {"end_s", other.end_s}, {"what", other.what}};
    };
    return {{"flight", series.flight},
            {"aircraft_id", series.aircraft_id},
            {"aircraft_name", series.aircraft_name},
            {"synthetic", flight::is_synthetic(series.aircraft_name)},
            {"power_source", power_track(series).source},
            {"motor_evidence", phases.motor_source},
            {"sorties", list_json(phases.sorties, sortie_json)},
            {"not_flights", list_json(phases.ground_events, other_json)},
            {"power", to_json(power)},
            {"warnings", warnings}};
}

}  // namespace flightwatt::cli
