#include "batch/flight_record.h"

#include "batch/measured_json.h"
#include "flight/chosen_track.h"
#include "flight/edge_witness.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace flightwatt::batch {
namespace {

using Json = nlohmann::ordered_json;

Json phase_json(const RecordedPhase& phase) {
    const auto& statistics = phase.statistics;
    return {
        {"sortie", phase.sortie},
        {"phase", to_string(phase.phase)},
        {"start_s", phase.start_s},
        {"end_s", phase.end_s},
        {"start_gap_s", phase.start_gap_s},
        {"end_gap_s", phase.end_gap_s},
        {"complete", phase.complete},
        {"samples", statistics.samples},
        {"mean_power_w", statistics.mean_power_w},
        {"energy_wh", statistics.energy_wh},
        {"counter_energy_wh", statistics.counter_energy_wh ? Json(*statistics.counter_energy_wh) : Json()},
        {"gaps", statistics.gaps},
        {"longest_gap_s", statistics.longest_gap_s}};
}

RecordedPhase recorded_phase(const Json& json) {
    RecordedPhase phase;
    phase.sortie = json.at("sortie");
    phase.phase = flight::phase_from(json.at("phase").get<std::string>()).value();
    phase.start_s = json.at("start_s");
    phase.end_s = json.at("end_s");
    phase.start_gap_s = json.at("start_gap_s");
    phase.end_gap_s = json.at("end_gap_s");
    phase.complete = json.at("complete");
    phase.statistics.samples = json.at("samples");
    phase.statistics.mean_power_w = json.at("mean_power_w");
    phase.statistics.energy_wh = json.at("energy_wh");
    if (const auto& counter = json.at("counter_energy_wh"); !counter.is_null()) {
        phase.statistics.counter_energy_wh = counter.get<double>();
    }
    phase.statistics.gaps = json.at("gaps");
    phase.statistics.longest_gap_s = json.at("longest_gap_s");
    return phase;
}

/// What the best witness of an edge says.
std::string verdict_text(const flight::ExplainedEdge& explained) {
    if (explained.witnesses.empty()) return explained.verdict;
    const auto& best = explained.witnesses.front();
    return fmt::format("{}{} {} ({:+.1f} s)", explained.verdict,
                       explained.verdict == "agrees" ? " with" : " from", best.what, best.after_s);
}

}  // namespace

FlightRecord record_of(const flight::LoadedFlight& loaded) {
    const auto& [series, phases, power, exclusion, warnings] = loaded;
    FlightRecord record;
    record.flight = series.flight;
    record.accepted = true;
    record.aircraft_id = series.aircraft_id;
    record.power_source = power_track(series).source;
    record.current_origin = to_string(series.current_origin);
    record.warnings = warnings;
    record.power_faults = power.power_faults;
    record.measured = mechanical::measure_flights(series, phases, 0);
    for (const auto& sortie : phases.sorties) {
        for (const auto& edge : explain_edges(series, sortie)) {
            record.verdicts.push_back({edge.edge.time_s, verdict_text(edge)});
        }
        for (const auto& span : sortie.phases) {
            record.phases.push_back({sortie.number, span.phase, span.start.time_s, span.end.time_s,
                                     span.start.gap_s, span.end.gap_s, span.complete,
                                     phase_statistics(series, span.start.time_s, span.end.time_s)});
        }
    }
    return record;
}

std::string to_json_text(const FlightRecord& record) {
    Json phases = Json::array();
    for (const auto& phase : record.phases) phases.push_back(phase_json(phase));
    Json verdicts = Json::array();
    for (const auto& [time_s, verdict] : record.verdicts) {
        verdicts.push_back({{"time_s", time_s}, {"verdict", verdict}});
    }
    const Json json{{"flight", record.flight},
                    {"log", record.log},
                    {"fingerprint", record.fingerprint},
                    {"results", record.results},
                    {"accepted", record.accepted},
                    {"error", record.error},
                    {"aircraft_id", record.aircraft_id},
                    {"power_source", record.power_source},
                    {"current_origin", record.current_origin},
                    {"phases", phases},
                    {"verdicts", verdicts},
                    {"warnings", record.warnings},
                    {"power_faults", record.power_faults},
                    {"why_not_fitted", record.why_not_fitted},
                    {"measured", measured_json(record.measured)}};
    // File names need not be UTF-8, and a record must never fail for that.
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<FlightRecord> record_from_json(const std::string& text) {
    try {
        const auto json = Json::parse(text);
        FlightRecord record;
        record.flight = json.at("flight");
        record.log = json.at("log");
        record.fingerprint = json.at("fingerprint");
        record.results = json.at("results");
        record.accepted = json.at("accepted");
        record.error = json.at("error");
        record.aircraft_id = json.at("aircraft_id");
        record.power_source = json.at("power_source");
        record.current_origin = json.at("current_origin");
        for (const auto& phase : json.at("phases")) record.phases.push_back(recorded_phase(phase));
        for (const auto& edge : json.at("verdicts")) {
            record.verdicts.push_back({edge.at("time_s"), edge.at("verdict")});
        }
        record.warnings = json.at("warnings").get<std::vector<std::string>>();
        record.power_faults = json.at("power_faults").get<std::vector<std::string>>();
        record.why_not_fitted = json.at("why_not_fitted");
        record.measured = measured_from_json(json.at("measured"));
        return record;
    } catch (const std::exception&) {
        return std::nullopt;  // damaged or of another version: the log is done again
    }
}

}  // namespace flightwatt::batch
