// No program changes a file that it reads, with any of its outputs, by whatever name: every program, every file that it
// can name, every option that writes.

#include "base/atomic_file.h"
#include "helpers/binary_frames.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using Words = std::vector<std::string>;

/// A command, with the files that it reads and the names that its outputs go to. OUT represents the output.
struct Command {
    std::string stage;
    std::string arguments;  ///< with all files that the stage can name
    Words inputs;
    std::string option;  ///< "--output" ...
    Words names = {};    ///< in a folder OUT; empty: OUT is the file itself
};

const Words mission_files{"missions/paper/phased.toml", "fits/mechanical/opterra-table1.toml",
                          "fits/battery/paper.toml", "fits/compute/tx2-detection.csv",
                          "fits/compute/tx2-encryption.csv"};

Words operator+(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

const Words flight_files{"a.data", "a.log", "s.series.csv"};
const Words flight_names{"flights.csv",
                         "model.toml",
                         "model_errors.toml",
                         "fit.json",
                         "table1.txt",
                         "table1.csv",
                         "table1.md",
                         "batch.json",
                         "flights/a.series.csv",
                         "flights/a.phases.csv",
                         "flights/a.record.json"};

std::vector<Command> commands() {
    const std::string mission = "missions/paper/phased.toml";
    const std::string model = "fits/mechanical/opterra-table1.toml";
    const Words disturbed = mission_files + Words{"missions/disturbances/headwind.toml"};
    const std::string simulate = mission + " --disturb missions/disturbances/headwind.toml";
    std::vector<Command> all{
        {"parse", "a.data", {"a.data", "a.log"}, "--output"},
        {"parse", "s.series.csv", {"s.series.csv"}, "--output"},
        {"segment", "a.data", {"a.data", "a.log"}, "--output"},
        {"play", "a.data --to udp:127.0.0.1:4 --speed 100000 --messages a.log", {"a.data", "a.log"}, "--output"},
        {"convert", "card.LOG", {"card.LOG", "card.log"}, "--output"},
        {"convert", "bare.tlm --messages a.log", {"bare.tlm", "a.log"}, "--output"},
        {"validate", "a.data s.series.csv", flight_files, "--output"},
        {"trends", "a.data s.series.csv", flight_files, "--output"},
        {"battery", "a.data s.series.csv", flight_files, "--output"},
        {"predict",
         "a.data --model spread.toml --at 300 --remaining 100 --battery fits/battery/synthetic-3s.toml",
         {"a.data", "a.log", "spread.toml", "fits/battery/synthetic-3s.toml"},
         "--output"},
        {"predict",
         "a.data --mission missions/synthetic/survey-path.toml --at 300",
         {"a.data", "a.log", "missions/synthetic/survey-path.toml", "fits/mechanical/synthetic-wing.toml"},
         "--output"},
        {"watch",
         "--follow a.data --until-landed --model spread.toml --remaining 100 --battery fits/battery/synthetic-3s.toml",
         {"a.data", "a.log", "spread.toml", "fits/battery/synthetic-3s.toml"},
         "--output"},
        {"watch",
         "- --log a.log --mission missions/paper/phased.toml",
         {"a.log", "missions/paper/phased.toml", "fits/mechanical/opterra-table1.toml"},
         "--record"},
        {"batch", "a.data s.series.csv --published " + model, flight_files + Words{model}, "--output", flight_names},
        {"answer",
         "a.data s.series.csv --capacity 3.2 --no-page",
         flight_files,
         "--output",
         {"flights.csv", "answer-pack.toml", "answer-mission.toml"}},
        {"answer", "a.data s.series.csv --capacity 3.2 --no-page -o answered", flight_files, "--table"},
        {"trends", "dated/26_0*.data", {"dated/26_01_05__10_00_00.data"}, "--ledger"},
        {"merge",
         "batch",
         {"batch/batch.json", "batch/flights/a.record.json", "batch/flights/a.series.csv", "a.data"},
         "--output",
         {"flights.csv", "flights/a.series.csv"}},
        {"batch", "--no-fit --files-from list.txt", {"a.data", "a.log", "list.txt"}, "--output", {"flights.csv"}},
        {"batch",
         "folder --published " + model,
         {"folder/b.data", "folder/b.log", "folder/odd/not-fitted.txt", model},
         "--output",
         {"flights.csv", "model.toml", "fit.json"}},
        {"profile",
         "spec.toml",
         {"spec.toml", "rec/part-5.csv", "rec/part-10.csv", "rec/idle.csv"},
         "--output",
         {"runs.csv", "idle.csv", "part.csv", "layer1/part/fps=5_repeat_1.csv"}},
        {"profile",
         "--check-interpolation fits/compute/tx2-detection.csv",
         {"fits/compute/tx2-detection.csv"},
         "--output"},
        {"plan",
         "missions/paper/plan.toml",
         {"missions/paper/plan.toml", "fits/mechanical/opterra-table1.toml", "fits/battery/paper.toml",
          "fits/compute/tx2-detection.csv"},
         "--output"},
        {"path", "--path-from a.data", {"a.data", "a.log"}, "--output"},
        {"check",
         "missions/synthetic/field.geojson --model fits/mechanical/synthetic-wing.toml --battery "
         "fits/battery/synthetic-3s.toml",
         {"missions/synthetic/field.geojson", "fits/mechanical/synthetic-wing.toml", "fits/battery/synthetic-3s.toml"},
         "--output"},
        {"path",
         "missions/synthetic/survey-path.toml",
         {"missions/synthetic/survey-path.toml", "fits/mechanical/synthetic-wing.toml",
          "fits/battery/synthetic-3s.toml", "fits/compute/tx2-detection.csv"},
         "--output"},
        {"new-mission",
         "--model " + model + " --battery fits/battery/paper.toml --profile fits/compute/tx2-detection.csv",
         {model, "fits/battery/paper.toml", "fits/compute/tx2-detection.csv"},
         "--output"},
        {"new-mission",
         "--model fits/mechanical/synthetic-wing.toml --battery fits/battery/paper.toml --plan "
         "missions/synthetic/field.geojson --force",
         {"fits/mechanical/synthetic-wing.toml", "fits/battery/paper.toml", "missions/synthetic/field.geojson"},
         "--output"},
        {"export", "a.data --format gpx", {"a.data", "a.log"}, "--output"},
        {"export", "s.series.csv --format csv", {"s.series.csv"}, "--output"},
        {"export", mission + " missions/paper/plan.toml --format latex", mission_files, "--output"},
        {"export",
         "fits/mechanical/synthetic-wing.toml fits/battery/synthetic-3s.toml --format paparazzi",
         {"fits/mechanical/synthetic-wing.toml", "fits/battery/synthetic-3s.toml"},
         "--output"},
        {"init", "home", {}, "--output"},  // it reads nothing
        {"compare", simulate, disturbed, "--output"},
        {"diff", model + " " + model, {model}, "--output"},
        {"replay", "a.data s.series.csv --model " + model + " --mission " + mission, flight_files + mission_files,
         "--output"},
        {"synthesize",
         model + " --truth --flights 1 --cruise 60 --name x",
         {model},
         "--output",
         {"x_01.log", "x_01.data", "x_01.truth.csv"}},
        {"report", "batch " + mission + " --published " + model,
         mission_files + Words{"batch/flights/a.series.csv", "batch/flights/a.record.json", "batch/model.toml",
                               "batch/flights.csv", "batch/table1.md", "batch/batch.json"},
         "--output"},
        {"trends",
         "dated/26_0*.data",
         {"dated/26_01_05__10_00_00.data"},
         "--figures",
         {"trends-1.vl.json", "trends-1.svg"}},
        {"report", mission + " --json", mission_files, "--figures", {"schedules-soc.vl.json", "schedules-soc.svg"}},
    };
    for (const auto* option : {"--output", "--table", "--curves", "--constants"}) {
        all.push_back({"fit", "a.data s.series.csv --published " + model, flight_files + Words{model}, option});
    }
    for (const auto* option : {"--output", "--schedule-out", "--samples-csv"}) {
        all.push_back({"simulate", simulate + " --samples 10", disturbed, option});
    }
    return all;
}

void put(const std::filesystem::path& from, const std::filesystem::path& to) {
    std::filesystem::create_directories(to.parent_path());
    std::filesystem::copy_file(from, to, std::filesystem::copy_options::overwrite_existing);
}

/// Everything that the commands name.
void make_inputs(const std::filesystem::path& folder) {
    const auto source = test::source_dir();
    for (const auto* name : {"fits", "missions"}) {
        std::filesystem::copy(source / name, folder / name, std::filesystem::copy_options::recursive);
    }
    for (const auto* ending : {".data", ".log"}) {
        put(source / "logs" / (std::string("opterra_synthetic_01") + ending), folder / (std::string("a") + ending));
        put(source / "logs" / (std::string("opterra_synthetic_02") + ending), folder / (std::string("s") + ending));
        put(source / "logs" / (std::string("opterra_synthetic_03") + ending),
            folder / "folder" / (std::string("b") + ending));
        put(source / "logs" / (std::string("opterra_synthetic_04") + ending),
            folder / "folder" / "odd" / (std::string("c") + ending));
    }
    for (const char flight :
         {'1', '2', '3', '4', '5'}) {  // on dates of their own, which the clock of their .log is not
        const auto from = source / "logs" / (std::string("opterra_synthetic_0") + flight);
        const auto to = folder / "dated" / (std::string("26_0") + flight + "_05__10_00_00");
        put(from.string() + ".data", to.string() + ".data");
        write_file_atomically(to.string() + ".log", std::regex_replace(read_file(from.string() + ".log"),
                                                                       std::regex("time_of_day=\"[^\"]*\""), ""));
    }
    const auto card = test::card_log(read_file(folder / "a.data"), telemetry::read_message_dictionary(folder / "a.log"),
                                     test::LinkVersion::v2);
    for (const auto* name : {"card.LOG", "bare.tlm"}) write_file_atomically(folder / name, card);
    put(folder / "a.log", folder / "card.log");
    write_file_atomically(folder / "folder" / "odd" / "not-fitted.txt", "odd\n");
    std::filesystem::create_directories(folder / "rec");
    for (const auto* name : {"part-5", "part-10", "idle"}) {
        write_file_atomically(folder / "rec" / (std::string(name) + ".csv"), "time_s,power_w\n0,2\n1,2\n2,2\n");
    }
    write_file_atomically(
        folder / "spec.toml",
        "[sampler]\nkind = \"recorded\"\nfile = \"rec/part-{fps}.csv\"\nidle_file = \"rec/idle.csv\"\n"
        "[components.part]\nqos = { fps = [5, 10] }\n");
    const auto made = test::run_shell(
        "flightwatt parse s.data -o s.series.csv && echo a.data > list.txt && flightwatt fit a.data s.data -o spread.toml && "
        "flightwatt batch a.data -o batch",
        folder);
    ASSERT_EQ(made.code, 0) << made.err;
}

/// How an output can come to be an input.
enum class Alias { plain, relative, symlink, hardlink };

/// Puts a link to the input where the output goes.
void make_alias(Alias alias, const std::filesystem::path& input, const std::filesystem::path& output) {
    std::filesystem::create_directories(output.parent_path());
    if (alias == Alias::hardlink) {
        std::filesystem::create_hard_link(input, output);
    } else {
        std::filesystem::create_symlink(input, output);
    }
}

/// The metavariables of the help that name no file.
const std::set<std::string> no_files{"AIRCRAFT",
                                     "N",
                                     "S",
                                     "X",
                                     "P",
                                     "M",
                                     "W",
                                     "A",
                                     "AH",
                                     "MB",
                                     "HOW",
                                     "NAME",
                                     "TITLE",
                                     "FONT",
                                     "HEIGHT",
                                     "ID",
                                     "FLIGHT",
                                     "A,B",
                                     "KIND",
                                     "A,B,power_w",
                                     "FLIGHT[:PHASE]=W",
                                     "NAME[,NAME]",
                                     "S|now",
                                     "M_PER_S",
                                     "PERCENT",
                                     "COMMAND",
                                     "PORT",
                                     "ADDRESS:PORT",
                                     "DEVICE:BAUD",
                                     "DATE",
                                     "PATTERN",
                                     "TARGET",
                                     "WIDTH",
                                     "DEG",
                                     "SPEED@DEG",
                                     "TIME",
                                     "KG",
                                     "LINK",
                                     "C",
                                     "SYSTEM:COMPONENT",
                                     "LAT,LON"};

/// Options that name files to read; those that write have a command above.
const std::set<std::string> reading{"--published",  "--model",   "--mission", "--disturb",  "--battery",
                                    "--path-from",  "--follow",  "--log",     "--messages", "--profile",
                                    "--files-from", "--outline", "--columns", "--plan",     "--packs-file",
                                    "--from",       "--terrain"};

class InputsKept : public testing::Test {
  protected:
    std::filesystem::path folder = test::scratch_dir() / "all";

    void SetUp() override {
        std::filesystem::create_directories(folder);
        make_inputs(folder);
    }

    std::string run(const Command& command, const std::string& output) {
        const auto words = "flightwatt " + command.stage + " " + command.arguments + " " + command.option + " " +
                           test::shell_quoted(output);
        const auto result = test::run_shell(words, folder);
        return fmt::format("{} of {}: {}", result.code, words, result.err);
    }

    void expect_kept(const Command& command, const std::string& input, const std::string& output) {
        const auto before = read_file(folder / input);
        const auto outcome = run(command, output);
        const bool cannot_draw = outcome.find("node_modules") != std::string::npos;  // and writes nothing either
        EXPECT_TRUE(outcome.starts_with("2 of") || cannot_draw) << outcome;
        EXPECT_EQ(read_file(folder / input), before) << outcome;
        if (read_file(folder / input) != before) write_file_atomically(folder / input, before);
    }

    /// An output that is the input itself, by one of its names.
    void expect_kept_by(const Command& command, const std::string& input, Alias alias) {
        const std::string ending = command.option == "--table" ? ".csv" : "";
        if (!ending.empty() && !input.ends_with(ending) && alias < Alias::symlink) return;
        std::string output = input;
        if (alias == Alias::relative) output = "missions/../" + input;
        if (alias >= Alias::symlink) {
            output = "link" + ending;
            make_alias(alias, folder / input, folder / output);
        }
        expect_kept(command, input, output);
        if (alias >= Alias::symlink) std::filesystem::remove(folder / output);
    }

    /// A folder of outputs, one of which is a link to the input.
    void expect_kept_in_folder(const Command& command, const std::string& input, const std::string& name, Alias alias) {
        make_alias(alias, folder / input, folder / "made" / name);
        if (name == "batch.json") {
            const auto before = read_file(folder / input);
            EXPECT_FALSE(run(command, "made").starts_with("0 "));
            EXPECT_EQ(read_file(folder / input), before);
        } else {
            expect_kept(command, input, "made");
        }
        std::filesystem::remove_all(folder / "made");
    }

    /// Every program, input, output and alias; of their combinations one in `step`.
    void expect_kept_by_one_in(std::size_t step) {
        std::size_t count = 0;
        const auto is_tried = [&] { return count++ % step == 0; };
        for (const auto& command : commands()) {
            for (const auto& input : command.inputs) {
                for (const auto alias : {Alias::plain, Alias::relative, Alias::symlink, Alias::hardlink})
                    if (command.names.empty() && is_tried()) expect_kept_by(command, input, alias);
                for (const auto& name : command.names)
                    for (const auto alias : {Alias::symlink, Alias::hardlink})
                        if (is_tried()) expect_kept_in_folder(command, input, name, alias);
            }
        }
    }
};

class InputsKeptStudy : public InputsKept {};

TEST_F(InputsKept, ByEveryProgram) { expect_kept_by_one_in(5); }

TEST_F(InputsKeptStudy, ByEveryProgramEveryOutputAndEveryName) { expect_kept_by_one_in(1); }

TEST_F(InputsKept, WhereAPageWouldReplaceALogOfItsBatch) {
    test::run_shell("flightwatt batch a.data -o batch", folder);
    for (const auto* log : {"a.data", "a.log"}) {
        const auto before = read_file(folder / log);
        EXPECT_NE(test::run_shell(std::string("flightwatt report batch -o ") + log, folder).code, 0) << log;
        EXPECT_EQ(read_file(folder / log), before) << log;
    }
}

TEST_F(InputsKept, WhereTwoResultsAreToGoToOneFile) {
    for (const auto* words : {"fit a.data -o x.csv --table x.csv", "fit a.data --curves ./x.csv --table x.csv",
                              "simulate missions/paper/phased.toml -o x.csv --schedule-out x.csv",
                              "report missions/paper/phased.toml -o x --figures x"}) {
        const auto result = test::run_shell(std::string("flightwatt ") + words, folder);
        EXPECT_EQ(result.code, 2) << words << result.err;
        EXPECT_NE(result.err.find("one file"), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "x.csv")) << words;
    }
}

