// flightwatt segment: take-off, cruise and landing of every sortie in a log, or in several.

#include "base/csv.h"
#include "cli/output/flight_options.h"
#include "cli/output/segment_output.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "flight/phases_file.h"
#include "stages.h"

#include <filesystem>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

/// The result of the stage.
struct SegmentedFlights {
    bool explains = false;
    bool are_several = false;  ///< then rows, and texts of --explain, begin with their flight
    std::string title;
    std::string csv;
    std::string explained;
    cli::SegmentOutput json;
};

/// The rows of a CSV behind a first cell with their flight; its header where `csv` has none yet.
void append_rows(const std::string& rows, const std::string& flight, std::string& csv) {
    std::istringstream lines(rows);
    std::string line;
    std::getline(lines, line);
    if (csv.empty()) csv = "flight," + line + "\n";
    while (std::getline(lines, line)) csv += csv_cell(flight) + "," + line + "\n";
}

void add_flight(const cli::StageCall& call, const flight::LoadedFlight& loaded, SegmentedFlights& segmented) {
    const auto& data = loaded.data;
    const auto& phases = loaded.phases;
    const auto& power = loaded.power;
    if (const auto& events = phases.ground_events; !events.empty() && !segmented.explains)
        cli::add_diagnostic(call, {Severity::note, "motion or motor without a flight",
                                   fmt::format("{} time{} without a flight, the first from {:.0f} to {:.0f} s: {}; "
                                               "--explain lists all",
                                               events.size(), events.size() == 1 ? "" : "s", events.front().start_s,
                                               events.front().end_s, events.front().what),
                                   data.flight});
    append(*call.diagnostics, Severity::warning, "power faults", data.flight, power.power_faults);
    segmented.title = cli::describe_flight(data, phases);
    if (segmented.are_several)
        append_rows(flight::phases_csv(data, phases), data.flight, segmented.csv);
    else
        segmented.csv = flight::phases_csv(data, phases);
    if (call.json)
        segmented.json.flights.push_back(
            record_json(cli::SegmentedFlight{&data, &phases, &power, &loaded.diagnostics}));
    if (!segmented.explains) return;
    if (segmented.are_several)
        segmented.explained += (segmented.explained.empty() ? "" : "\n") + segmented.title + "\n";
    segmented.explained += cli::explanation(data, phases, power, screen_of(call));
}

/// Adds those flights of a file that --exclude does not name, and all their names. Returns their number.
std::size_t add_file(const cli::StageCall& call, const std::string& file, const flight::LoadedFile& loaded,
                     const flight::LoadOptions& options, std::vector<std::string>& names, SegmentedFlights& segmented) {
    std::size_t used = 0;
    cli::note_unused(call, file, loaded);
    for (const auto& flight : loaded.flights) {
        names.push_back(flight.series.flight);
        if (options.excluded.contains(names.back())) continue;
        cli::add_diagnostics(call, file, flight);
        add_flight(call, flight, segmented);
        ++used;
    }
    return used;
}

/// The flights of several logs and folders. One that cannot be used is skipped.
void segment_several(const cli::StageCall& call, flight::LoadOptions options, SegmentedFlights& segmented) {
    const auto files = cli::files_of_aircraft(call, cli::files_of(call, options), options);
    options.aircraft_required = false;
    std::vector<std::string> names;
    segmented.are_several = true;
    std::size_t used = 0;
    for (const auto& file : files) {
        const auto name = cli::flight_of_file(file);
        try {
            used += add_file(call, file, flight::load_flights(std::filesystem::path(file), options), options, names,
                             segmented);
            continue;
        } catch (const flight::OtherAircraftError& error) {
            cli::add_other_aircraft(call, name, error);
        } catch (const InputError& error) {
            if (!options.excluded.contains(name)) cli::skip_input(call, file, error);
        }
        names.push_back(name);
    }
    cli::refuse_unknown_flights(options, names);
    if (used == 0) throw InputError({}, "no flight is left", "see the reasons above");
    segmented.title = fmt::format("{} flights", used);
}

/// The flights of one file.
void segment_file(const cli::StageCall& call, const std::string& file, const flight::LoadOptions& options,
                  SegmentedFlights& segmented) {
    const auto loaded = flight::load_flights(std::filesystem::path(file), options);
    segmented.are_several = loaded.flights.size() > 1;
    std::vector<std::string> names;
    const auto used = add_file(call, file, loaded, options, names, segmented);
    cli::refuse_unknown_flights(options, names);
    if (used == 0) throw UsageError(fmt::format("--exclude {}: no other flight is given", names.front()));
    if (used > 1) segmented.title = fmt::format("{} flights", used);
}

int segment_flights(const cli::StageCall& call, flight::LoadOptions options, bool explain) {
    options.power_required = false;
    const auto& file = call.inputs.front();
    std::error_code none;
    SegmentedFlights segmented;
    segmented.explains = explain;
    if (call.inputs.size() > 1 || std::filesystem::is_directory(file, none)) {
        segment_several(call, options, segmented);
    } else {
        segment_file(call, file, options, segmented);
    }
    if (!explain || call.output) {
        write_csv_result(call, segmented.csv,
                         {segmented.title,
                          {"flight", "sortie", "phase", "start_s", "end_s", "duration_s", "mean_power_w", "energy_wh",
                           "samples", "gaps", "complete", "start_altitude_m", "end_altitude_m"}});
    }
    if (call.json) {
        cli::print_json(call, segmented.json);
    } else if (explain) {
        cli::print(segmented.explained);
    }
    return cli::ok;
}

}  // namespace

int flightwatt::stages::segment_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "segment", "LOG|SERIES.csv|FOLDER...",
        R"(Finds every sortie in a log by altitude and throttle and writes its phases as CSV: take-off from
lift-off until the height held is reached (of a rotorcraft: until its climb ends), cruise, landing from
where that height is left until touchdown. TAKEOFF messages, mode and block are shown with each edge for comparison; they are not used.
A log without measured power is segmented too; its columns of power are then empty. Of several logs, or of
a FOLDER of logs or of flightwatt batch, each row begins with its flight. A log that
cannot be used is named and skipped, and the exit code is then 3.)"};
    stage.next = [](const auto&) { return "flightwatt fit {in} -o MODEL.toml"; };
    stage.json_schema = cli::document_schema<cli::SegmentOutput>;
    stage.examples = {"flightwatt segment flight.data", "flightwatt segment logs --explain --aircraft 5 -o phases.csv"};
    stage.reads_logs = stage.shows_table = true;
    flight::LoadOptions load;
    bool explain = false;
    stage.options.add("explain", explain, "show the reasons for each edge, and the quality of the power record");
    cli::add_flight_options(stage.options, load);
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return segment_flights(call, load, explain); });
}
