// flightwatt merge: the folders of several batches as one.

#include "base/atomic_file.h"
#include "base/error.h"
#include "batch/batch_fit.h"
#include "batch/merge.h"
#include "batch/write_guard.h"
#include "cli/output/records.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "cli/terminal.h"
#include "mechanical/validation.h"
#include "stages.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace flightwatt;
using Json = nlohmann::ordered_json;

/// The result as JSON.
Json json_of(const cli::StageCall& call, const batch::MergePlan& plan, const batch::BatchFlights& flights,
             const std::vector<batch::DuplicateFlight>& copies) {
    const auto accepted = std::ranges::count_if(flights, [](const auto& flight) { return flight.record.accepted; });
    Json json{{"folder", *call.output},
              {"batches", Json::array()},
              {"flights", flights.size()},
              {"accepted", accepted},
              {"rejected", static_cast<std::ptrdiff_t>(flights.size()) - accepted},
              {"already_there", std::ranges::count(flights, true, &batch::BatchFlight::was_up_to_date)},
              {"renamed", Json::array()},
              {"repeated_logs", plan.duplicate_logs},
              {"copies", Json::array()}};
    for (std::size_t i = 0; i < plan.flights_per_batch.size(); ++i)
        json["batches"].push_back({{"folder", call.inputs[i]}, {"flights", plan.flights_per_batch[i]}});
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const auto& [from, before] = plan.sources[i];
        const auto& name = plan.folder.logs[i].flight;
        if (before != name) json["renamed"].push_back({{"folder", from}, {"before", before}, {"flight", name}});
    }
    for (const auto& [flight, same_as, has_power] : copies)
        if (has_power) json["copies"].push_back({{"flight", flight}, {"same_as", same_as}});
    return json;
}

/// The result as text.
std::string text_of(const cli::StageCall& call, const Json& json) {
    auto folders = json["batches"];
    folders.push_back({{"folder", json["folder"]}, {"flights", json["flights"]}});
    return screen_text(cli::table_of(folders, {"folder: batch", "flights"}), screen_of(call), {"merged", {}}) +
           fmt::format(
               "{} accepted, {} rejected; {} renamed, {} were there already, {} of logs that were in another "
               "batch too\n",
               json["accepted"].dump(), json["rejected"].dump(), json["renamed"].size(), json["already_there"].dump(),
               json["repeated_logs"].dump());
}

/// Removes a model in the folder: it was fitted to other flights.
void remove_model(const cli::StageCall& call, const std::filesystem::path& out) {
    const auto removed = batch::remove_batch_fit(out);
    if (!removed.empty())
        cli::note(call, fmt::format("removed: {}: made from what the folder held before", fmt::join(removed, ", ")));
}

int merge(const cli::StageCall& call, bool prune) {
    if (!call.output) throw UsageError("no folder given: expected -o FOLDER");
    const std::filesystem::path out = *call.output;
    const std::vector<std::filesystem::path> batches(call.inputs.begin(), call.inputs.end());
    make_directories(out);
    const batch::FolderLock lock(out);
    const batch::RemoveIfEmpty folder{out};  // where nothing can be done
    const auto plan = batch::plan_merge(batches, out, prune);
    batch::refuse_foreign_files(plan.folder, out);
    for (const auto& dropped : plan.folder.dropped)
        cli::note(call, fmt::format("dropped: {}, {}", dropped.flight, dropped.reason));
    const batch::RemoveIfEmpty unfinished{out / batch::temporary_folder};
    batch::prepare_folder(plan.folder, out);
    remove_model(call, out);
    cli::ProgressBar progress("flights");
    batch::end_at_signals(call.program);
    const auto needed = mechanical::min_samples(mechanical::ModelFitOptions{}.phases.order);
    auto flights = batch::merge_flights(
        plan, out, needed, [&](std::size_t done, std::size_t all, const auto&) { progress.show(done, all); });
    progress.hide();
    const auto copies = batch::find_duplicates(flights);
    exclude_duplicates(flights, copies);
    const auto count = std::ranges::count_if(copies, &batch::DuplicateFlight::has_power);
    if (count > 0) {
        const auto& [flight, other, has_power] = *std::ranges::find_if(copies, &batch::DuplicateFlight::has_power);
        cli::warn(call, fmt::format("{} of the flights are others under a second name, and are not fitted: {} is the "
                                    "same flight as {}{}; --json names all",
                                    count, flight, other, count > 1 ? ", ..." : ""));
    }
    write_file_atomically(out / batch::catalogue_name, batch::catalogue_csv(flights), out / batch::temporary_folder);
    const auto json = json_of(call, plan, flights, copies);
    cli::print(call.json ? cli::json_text(json) : text_of(call, json));
    cli::note(call, fmt::format("next: flightwatt fit {} -o MODEL.toml", cli::shell_quoted(out.string())));
    return cli::ok;
}

}  // namespace

int flightwatt::stages::merge_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "merge", "OUT... -o OUT",
        R"(Joins folders of flightwatt batch into one: every flight's files, checked against the fingerprints of their
records, and flights.csv of all, as one batch of all logs would have written them, whatever folders they came
from and in whatever order they were joined. The logs are not read. Files are hard links where the
file system has them, else copies. A log that is in several folders is taken once; flights of one
name get the names NAME, NAME_2, ... by the paths of their logs. Nothing is fitted: flightwatt fit does that.
Nothing in OUT is replaced or removed but what OUT/batch.json lists as a batch's.)"};
    stage.shows_table = true;
    stage.output_help = "the folder of the results";
    stage.examples = {"flightwatt merge part1 part2 -o all", "flightwatt merge part* -o all --prune"};
    stage.uses_threads = true;
    bool prune = false;
    stage.options.add("prune", prune, "drop the flights of OUT that are in none of the folders given");
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return merge(call, prune); });
}
