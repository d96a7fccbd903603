#include "cli/output/segment_output.h"

#include "base/duration_text.h"
#include "batch/flight_record.h"
#include "flight/flight_identity.h"
#include "flight/phase_statistics.h"
#include "flight/selected_track.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {

Fields<EdgeEvent> record_fields(const EdgeEvent*) {
    using R = EdgeEvent;
    return {field("what", &R::what, "event"), field("time_s", &R::time_s, "time of the event"),
            field("after_s", &R::after_s, "after the edge")};
}

Fields<EdgeReport> record_fields(const EdgeReport*) {
    using R = EdgeReport;
    return {field("edge", &R::kind, "name of the edge"),
            field(
                "time_s", [](const R& edge) { return edge.edge.time_s; }, "time of the edge"),
            field(
                "altitude_m", [](const R& edge) { return edge.edge.altitude_m; }, "altitude"),
            field("height_percent", &R::height_percent, "of the flight's height"),
            field("matching_events", &R::matching_events, "autopilot events that mark the edge"),
            field("other_events", &R::other_events, "other autopilot events near it"),
            field("agreement", &R::agreement, "agreement with the events")};
}

Fields<HeldAltitude> record_fields(const HeldAltitude*) {
    using R = HeldAltitude;
    return {field("height_m", &R::height_m, "above the ground"),
            field(
                "start_s", [](const R& r) { return r.start_s; }, "start"),
            field(
                "end_s", [](const R& r) { return r.end_s; }, "end"),
            field("of_landing", &R::of_landing, "a step of the landing")};
}

Fields<GroundEvent> record_fields(const GroundEvent*) {
    using R = GroundEvent;
    return {field(
                "start_s", [](const R& r) { return r.start_s; }, "start"),
            field(
                "end_s", [](const R& r) { return r.end_s; }, "end"),
            field("what", &R::what, "reason why it is not a flight")};
}

Fields<SampleGap> record_fields(const SampleGap*) {
    using R = SampleGap;
    return {field("start_s", &R::start_s, "start"), field("duration_s", &R::duration_s, "duration")};
}

Fields<IdleCurrent> record_fields(const IdleCurrent*) {
    using R = IdleCurrent;
    return {field("mean_a", &R::mean_a, "mean"), field("sd_a", &R::sd_a, "standard deviation"),
            field("samples", &R::samples, "samples")};
}

Fields<PowerReport> record_fields(const PowerReport*) {
    using R = PowerReport;
    return {field(
                "current_origin", [](const R& r) { return std::string(to_string(r.origin)); },
                "measured, or computed from throttle"),
            field("idle_current", &R::idle, "current on the ground"),
            field("energy_closure_percent", &R::energy_closure_percent, "integral of power over the counter, less 100"),
            field("charge_closure_percent", &R::charge_closure_percent, "the same of current and charge"),
            field("gaps", &R::gaps, "gaps in flight"),
            field("power_faults", &R::power_faults, "faults")};
}

}  // namespace flightwatt::flight

