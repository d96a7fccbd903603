// The program: `flightwatt STAGE ...`. flightwatt-STAGE is a link to it.

#include "base/input_file.h"
#include "base/toml_reader.h"
#include "cli/stage.h"
#include "cli/terminal.h"
#include "stages.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {

using namespace flightwatt;

struct Stage {
    std::string_view name;
    std::string_view summary;
    int (*run)(int argc, char** argv);
};

struct StageGroup {
    std::string_view title;
    std::vector<Stage> stages;
};

const std::vector<StageGroup>& stage_groups() {
    static const std::vector<StageGroup> groups{
        {"Answers",
         {{"answer", "how long and how far an aircraft flies, from its logs; `flightwatt LOG...` is the same",
           stages::answer_stage}}},
        {"Logs",
         {{"init", "a folder for an aircraft, with the four commands from logs to a report", stages::init_stage},
          {"convert", "a binary log of an SD card or a link to text", stages::convert_stage},
          {"batch", "parse, segment and fit every log of a folder (.data, .bin, .ulg, .tlog, CSV)",
           stages::batch_stage},
          {"parse", "a log (.data, .bin, .ulg, .tlog, CSV) to a table of its samples (CSV)", stages::parse_stage},
          {"segment", "take-off, cruise and landing of every sortie in a log", stages::segment_stage},
          {"merge", "join the folders of several batches into one", stages::merge_stage},
          {"trends", "ageing of aircraft and pack: energy, power and resistance over the dates of flights",
           stages::trends_stage}}},
        {"Models",
         {{"fit", "several flights to a mechanical power model and Table I", stages::fit_stage},
          {"validate", "leave-one-out: each flight's energy predicted by the others, next to simple baselines",
           stages::validate_stage},
          {"battery", "flights to the battery that they were flown on", stages::battery_stage},
          {"profile", "software to its power by quality of service, measured while it runs", stages::profile_stage},
          {"diff", "differences of two models, batches or missions, and their significance", stages::diff_stage}}},
        {"Missions",
         {{"check", "a flight plan: whether it fits the battery, leg by leg, and what would help", stages::check_stage},
          {"new-mission", "a mission file to begin with, also of a flight plan", stages::new_mission_stage},
          {"path", "the path of a mission leg by leg; of a log as waypoints", stages::path_stage},
          {"simulate", "a mission file to its state of charge over time", stages::simulate_stage},
          {"plan", "the schedule of maximum utility that lands a mission with its reserve", stages::plan_stage},
          {"compare", "several missions, ranked by final state of charge", stages::compare_stage},
          {"replay", "schedules on the power of measured flights: planned, replanned in flight, in hindsight",
           stages::replay_stage},
          {"report", "flights, model and missions as one page, and figures for papers", stages::report_stage}}},
        {"In the air",
         {{"predict", "the energy to the end of a flight that is in the air", stages::predict_stage},
          {"watch", "the same and more, once a second, from telemetry as it arrives", stages::watch_stage},
          {"play", "a log as live telemetry, over the links that watch listens to", stages::play_stage}}},
        {"For other programs",
         {{"export", "flights, models and missions for other programs: maps, plots, autopilots, LaTeX",
           stages::export_stage},
          {"synthesize", "synthetic Paparazzi logs of flights after a model", stages::synthesize_stage}}}};
    return groups;
}

std::vector<Stage> all_stages() {
    std::vector<Stage> all;
    for (const auto& group : stage_groups()) all.insert(all.end(), group.stages.begin(), group.stages.end());
    return all;
}

/// The way from logs to a first answer, before the stages.
std::string start_text() {
    return "\nTo begin, with the logs of an aircraft (.bin, .ulg, .tlog, .data with its .log, CSV):\n"
           "  flightwatt LOGS --capacity 5   how long and how far it flies on a pack of 5 Ah, and a page\n"
           "  flightwatt init my-drone       a folder for them, with the commands up to missions\n";
}

std::string stage_list() {
    constexpr std::size_t name_width = 14;
    std::string text;
    for (const auto& [title, members] : stage_groups()) {
        text += fmt::format("\n{}:\n", title);
        for (const auto& stage : members) {
            auto summary = cli::fitted(std::string(stage.summary), stdout, name_width);
            boost::algorithm::replace_all(summary, "\n", "\n" + std::string(name_width, ' '));
            text += fmt::format("  {:<11} {}\n", stage.name, summary);
        }
    }
    return text;
}

std::optional<Stage> find_stage(std::string_view name) {
    for (const auto& stage : all_stages())
        if (stage.name == name) return stage;
    return std::nullopt;
}

