// flightwatt segment: take-off, cruise and landing of every sortie in a log.

#include "cli/stage.h"
#include "flight/flight_reader.h"
#include "flight/phase_statistics.h"
#include "flight/segmentation.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace {

using namespace flightwatt;
using Json = nlohmann::ordered_json;

template <typename T>
Json optional_json(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json edge_json(const PhaseEdge& edge) {
    return {{"altitude_m", edge.altitude_m},
            {"gap_s", edge.gap_s},
            {"throttle_percent", optional_json(edge.throttle_percent)},
            {"mode", optional_json(edge.mode)},
            {"block", optional_json(edge.block)},
            {"takeoff_message_after_s", optional_json(edge.takeoff_after_s)}};
}

Json sortie_json(const FlightSeries& series, const Sortie& sortie) {
    Json phases = Json::array();
    for (const auto& span : sortie.phases) {
        const auto statistics = phase_statistics(series, span.start.time_s, span.end.time_s);
        phases.push_back({{"phase", to_string(span.phase)},
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
                          {"evidence", {{"start", edge_json(span.start)}, {"end", edge_json(span.end)}}}});
    }
    return {
        {"ground_altitude_m", sortie.ground_altitude_m}, {"height_m", sortie.height_m}, {"phases", phases}};
}

Json flight_json(const FlightSeries& series, const FlightPhases& phases) {
    Json sorties = Json::array();
    for (const auto& sortie : phases.sorties) sorties.push_back(sortie_json(series, sortie));
    Json others = Json::array();
    for (const auto& other : phases.others) {
        others.push_back({{"start_s", other.start_s}, {"end_s", other.end_s}, {"what", other.what}});
    }
    auto warnings = series.warnings;
    warnings.insert(warnings.end(), phases.warnings.begin(), phases.warnings.end());
    return {{"flight", series.flight},
            {"aircraft_id", series.aircraft_id},
            {"power_source", series.power_source},
            {"sorties", sorties},
            {"not_flights", others},
            {"warnings", warnings}};
}

int segment_flight(const cli::StageCall& call) {
    const auto& file = call.inputs.front();
    const auto series = read_flight(file, call.maybe<std::string>("aircraft"));
    SegmentationOptions options;
    options.cruise_fraction = call.get<double>("cruise-fraction");
    options.ground_fraction = call.get<double>("ground-fraction");
    options.flight_height_m = call.get<double>("flight-height");
    const auto phases = segment(series, options);
    require_sortie(series, phases, file);
    for (const auto& warning : series.warnings) cli::warn(call, fmt::format("{}: {}", file, warning));
    for (const auto& warning : phases.warnings) cli::warn(call, fmt::format("{}: {}", file, warning));
    for (const auto& other : phases.others) {
        cli::note(call, fmt::format("{}: no flight from {:.0f} to {:.0f} s: {}", file, other.start_s,
                                    other.end_s, other.what));
    }
    cli::write_result(call, phases_csv(series, phases));
    if (call.json) cli::print(flight_json(series, phases).dump(2) + "\n");
    return cli::ok;
}

}  // namespace

int main(int argc, char** argv) {
    namespace po = boost::program_options;
    const SegmentationOptions defaults;
    cli::StageDefinition stage;
    stage.name = "segment";
    stage.arguments = "FLIGHT.data|SERIES.csv";
    stage.description =
        "Finds every sortie in a log by altitude and throttle and writes its phases as CSV: take-off from\n"
        "lift-off until the height held is reached, cruise, landing from where that height is left until\n"
        "touchdown. TAKEOFF messages, mode and block stand beside each edge as witnesses; they decide "
        "nothing.";
    stage.max_inputs = 1;
    stage.options.add_options()("aircraft", po::value<std::string>()->value_name("ID"),
                                "the aircraft to read, where several flew")(
        "cruise-fraction",
        po::value<double>()->value_name("X")->default_value(defaults.cruise_fraction, "0.9"),
        "take-off ends and landing begins at this fraction of the height held")(
        "ground-fraction",
        po::value<double>()->value_name("X")->default_value(defaults.ground_fraction, "0.025"),
        "below this fraction of the flight's height it is on the ground")(
        "flight-height", po::value<double>()->value_name("M")->default_value(defaults.flight_height_m, "10"),
        "what stays below this height [m] is no flight");
    return cli::run_stage(argc, argv, stage, segment_flight);
}
