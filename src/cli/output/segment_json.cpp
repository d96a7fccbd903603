#include "cli/output/segment_json.h"

#include "cli/output/json_text.h"
#include "flight/chosen_track.h"
#include "flight/edge_witness.h"
#include "flight/phase_statistics.h"

namespace flightwatt::cli {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const flight::PhaseEdge& edge) {
    return {{"altitude_m", edge.altitude_m},
            {"gap_s", edge.gap_s},
            {"throttle_percent", optional_json(edge.throttle_percent)},
            {"mode", optional_json(edge.mode)},
            {"block", optional_json(edge.block)},
            {"takeoff_message_after_s", optional_json(edge.takeoff_after_s)}};
}

Json to_json(const flight::FlightSeries& series, const flight::PhaseSpan& span) {
    const auto statistics = phase_statistics(series, span.start.time_s, span.end.time_s);
    return {{"phase", to_string(span.phase)},
            {"start_s", span.start.time_s},
            {"end_s", span.end.time_s},
            {"duration_s", span.duration_s()},
            {"samples", statistics.samples},
            {"mean_power_w", statistics.mean_power_w},
            {"energy_wh", statistics.energy_wh},
            {"counter_energy_wh", optional_json(statistics.counter_energy_wh)},
            {"gaps", statistics.gaps},
            {"longest_gap_s", statistics.longest_gap_s},
            {"complete", span.complete},
            {"evidence", {{"start", to_json(span.start)}, {"end", to_json(span.end)}}}};
}

Json to_json(const flight::ExplainedEdge& explained) {
    const auto events_json = [](const std::vector<flight::EdgeWitness>& events) {
        Json json = Json::array();
        for (const auto& event : events) {
            json.push_back({{"what", event.what}, {"time_s", event.time_s}, {"after_s", event.after_s}});
        }
        return json;
    };
    return {{"edge", to_string(explained.kind)},          {"time_s", explained.edge.time_s},
            {"height_percent", explained.height_percent}, {"witnesses", events_json(explained.witnesses)},
            {"nearby", events_json(explained.nearby)},    {"verdict", explained.verdict}};
}

Json to_json(const flight::FlightSeries& series, const flight::Sortie& sortie) {
    Json phases = Json::array();
    for (const auto& span : sortie.phases) phases.push_back(to_json(series, span));
    Json edges = Json::array();
    for (const auto& edge : explain_edges(series, sortie)) edges.push_back(to_json(edge));
    return {{"ground_altitude_m", sortie.ground_altitude_m},
            {"height_m", sortie.height_m},
            {"phases", phases},
            {"edges", edges}};
}

Json to_json(const flight::PowerReport& report) {
    Json gaps = Json::array();
    for (const auto& gap : report.gaps) {
        gaps.push_back({{"start_s", gap.start_s}, {"duration_s", gap.duration_s}});
    }
    Json idle;
    if (report.idle) {
        idle = {{"mean_a", report.idle->mean_a},
                {"deviation_a", report.idle->deviation_a},
                {"samples", report.idle->samples}};
    }
    return {{"current_origin", to_string(report.origin)},
            {"idle_current", idle},
            {"energy_closure_percent", optional_json(report.energy_closure_percent)},
            {"charge_closure_percent", optional_json(report.charge_closure_percent)},
            {"gaps", gaps},
            {"power_faults", report.power_faults}};
}

}  // namespace

Json to_json(const flight::FlightSeries& series, const flight::FlightPhases& phases,
             const flight::PowerReport& power, const std::vector<std::string>& warnings) {
    Json sorties = Json::array();
    for (const auto& sortie : phases.sorties) sorties.push_back(to_json(series, sortie));
    Json others = Json::array();
    for (const auto& other : phases.ground_events) {
        others.push_back({{"start_s", other.start_s}, {"end_s", other.end_s}, {"what", other.what}});
    }
    return {{"flight", series.flight},
            {"aircraft_id", series.aircraft_id},
            {"power_source", power_track(series).source},
            {"sorties", sorties},
            {"not_flights", others},
            {"power", to_json(power)},
            {"warnings", warnings}};
}

}  // namespace flightwatt::cli