std::vector<std::string> stage_names() {
    std::vector<std::string> names;
    for (const auto& stage : all_stages()) names.emplace_back(stage.name);
    return names;
}

int show_help(const Stage& stage) {
    std::string words[] = {std::string(stage.name), "--help"};
    char* arguments[] = {words[0].data(), words[1].data(), nullptr};
    return stage.run(2, arguments);
}

/// What shows the kind of a file; not all of it, as logs may be larger than any other file.
std::string beginning_of(const std::string& file) {
    std::string bytes(4096, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
    return bytes;
}

/// The stage that a file or folder is for, as a command; empty for logs and their folders, and for what is neither.
std::string command_for(const std::string& file) {
    const auto name = cli::shell_quoted(file);
    std::error_code none;
    if (std::filesystem::exists(std::filesystem::path(file) / "batch.json", none))
        return fmt::format("flightwatt report {} -o report.html", name);
    if (!std::filesystem::is_regular_file(file, none)) return "";
    switch (kind_of_text(beginning_of(file))) {
        case FileKind::mission:
            return fmt::format("flightwatt simulate {}", name);
        case FileKind::mechanical_model:
            return fmt::format("flightwatt new-mission --model {} --battery PACK.toml -o mission.toml", name);
        case FileKind::battery:
            return fmt::format("flightwatt new-mission --model MODEL.toml --battery {} -o mission.toml", name);
        case FileKind::specification:
            return fmt::format("flightwatt profile {} -o OUT", name);
        default:
            return "";
    }
}

/// Whether the first argument is a log or a folder of logs, which `answer` takes.
bool is_for_answer(const std::string& word) {
    std::error_code none;
    return std::filesystem::exists(word, none) && command_for(word).empty();
}

/// Whether the arguments are those of `answer`: a log or a folder of logs, perhaps after its options.
bool are_for_answer(const std::vector<std::string>& words) {
    return is_for_answer(words.front()) ||
           (words.front().starts_with('-') && std::any_of(words.begin() + 1, words.end(), is_for_answer));
}

/// The program without a stage.
int run_front(const std::string& word) {
    if (word == "--help" || word == "-h") {
        cli::print(
            cli::fitted("flightwatt: the energy of electric drone missions, flight and on-board computer together\n\n"
                        "usage: flightwatt LOG|FOLDER... [--capacity AH]\n"
                        "       flightwatt STAGE [arguments]\n       flightwatt help STAGE\n" +
                            start_text() + stage_list(),
                        stdout));
    } else if (word == "--list-stages") {  // for completion and man pages
        for (const auto& stage : all_stages()) cli::print(fmt::format("{}\t{}\n", stage.name, stage.summary));
    } else if (word == "--version" || word == "version") {
        cli::print(fmt::format("flightwatt {}\n", cli::version_text()));
    } else {
        if (const auto command = command_for(word); !command.empty())
            throw UsageError(fmt::format("'{}' is not a stage; for such a file: {}", word, command));
        if (std::filesystem::path(word).has_extension()) read_file(word);  // throws: there is no such file
        throw UsageError(fmt::format("there is no stage, file or folder '{}'; {}", word,
                                     meant_or(word, stage_names(), "flightwatt alone lists them")));
    }
    return cli::ok;
}

/// Keeps memory that was freed instead of returning it to the kernel and asking for it again: fits and logs allocate and
/// free the same megabytes thousands of times, and a new page costs more than what is computed on it.
void keep_memory() {
#ifdef __GLIBC__
    constexpr int megabyte = 1 << 20;
    ::mallopt(M_MMAP_THRESHOLD, 32 * megabyte);
    ::mallopt(M_TRIM_THRESHOLD, 512 * megabyte);
#endif
}

}  // namespace

int main(int argc, char** argv) {
    keep_memory();
    constexpr std::string_view prefix = "flightwatt-";
    const std::string called = argc > 0 ? std::filesystem::path(argv[0]).filename().string() : "";
    if (const auto linked = called.starts_with(prefix) ? find_stage(called.substr(prefix.size())) : std::nullopt)
        return linked->run(argc, argv);
    std::string word = argc > 1 ? argv[1] : "--help";
    if (const auto stage = find_stage(word)) return stage->run(argc - 1, argv + 1);
    if (word == "help") {
        word = argc > 2 ? argv[2] : "--help";
        if (const auto stage = find_stage(word)) return show_help(*stage);
    }
    if (argc > 1 && argv[1] != std::string_view("help") && are_for_answer({argv + 1, argv + argc}))
        return stages::answer_stage(argc, argv);
    return cli::run_guarded("flightwatt", [&] { return run_front(word); });
}
