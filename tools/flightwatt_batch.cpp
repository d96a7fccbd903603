// flightwatt batch: parse and segment every log, incrementally, and fit them.

#include "base/atomic_file.h"
#include "base/toml_reader.h"
#include "batch/batch_run.h"
#include "batch/folder_lock.h"
#include "cli/stage.h"
#include "fit_options.h"
#include "table_one_output.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

namespace {

using namespace flightwatt;

BatchProgress progress_line(const cli::StageCall& call) {
    return [&call](std::size_t done, std::size_t all, const BatchFlight& flight) {
        const auto* what = !flight.record.accepted ? "rejected"
                           : flight.was_up_to_date ? "up to date"
                                                   : "done";
        if (::isatty(STDERR_FILENO) != 0) {
            fmt::print(stderr, "\r\033[K[{}/{}] {} {}{}", done, all, cli::one_line(flight.record.flight),
                       what, done == all ? "\r\033[K" : "");
            std::fflush(stderr);
        } else {
            cli::note(call, fmt::format("[{}/{}] {}: {}", done, all, flight.record.flight, what));
        }
    };
}

void report_notes(const cli::StageCall& call, const std::vector<BatchFlight>& flights) {
    for (const auto& flight : flights) {
        for (const auto& warning : flight.record.warnings) {
            cli::warn(call, fmt::format("{}: {}", flight.record.flight, warning));
        }
        for (const auto& left_out : flight.selection.left_out) {
            cli::warn(call, to_string(left_out));
        }
        if (!flight.record.accepted) {
            cli::note(call, fmt::format("{}: rejected: {}", flight.record.flight, flight.record.error));
        }
    }
}

const std::vector<std::string> model_files{"model.toml", "table1.txt", "table1.csv", "table1.md"};

/// Fits what the batch accepted. On failure no model of an earlier run stays behind to be taken for this
/// one's.
MechanicalModel fit_batch(const cli::StageCall& call, const std::vector<BatchFlight>& flights,
                          const std::filesystem::path& out) {
    auto options = read_fit_options(call);
    options.name = call.get<std::string>("name");
    std::vector<FlightSamples> samples;
    for (const auto& flight : flights) {
        samples.insert(samples.end(), flight.selection.flights.begin(), flight.selection.flights.end());
    }
    try {
        return fit_mechanical_model(samples, options);
    } catch (...) {
        for (const auto& file : model_files) std::filesystem::remove(out / file);
        throw;
    }
}

nlohmann::ordered_json summary_json(const std::vector<BatchFlight>& flights, const MechanicalModel& model) {
    auto json = to_json(model);
    json["logs"] = nlohmann::ordered_json::array();
    for (const auto& flight : flights) {
        json["logs"].push_back({{"flight", flight.record.flight},
                                {"accepted", flight.record.accepted},
                                {"was_up_to_date", flight.was_up_to_date},
                                {"error", flight.record.error}});
    }
    return json;
}

unsigned read_jobs(const cli::StageCall& call) {
    constexpr int most_jobs = 256;  // threads
    const auto jobs = call.get<int>("jobs");
    if (jobs < 0 || jobs > most_jobs) {
        throw UsageError(fmt::format("--jobs is {}, expected 1 to {}, or 0 for one a core", jobs, most_jobs));
    }
    return static_cast<unsigned>(jobs);
}

void refuse_unknown_flights(const std::set<std::string>& keep, const std::vector<LogFile>& logs) {
    std::vector<std::string> names;
    names.reserve(logs.size());
    for (const auto& log : logs) names.push_back(log.flight);
    for (const auto& name : keep) {
        if (std::find(names.begin(), names.end(), name) != names.end()) continue;
        const auto near = nearest_word(name, names);
        throw UsageError(fmt::format("--keep {}: there is no such flight{}", name,
                                     near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
    }
}

int batch(const cli::StageCall& call) {
    if (!call.output) throw UsageError("no folder given: expected -o FOLDER");
    const auto fit_options = read_fit_options(call);  // refuses bad options before the work
    std::optional<MechanicalModel> published;
    if (const auto file = call.maybe<std::string>("published")) published = read_mechanical_model(*file);
    BatchOptions options;
    options.out = *call.output;
    options.aircraft_id = call.maybe<std::string>("aircraft");
    options.jobs = read_jobs(call);
    options.correct_idle_offset = call.has("correct-idle-offset");
    const auto logs = find_logs(call.inputs);
    if (const auto keep = call.maybe<std::vector<std::string>>("keep")) {
        options.keep.insert(keep->begin(), keep->end());
        refuse_unknown_flights(options.keep, logs);
    }
    options.needed_samples = samples_needed(fit_options.phases.order);
    make_directories(options.out);
    const FolderLock lock(options.out);
    const auto flights = run_batch(logs, options, progress_line(call));
    report_notes(call, flights);
    write_file_atomically(options.out / "flights.csv", catalogue_csv(flights));
    if (!call.json) cli::print(to_text(flights_table(flights)));
    const auto rejected = std::count_if(flights.begin(), flights.end(),
                                        [](const auto& flight) { return !flight.record.accepted; });
    if (static_cast<std::size_t>(rejected) == flights.size()) {
        for (const auto& file : model_files) std::filesystem::remove(options.out / file);
        throw InputError({}, fmt::format("all {} logs were rejected, so there is nothing to fit", rejected));
    }
    const auto model = fit_batch(call, flights, options.out);
    const auto table = table_of(model, published);
    write_file_atomically(options.out / "model.toml", to_toml(model));
    for (const auto* name : {"table1.txt", "table1.csv", "table1.md"}) {
        write_file_atomically(options.out / name, table_text(table, name));
    }
    warn_of_bounds(call, model);
    if (call.json)
        cli::print(json_text(summary_json(flights, model)));
    else
        cli::print("\n" + to_text(table));
    if (rejected > 0) {
        cli::note(call, fmt::format("{} of {} logs rejected; the others are done", rejected, flights.size()));
        return cli::input_rejected;
    }
    return cli::ok;
}

}  // namespace

int main(int argc, char** argv) {
    namespace po = boost::program_options;
    cli::StageDefinition stage;
    stage.name = "batch";
    stage.arguments = "LOG|FOLDER... -o OUT";
    stage.description =
        "Parses and segments every .data log (folders are searched to the bottom) into OUT/flights, several "
        "at a\n"
        "time, and fits them: OUT/model.toml, OUT/table1.txt, .csv, .md, and OUT/flights.csv, a row a flight "
        "and\n"
        "phase. Logs whose results are up to date are not done again. A log that cannot be used is reported "
        "and the\n"
        "others go on; the exit code is then 3.";
    stage.output_help = "the folder of the results";
    add_fit_options(stage.options);
    add_power_options(stage.options);
    stage.options.add_options()("name", po::value<std::string>()->value_name("NAME")->default_value("batch"),
                                "the model's name")(
        "published", po::value<std::string>()->value_name("MODEL.toml"), "show Table I beside this model's")(
        "jobs", po::value<int>()->value_name("N")->default_value(0, "one a core"), "logs at a time")(
        "aircraft", po::value<std::string>()->value_name("ID"), "the aircraft to read, where several flew");
    return cli::run_stage(argc, argv, stage, batch);
}
