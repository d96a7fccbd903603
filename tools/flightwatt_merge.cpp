// flightwatt merge: the folders of several batches as one.

#include "base/atomic_file.h"
#include "batch/batch_files.h"
#include "batch/batch_fit.h"
#include "batch/merge.h"
#include "cli/output/flight_options.h"
#include "cli/stage.h"
#include "cli/terminal.h"
#include "mechanical/validation.h"
#include "stages.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::batch {

Fields<DuplicateFlight> record_fields(const DuplicateFlight*) {
    using R = DuplicateFlight;
    return {field("flight", &R::flight, "a duplicate, which is not fitted"),
            field("same_as", &R::same_as, "the flight that is fitted")};
}

}  // namespace flightwatt::batch

namespace {

using namespace flightwatt;

struct RenamedFlight {
    std::string folder;
    std::string before;
    std::string flight;
};

Fields<RenamedFlight> record_fields(const RenamedFlight*) {
    using R = RenamedFlight;
    return {field("folder", &R::folder, "folder of the batch"), field("before", &R::before, "name there"),
            field("flight", &R::flight, "new name")};
}

/// JSON of the stage.
struct MergeOutput {
    std::string folder;
    std::size_t flights = 0;
    std::size_t accepted = 0;
    std::size_t rejected = 0;
    std::size_t already_there = 0;
    std::vector<RenamedFlight> renamed = {};
    std::size_t repeated_logs = 0;
    std::vector<batch::DuplicateFlight> copies = {};
};

Fields<MergeOutput> record_fields(const MergeOutput*) {
    using R = MergeOutput;
    return {field("folder", &R::folder, "folder of all flights"),
            field("flights", &R::flights, "flights of the folder"),
            field("accepted", &R::accepted, "usable logs"),
            field("rejected", &R::rejected, "rejected logs"),
            field("already_there", &R::already_there, "flights whose files were up to date"),
            field("renamed", &R::renamed, "flights whose name was taken"),
            field("repeated_logs", &R::repeated_logs, "logs of several batches"),
            field("copies", &R::copies, "duplicates of other flights")};
}

MergeOutput merge_output(const cli::StageCall& call, const batch::MergePlan& plan, const batch::BatchFlights& flights,
                         const std::vector<batch::DuplicateFlight>& copies) {
    MergeOutput output{.folder = *call.output, .flights = flights.size(), .repeated_logs = plan.duplicate_logs};
    for (const auto& flight : flights) {
        if (flight.record.accepted) ++output.accepted;
        if (flight.was_up_to_date) ++output.already_there;
    }
    for (std::size_t i = 0; i < plan.sources.size(); ++i) {
        const auto& [from, before] = plan.sources[i];
        const auto& name = plan.folder.logs[i].flight;
        if (before != name) output.renamed.push_back({from, before, name});
    }
    output.rejected = flights.size() - output.accepted;
    std::ranges::copy_if(copies, std::back_inserter(output.copies), &batch::DuplicateFlight::has_power);
    return output;
}

std::string text_of(const MergeOutput& output) {
    return fmt::format(
        "{}: {} flights; {} accepted, {} rejected; {} renamed, {} were there already, {} of logs that were in another "
        "batch too\n",
        output.folder, output.flights, output.accepted, output.rejected, output.renamed.size(), output.already_there,
        output.repeated_logs);
}

/// Removes a model in the folder: it was fitted to other flights.
void remove_model(const cli::StageCall& call, const std::filesystem::path& out) {
    const auto removed = batch::remove_batch_fit(out);
    if (!removed.empty())
        cli::note(call, fmt::format("removed: {}: made from what the folder held before", fmt::join(removed, ", ")));
}

int merge(const cli::StageCall& call, bool prune) {
    if (!call.output) throw UsageError("no folder for the results: expected -o DIR");
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
    auto flights = batch::merge_flights(
        plan, out, [&](std::size_t done, std::size_t all, const auto&) { progress.show(done, all); });
    progress.hide();
    const auto copies = batch::find_duplicates(flights);
    exclude_duplicates(flights, copies);
    for (const auto& exclusion : exclude_hover(flights, {})) add_diagnostic(call, cli::diagnostic_of(exclusion));
    const auto count = std::ranges::count_if(copies, &batch::DuplicateFlight::has_power);
    if (count > 0) {
        const auto& [flight, other, has_power] = *std::ranges::find_if(copies, &batch::DuplicateFlight::has_power);
        cli::warn(call, fmt::format("{} of the flights are others under a second name, and are not fitted: {} is the "
                                    "same flight as {}{}; --json names all",
                                    count, flight, other, count > 1 ? ", ..." : ""));
    }
    write_file_atomically(out / batch::catalogue_name, batch::catalogue_csv(flights), out / batch::temporary_folder);
    const auto output = merge_output(call, plan, flights, copies);
    if (call.json)
        cli::print_json(call, output);
    else
        cli::print(text_of(output));
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
A folder that has files of these names, but no OUT/batch.json, is refused.)"};
    stage.next = [](const auto&) { return "flightwatt fit {} -o MODEL.toml"; };
    stage.json_schema = cli::document_schema<MergeOutput>;
    stage.output_value = "DIR";
    stage.output_help = "the folder of the results";
    stage.examples = {"flightwatt merge part1 part2 -o all", "flightwatt merge part* -o all --prune"};
    stage.uses_threads = true;
    bool prune = false;
    stage.options.add("prune", prune, "drop the flights of OUT that are in none of the folders given");
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return merge(call, prune); });
}
