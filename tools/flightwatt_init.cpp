// A folder for an aircraft: its logs, fits and missions, and the commands that lead from one to the other.

#include "base/atomic_file.h"
#include "cli/output/stage_options.h"
#include "cli/stage.h"
#include "stages.h"

#include <array>
#include <filesystem>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

/// JSON of the stage.
struct InitOutput {
    std::filesystem::path folder;
    std::vector<std::string> folders;
    std::filesystem::path commands;
};

Fields<InitOutput> record_fields(const InitOutput*) {
    using R = InitOutput;
    return {field("folder", &R::folder, "the new folder"), field("folders", &R::folders, "folders in it"),
            field("commands", &R::commands, "file with the commands")};
}

constexpr std::array<const char*, 3> folders{"logs", "fits", "missions"};

/// The four commands, for make(1) or to be typed. A line that make runs begins with a tab.
std::string list_of_commands(const std::optional<double>& capacity_ah) {
    return fmt::format(
        R"(# From logs to a report in four commands. `make` runs those that something newer asks for; they may be typed as well.
# Put the logs of your flights into logs/ first: .bin, .ulg, .tlog, .data with its .log, CSV.

report.html: missions/first.csv
	flightwatt report fits missions/first.toml -o report.html

# State of charge over time.
missions/first.csv: missions/first.toml fits/model.toml fits/answer-pack.toml
	flightwatt simulate missions/first.toml -o missions/first.csv

# Written once, then yours: every key is explained in it.
missions/first.toml: | fits/model.toml fits/answer-pack.toml
	flightwatt new-mission --model fits/model.toml --battery fits/answer-pack.toml -o missions/first.toml

# How long and how far it flies, the model, the pack and a page: fits/answer.html. --capacity is the value on the pack's
# label [Ah]; without it, that of the logs or an estimate is used. Exit code 3: a log was not used, the others were.
fits/answer-pack.toml: fits/model.toml
fits/model.toml: logs $(wildcard logs/*) $(firstword $(MAKEFILE_LIST))
	flightwatt logs{} -o fits || {{ test $$? = 3 && test -f $@; }}
)",
        capacity_ah ? fmt::format(" --capacity {}", *capacity_ah) : "");
}

int make_folder(const cli::StageCall& call, const std::optional<double>& capacity_ah) {
    const std::filesystem::path root = call.inputs.front();
    const std::filesystem::path list = call.output ? std::filesystem::path(*call.output) : root / "Makefile";
    std::error_code none;
    if (std::filesystem::exists(list, none)) {
        throw OutputError(fmt::format("{} is there already and stays as it is; nothing was made", list.string()));
    }
    for (const auto* folder : folders) make_directories(root / folder);
    write_file_atomically(list, list_of_commands(capacity_ah));
    if (call.json) {
        cli::print_json(call, InitOutput{root, {folders.begin(), folders.end()}, list});
    } else {
        cli::print(fmt::format(
            "{0}/logs      put each flight's log here: .bin, .ulg, .tlog, CSV, or .data with its .log\n"
            "{0}/fits      models, and what was found of each flight\n"
            "{0}/missions  what is to be flown\n"
            "{1}  the four commands from logs to report.html{2}\n",
            root.string(), list.string(), call.output ? "" : ": make -C " + cli::shell_quoted(root.string())));
    }
    return cli::ok;
}

}  // namespace

int flightwatt::stages::init_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "init", "DIR",
        R"(Lays out a folder for an aircraft: logs/, fits/, missions/, and a Makefile with the four commands that lead from
logs to a report. Folders that are there stay; a Makefile that is there is not replaced, and then nothing is
made.)"};
    stage.json_schema = cli::document_schema<InitOutput>;
    stage.max_inputs = 1;
    stage.output_help = "write the list of commands to FILE instead of DIR/Makefile";
    stage.examples = {"flightwatt init my --capacity 2.2", "flightwatt init my -o my/commands.mk"};
    std::optional<double> capacity_ah;
    cli::add_capacity_option(
        stage.options, capacity_ah,
        "the capacity on the pack's label, for the command that answers; default: that of the logs, or the flights' estimate");
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return make_folder(call, capacity_ah); });
}