TEST(InputsKeptCoverage, KnowsEveryOptionThatNamesAFile) {
    std::map<std::string, std::set<std::string>> writing;
    for (const auto& command : commands()) writing[command.stage].insert(command.option);
    const std::regex line("\n +(?:-[a-z] \\[ )?(--[a-z][a-z-]*)(?: \\])?(?: ([^ \n]+))?");
    std::size_t options = 0;
    for (const auto& entry : std::filesystem::directory_iterator(test::programs_dir())) {
        const auto program = entry.path().filename().string();
        if (!program.starts_with("flightwatt-")) continue;
        const auto stage = program.substr(std::string("flightwatt-").size());
        const auto help = test::run_shell(program + " --help", test::binary_dir()).out;
        for (std::sregex_iterator at(help.begin(), help.end(), line), end; at != end; ++at) {
            const std::string option = (*at)[1];
            const std::string value = (*at)[2];
            // What stands after an option without a value is its description, in small letters.
            if (value.empty() || std::islower(static_cast<unsigned char>(value.front())) != 0) continue;
            if (value == "JSON" || value == "Table" || no_files.contains(value)) continue;
            ++options;
            EXPECT_TRUE(reading.contains(option) || writing[stage].contains(option))
                << program << " " << option << " " << value << ": add a command that would write over its inputs";
        }
        EXPECT_TRUE(writing[stage].contains("--output")) << program;
    }
    EXPECT_GT(options, 20U) << "the help was not read";
}

}  // namespace
}  // namespace flightwatt::cli
