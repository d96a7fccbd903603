// The front: `flightwatt STAGE ...` runs flightwatt-STAGE, which stands beside it, as git does.

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/toml_reader.h"
#include "cli/help_pages.h"
#include "cli/stage.h"
#include "cli/version.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

namespace {

using namespace flightwatt;

struct StageLine {
    std::string_view name;
    std::string_view summary;
};

constexpr StageLine stages[] = {
    {"init", "a folder for an aircraft, with the five commands from logs to a report"},
    {"parse", "a Paparazzi log to a table of its power samples (CSV)"},
    {"convert", "a binary log of an SD card or a link to text"},
    {"segment", "take-off, cruise and landing of every sortie in a log"},
    {"fit", "several flights to a mechanical power model and Table I"},
    {"validate", "leave-one-out: each flight's energy predicted by the others, beside simple baselines"},
    {"predict", "the energy to the end of a flight that is in the air"},
    {"watch", "the same and more, once a second, from telemetry as it comes in"},
    {"diff", "what differs between two models, batches or missions, and whether it is chance"},
    {"trends", "how aircraft and pack age: energy, power and resistance over the dates of flights"},
    {"battery", "flights to the battery that they were flown on"},
    {"batch", "parse, segment and fit every log of a folder, incrementally"},
    {"merge", "join the folders of several batches into one"},
    {"profile", "software to its power by quality of service, measured while it runs"},
    {"new-mission", "a mission file to begin with, every key explained"},
    {"simulate", "a mission file to its state of charge over time"},
    {"compare", "several missions, ranked by final state of charge"},
    {"plan", "the schedule of highest utility that lands a mission with its reserve"},
    {"replay", "schedules judged on flights that were flown: planned, replanned in flight, in hindsight"},
    {"path", "the path of a mission leg by leg; of a log as waypoints"},
    {"play", "a log once more as it came in, over the links that watch listens to"},
    {"report", "flights, model and missions as one page, and figures for papers"},
    {"export", "flights, models and missions for other programs: maps, plots, autopilots, LaTeX"},
    {"synthesize", "synthetic Paparazzi logs of flights after a model"},
};

std::string stage_list() {
    std::string text = "\nStages:\n";
    for (const auto& [name, summary] : stages) text += fmt::format("  {:<11} {}\n", name, summary);
    return text;
}

bool is_stage(std::string_view name) { return std::ranges::find(stages, name, &StageLine::name) != std::end(stages); }

std::vector<std::string> stage_names() {
    std::vector<std::string> names;
    for (const auto& stage : stages) names.emplace_back(stage.name);
    return names;
}

/// "did you mean 'plan'?", or what to do instead where nothing is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& known, const char* otherwise) {
    const auto near = nearest_word(word, known);
    return near.empty() ? otherwise : fmt::format("did you mean '{}'?", near);
}

[[noreturn]] void refuse_stage(const std::string& stage) {
    if (is_stage(stage)) {
        throw OutputError(fmt::format("the program flightwatt-{} is missing beside flightwatt", stage));
    }
    throw UsageError(fmt::format("there is no stage '{}'; {}", stage,
                                 suggestion(stage, stage_names(), "flightwatt alone lists them")));
}

/// Becomes flightwatt-STAGE. `arguments` ends with nullptr; its first becomes the program's name.
[[noreturn]] void run_program(const std::string& stage, char** arguments) {
    if (stage.find('/') != std::string::npos || stage.starts_with('-')) refuse_stage(stage);
    const auto program = "flightwatt-" + stage;
    const auto beside = executable_folder() / program;
    ::execv(beside.c_str(), arguments);
    if (errno == ENOENT) ::execvp(program.c_str(), arguments);
    if (errno == ENOENT) refuse_stage(stage);
    throw OutputError(fmt::format("cannot run {}: {}", beside.string(), std::strerror(errno)));
}

std::filesystem::path documentation() {
    return data_folder("docs", "FLIGHTWATT_DOCS", "the pages of the documentation");
}

void list_topics() {
    std::string text =
        "usage: flightwatt help STAGE   what a stage does and its options\n"
        "       flightwatt help PAGE    a page of the documentation\n\nPages:\n";
    for (const auto& page : cli::help_pages(documentation())) {
        text += fmt::format("  {:<11} {}\n", page.topic, page.title);
    }
    cli::print(text + stage_list());
}

void help(const std::string& topic) {
    if (is_stage(topic)) {
        std::string words[] = {topic, "--help"};
        char* arguments[] = {words[0].data(), words[1].data(), nullptr};
        run_program(topic, arguments);
    }
    auto known = stage_names();
    for (const auto& page : cli::help_pages(documentation())) {
        if (page.topic == topic) return cli::show_page(read_file(page.file));
        known.push_back(page.topic);
    }
    throw UsageError(fmt::format("there is no help on '{}'; {}", topic,
                                 suggestion(topic, known, "flightwatt help lists what there is")));
}

int run(int argc, char** argv) {
    const std::string stage = argc > 1 ? argv[1] : "--help";
    if (stage == "--help" || stage == "-h") {
        cli::print(
            "flightwatt: the energy of electric drone missions, flight and on-board computer together\n\n"
            "usage: flightwatt STAGE [arguments]; flightwatt help tells more\n" +
            stage_list());
    } else if (stage == "--list-stages") {  // for completion and man pages
        for (const auto& [name, summary] : stages) cli::print(fmt::format("{}\t{}\n", name, summary));
    } else if (stage == "--version") {
        cli::print(fmt::format("flightwatt {}\n", cli::version_text()));
    } else if (stage != "help") {
        run_program(stage, argv + 1);
    } else if (argc > 3) {
        throw UsageError(fmt::format("unexpected argument '{}'; usage: flightwatt help [STAGE|PAGE]", argv[3]));
    } else if (argc == 3) {
        help(argv[2]);
    } else {
        list_topics();
    }
    return cli::ok;
}

}  // namespace

int main(int argc, char** argv) {
    return cli::run_guarded("flightwatt", [&] { return run(argc, argv); });
}
