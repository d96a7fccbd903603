#include "cli/output/segment_output.h"

#include "base/units.h"
#include "batch/flight_record.h"
#include "flight/flight_identity.h"
#include "flight/phase_statistics.h"
#include "flight/vtol_flight.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {

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
    return {field("current_origin", at(&R::origin, [](auto origin) { return std::string(to_string(origin)); }),
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

/// An interval of one kind of flight of a VTOL.
struct VtolSpanOutput {
    flight::VtolSpan span;
    std::optional<flight::PhaseStatistics> statistics;
};

Fields<VtolSpanOutput> record_fields(const VtolSpanOutput*) {
    using R = VtolSpanOutput;
    using S = flight::VtolSpan;
    return list_fields<R>(field(
                              "flight", [](const R& r) { return std::string(to_string(r.span.flight)); },
                              "`hover`, `transition` or `wing`; of ArduPilot `hover` includes transitions"),
                          field("start_s", at(&R::span, &S::start_s), "in the log's time"),
                          field("end_s", at(&R::span, &S::end_s), "in the log's time"),
                          embedded_or_null([](const R& r) { return r.statistics ? &*r.statistics : nullptr; }));
}

/// A sortie with its phases.
struct SortieOutput {
    flight::Sortie sortie;
    std::vector<PhaseSpanOutput> phases;
    std::optional<std::vector<VtolSpanOutput>> vtol;
};

Fields<SortieOutput> record_fields(const SortieOutput*) {
    using R = SortieOutput;
    using S = flight::Sortie;
    return {field("ground_altitude_m", at(&R::sortie, &S::ground_altitude_m), "altitude of the ground"),
            field("height_m", at(&R::sortie, &S::height_m), "height of the cruise above the ground"),
            field("phases", &R::phases, "phases"), field("vtol", &R::vtol, "of a VTOL: how it flew", optional_key())};
}

std::vector<SortieOutput> sortie_outputs(const SegmentedFlight& flight) {
    const flight::PowerStatistics power(*flight.data);
    std::vector<SortieOutput> all;
    const auto statistics = [&](double start_s, double end_s) {
        return power.has_power() ? std::optional(power.between(start_s, end_s)) : std::nullopt;
    };
    for (const auto& sortie : flight.phases->sorties) {
        auto& output = all.emplace_back(SortieOutput{sortie, {}, {}});
        for (const auto& span : sortie.phases)
            output.phases.push_back({span, statistics(span.start.time_s, span.end.time_s)});
        if (!flight.data->vtol_state.empty()) output.vtol.emplace();
        for (const auto& span : vtol_spans(*flight.data, sortie.start_s(), sortie.end_s()))
            output.vtol->push_back({span, statistics(span.start_s, span.end_s)});
    }
    return all;
}

}  // namespace

std::string describe_flight(const flight::FlightData& data, const flight::FlightPhases& phases) {
    const auto sorties = phases.sorties.size();
    return fmt::format("{}: aircraft {}, {} sortie{}", data.flight,
                       flight::describe_aircraft(data.aircraft_id, data.aircraft_name), sorties,
                       sorties == 1 ? "" : "s");
}

TextTable edges_table(const flight::FlightData& data, const flight::FlightPhases& phases) {
    TextTable table{
        {"sortie", "edge", "time s", "altitude m", "height %", "throttle %", "gap s", "mode", "block", "TAKEOFF s"},
        {}};
    const auto whole = [](const std::optional<int>& number) { return number ? fmt::format("{}", *number) : "-"; };
    const auto block_name = [&](const std::optional<int>& block) {
        const auto found = block ? data.block_names.find(*block) : data.block_names.end();
        return found == data.block_names.end() ? whole(block) : found->second;
    };
    for (const auto& sortie : phases.sorties) {
        const auto add = [&](const char* name, const flight::PhaseEdge& edge) {
            const double height_percent =
                units::percentage(edge.altitude_m - sortie.ground_altitude_m, sortie.height_m);
            table.rows.push_back({fmt::format("{}", sortie.number), name, fixed(edge.time_s, 1),
                                  fixed(edge.altitude_m, 1), fixed(height_percent, 1), fixed(edge.throttle_percent, 0),
                                  fixed(edge.gap_s, 1), whole(edge.mode), block_name(edge.block),
                                  fixed(edge.takeoff_after_s, 1)});
        };
        for (const auto& span : sortie.phases) {
            const bool takes_off = span.phase == flight::Phase::takeoff;
            if (span.phase == flight::Phase::cruise) continue;
            if (span.complete || !takes_off) add(takes_off ? "lift-off" : "start of landing", span.start);
            if (span.complete || takes_off) add(takes_off ? "end of take-off" : "touchdown", span.end);
        }
    }
    return table;
}

std::string explanation(const flight::FlightData& data, const flight::FlightPhases& phases,
                        const flight::PowerReport& power, const Screen& screen) {
    const ScreenTable shown{describe_flight(data, phases),
                            {"sortie", "edge", "time s", "altitude m", "height %", "throttle %"}};
    std::string text = screen_text(edges_table(data, phases), screen, shown);
    for (const auto& other : phases.ground_events)
        text += fmt::format("no flight from {:.0f} to {:.0f} s: {}\n", other.start_s, other.end_s, other.what);
    for (const auto& [name, energy_wh, percent] : circuit_shares(data, phases))
        text += fmt::format("circuit of {}: {:.3f} Wh, {:.0f} % of the energy\n", name, energy_wh, percent);
    if (!phases.motor_source.empty()) text += fmt::format("motor signal: {}\n", phases.motor_source);
    return text + (data.power_w.empty()
                       ? "power: not measured\n"
                       : values_text({{"power", data.power_w.source}}) + values_text(record_json(power)) +
                             fmt::format("gaps in flight: {}\n", power.gaps.size()));
}

Fields<SegmentedFlight> record_fields(const SegmentedFlight*) {
    using R = SegmentedFlight;
    using S = flight::FlightData;
    using P = flight::FlightPhases;
    const auto source = [](const S& data) { return data.power_w.source; };
    return {field("flight", at(&R::data, &S::flight), "name of the flight"),
            field("aircraft_id", at(&R::data, &S::aircraft_id), "id of the aircraft"),
            field("aircraft_name", at(&R::data, &S::aircraft_name), "name of the aircraft"),
            field("synthetic", at(&R::data, &S::aircraft_name, flight::is_synthetic), "made by `synthesize`"),
            field("power_source", at(&R::data, source), "message of the power"),
            field("motor_evidence", at(&R::phases, &P::motor_source), "signal of the running motor"),
            field(
                "circuits", [](const R& r) { return circuit_shares(*r.data, *r.phases); },
                "circuits of its batteries, the one with the most energy first"),
            field("sorties", sortie_outputs, "flights of the log"),
            field("rejected_activities", at(&R::phases, &P::ground_events), "the motor ran without a flight"),
            field("power", &R::power, "the power record"),
            field("warnings", at(&R::diagnostics, [](const Diagnostics& all) { return texts_of(all); }),
                  "texts of the diagnostics"),
            field("diagnostics", &R::diagnostics, "notes, warnings and errors")};
}

Fields<SegmentOutput> record_fields(const SegmentOutput*) {
    auto flights = field("flights", &SegmentOutput::flights, "flights of all logs");
    flights.schema = &JsonType<std::vector<SegmentedFlight>>::schema;
    return {std::move(flights)};
}

}  // namespace flightwatt::cli
