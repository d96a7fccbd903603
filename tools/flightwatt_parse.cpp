// flightwatt parse: a Paparazzi log to the series CSV of its power samples.

#include "cli/output/flight_options.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "flight/flight_identity.h"
#include "flight/phase_statistics.h"
#include "flight/series_file.h"
#include "stages.h"

#include <fmt/format.h>

namespace flightwatt::flight {

Fields<EstimatedWind> record_fields(const EstimatedWind*) {
    using R = EstimatedWind;
    return {field("start_s", &R::start_s, "of the wind"),
            field("end_s", &R::end_s, "of the wind"),
            field("east_m_per_s", &R::east_m_per_s, "to the east"),
            field("north_m_per_s", &R::north_m_per_s, "to the north"),
            field("east_variance", &R::east_variance, "m^2/s^2"),
            field("covariance", &R::covariance, "m^2/s^2"),
            field("north_variance", &R::north_variance, "m^2/s^2")};
}

Fields<AirspeedEstimate> record_fields(const AirspeedEstimate*) {
    using R = AirspeedEstimate;
    return {field("winds", &R::winds, "winds that the ground velocity shows"),
            field("sd_m_per_s", &R::sd_m_per_s, "error of the airspeed in means over 30 s"),
            field("mean_sd_m_per_s", &R::mean_sd_m_per_s, "error of the airspeed in the mean of the flight")};
}

}  // namespace flightwatt::flight

namespace {

using namespace flightwatt;

/// JSON of the stage.
struct ParseOutput {
    const flight::LoadedFlight* loaded = nullptr;
    std::string power_source;
    std::size_t samples = 0;
    std::optional<double> start_s, end_s, median_interval_s;
};

Fields<ParseOutput> record_fields(const ParseOutput*) {
    using R = ParseOutput;
    using L = flight::LoadedFlight;
    using D = flight::FlightData;
    const auto sources = [](const L& loaded) {
        const auto by_name = track_sources(loaded.data);
        return Keyed<std::string>(by_name.begin(), by_name.end());
    };
    return {
        field("flight", at(&R::loaded, &L::data, &D::flight), "name of the flight"),
        field("aircraft_id", at(&R::loaded, &L::data, &D::aircraft_id), "id of the aircraft"),
        field("aircraft_name", at(&R::loaded, &L::data, &D::aircraft_name), "name of the aircraft"),
        field("power_source", &R::power_source, "message of the power"),
        field("samples", &R::samples, "power samples"),
        field("start_s", &R::start_s, "first power sample"),
        field("end_s", &R::end_s, "last power sample"),
        field("median_interval_s", &R::median_interval_s, "between power samples"),
        field("sources", at(&R::loaded, sources), "message of each track"),
        field("airspeed_estimate", at(&R::loaded, &L::data, &D::airspeed_estimate), "null: measured, or unknown"),
        field("warnings", at(&R::loaded, [](const L& loaded) { return texts_of(loaded.diagnostics); }), "warnings")};
}

int parse(const cli::StageCall& call, flight::LoadOptions options) {
    options.flight_required = false;
    options.power_required = false;
    const auto loaded = cli::load_flight(call, call.inputs.front(), options);
    const auto& series = loaded.series;
    constexpr std::size_t rows = 24;
    const TextWriter csv = [&](const TextSink& sink) { write_csv(series, sink); };
    write_csv_result(call, csv,
                     {fmt::format("{}: aircraft {}", series.flight,
                                  flight::describe_aircraft(series.aircraft_id, series.aircraft_name)),
                      {"time_s", "power_w", "voltage_v", "current_a", "altitude_m", "throttle_percent"},
                      rows});
    const auto& power = loaded.data.power_w;
    if (call.json) {
        ParseOutput output{&loaded, power.source, power.time_s.size(), {}, {}, {}};
        if (!power.empty()) {
            output.start_s = power.time_s.front();
            output.end_s = power.time_s.back();
            output.median_interval_s = flight::median_interval_s(power.time_s);
        }
        cli::print_json(call, output);
        return cli::ok;
    }
    const auto samples =
        power.empty() ? std::string("no power")
                      : fmt::format("{} samples from {:.1f} to {:.1f} s, usually {:.2f} s apart", power.time_s.size(),
                                    power.time_s.front(), power.time_s.back(), flight::median_interval_s(power.time_s));
    cli::note(call,
              fmt::format("{}: aircraft {} {}, {}", series.flight, series.aircraft_id, series.aircraft_name, samples));
    for (const auto& [name, source] : track_sources(loaded.data)) {
        cli::note(call, fmt::format("  {:<20} from {}", name, source));
    }
    return cli::ok;
}

}  // namespace

int flightwatt::stages::parse_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "parse", "LOG",
        R"(Reads a Paparazzi log with its .log, .data or the .LOG of an SD card, a .bin of ArduPilot, a .ulg of PX4,
a .tlog of a ground station (also .gz, .bz2, .xz, .zst), or a CSV with --columns, and
writes its data on the flight as a series file (CSV): power, voltage, current, charge, energy, throttle,
altitude, position, speeds, wind, attitude, mode and block, each at the times when it was logged.
Any stage reads the series file as it reads the log, with the same results.)"};
    stage.next = [](const auto&) { return "flightwatt segment {}"; };
    stage.json_schema = cli::document_schema<ParseOutput>;
    stage.max_inputs = 1;
    stage.examples = {"flightwatt parse flight.data -o flight.csv",
                      "flightwatt parse flight.LOG --messages messages.xml --json"};
    stage.reads_logs = stage.uses_threads = stage.shows_table = true;
    flight::LoadOptions load;
    cli::add_flight_options(stage.options, load);
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return parse(call, load); });
}