namespace flightwatt::cli {
namespace {

/// A phase with its power.
struct PhaseSpanOutput {
    flight::PhaseSpan span;
    std::optional<flight::PhaseStatistics> statistics;
};

Fields<PhaseSpanOutput> record_fields(const PhaseSpanOutput*) {
    using R = PhaseSpanOutput;
    using P = flight::PhaseSpan;
    using E = flight::PhaseEdge;
    return list_fields<R>(field("phase", at(&R::span, &P::phase), "`takeoff`, `cruise` or `landing`"),
                          field("start_s", at(&R::span, &P::start, &E::time_s), "in the log's time"),
                          field("end_s", at(&R::span, &P::end, &E::time_s), "in the log's time"),
                          field("duration_s", at(&R::span, &P::duration_s), "end less start"),
                          embedded_or_null([](const R& r) { return r.statistics ? &*r.statistics : nullptr; }),
                          field("complete", at(&R::span, &P::complete), "false: the log begins or ends in the phase"));
}

/// A sortie with its phases and edges.
struct SortieOutput {
    flight::Sortie sortie;
    std::vector<PhaseSpanOutput> phases;
    std::vector<flight::EdgeReport> edges;
};

Fields<SortieOutput> record_fields(const SortieOutput*) {
    using R = SortieOutput;
    using S = flight::Sortie;
    return {field("ground_altitude_m", at(&R::sortie, &S::ground_altitude_m), "altitude of the ground"),
            field("height_m", at(&R::sortie, &S::height_m), "height of the cruise above the ground"),
            field("held_heights", at(&R::sortie, &S::held), "heights that were held"),
            field("phases", &R::phases, "phases"), field("edges", &R::edges, "edges of the phases")};
}

std::vector<SortieOutput> sortie_outputs(const SegmentedFlight& flight) {
    const flight::SelectedTracks tracks(*flight.series);
    const flight::PowerStatistics power(*flight.series);
    std::vector<SortieOutput> all;
    for (const auto& sortie : flight.phases->sorties) {
        auto& output = all.emplace_back(SortieOutput{sortie, {}, compare_edges_with_events(tracks, sortie)});
        for (const auto& span : sortie.phases)
            output.phases.push_back({span, power.has_power()
                                               ? std::optional(power.between(span.start.time_s, span.end.time_s))
                                               : std::nullopt});
    }
    return all;
}

/// The heights that were held, a line each.
std::string heights_text(const flight::Sortie& sortie) {
    std::string text;
    for (const auto& hold : sortie.held) {
        text += fmt::format("sortie {}: held {:.1f} m from {:.1f} to {:.1f} s ({}): {}\n", sortie.number, hold.height_m,
                            hold.start_s, hold.end_s, duration_text(hold.duration_s()),
                            hold.of_landing ? "a step of the landing" : "cruise");
    }
    return text;
}

}  // namespace

std::string events_text(const flight::EdgeReport& edge) {
    std::string text;
    const auto add = [&](const flight::EdgeEvent& event, const char* how) {
        text += fmt::format("{}{}{} at {:.1f} s ({:+.1f} s)", text.empty() ? "" : "; ", how, event.what, event.time_s,
                            event.after_s);
    };
    for (const auto& event : edge.matching_events) add(event, "");
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
        {"sortie", "edge", "time s", "altitude m", "height %", "throttle %", "gap s", "agreement", "events"}, {}};
    const flight::SelectedTracks tracks(series);
    for (std::size_t s = 0; s < phases.sorties.size(); ++s) {
        for (const auto& explained : compare_edges_with_events(tracks, phases.sorties[s])) {
            const auto& edge = explained.edge;
            table.rows.push_back({fmt::format("{}", s + 1), std::string(to_string(explained.kind)),
                                  fixed(edge.time_s, 1), fixed(edge.altitude_m, 1), fixed(explained.height_percent, 1),
                                  fixed(edge.throttle_percent, 0), fixed(edge.gap_s, 1), explained.agreement,
                                  events_text(explained)});
        }
    }
    return table;
}

std::string explanation(const flight::FlightSeries& series, const flight::FlightPhases& phases,
                        const flight::PowerReport& power, const Screen& screen) {
    const ScreenTable shown{describe_flight(series, phases),
                            {"sortie", "edge", "time s", "agreement", "altitude m", "events"}};
    std::string text = screen_text(edges_table(series, phases), screen, shown);
    for (const auto& sortie : phases.sorties) text += heights_text(sortie);
    if (!phases.motor_source.empty()) text += fmt::format("motor signal: {}\n", phases.motor_source);
    return text + (power_track(series).empty()
                       ? "power: not measured\n"
                       : values_text({{"power", power_track(series).source}}) + values_text(record_json(power)) +
                             fmt::format("gaps in flight: {}\n", power.gaps.size()));
}

Fields<SegmentedFlight> record_fields(const SegmentedFlight*) {
    using R = SegmentedFlight;
    using S = flight::FlightSeries;
    using P = flight::FlightPhases;
    const auto source = [](const S& series) { return power_track(series).source; };
    return {field("flight", at(&R::series, &S::flight), "name of the flight"),
            field("aircraft_id", at(&R::series, &S::aircraft_id), "id of the aircraft"),
            field("aircraft_name", at(&R::series, &S::aircraft_name), "name of the aircraft"),
            field("synthetic", at(&R::series, &S::aircraft_name, flight::is_synthetic), "made by `synthesize`"),
            field("power_source", at(&R::series, source), "message of the power"),
            field("motor_evidence", at(&R::phases, &P::motor_source), "signal of the running motor"),
            field(
                "sorties", [](const R& r) { return sortie_outputs(r); }, "flights of the log"),
            field("rejected_activities", at(&R::phases, &P::ground_events), "the motor ran without a flight"),
            field("power", &R::power, "the power record"),
            field("warnings", &R::warnings, "warnings")};
}

Fields<SegmentOutput> record_fields(const SegmentOutput*) {
    auto flights = field("flights", &SegmentOutput::flights, "flights of all logs");
    flights.schema = &JsonType<std::vector<SegmentedFlight>>::schema;
    return {std::move(flights)};
}

}  // namespace flightwatt::cli
