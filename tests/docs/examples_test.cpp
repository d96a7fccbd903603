// The examples of docs/missions.md, docs/formats.md and tests/docs/files, and the commands of README.md, run as a user would.

#include "base/atomic_file.h"
#include "helpers/document.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <fstream>
#include <regex>

#include <gtest/gtest.h>

namespace flightwatt::test {
namespace {

using Words = std::vector<std::string>;

constexpr const char* small_mission =
    "mechanical = \"MODEL\"\nbattery = \"BATTERY\"\n[components.detection]\nprofile = \"PROFILE\"\n"
    "[[schedule]]\notherwise = true\nrun = { detection = { fps = 8 } }\n";

/// A mission that names `file` in place of one of its own.
std::string mission_with(const std::string& what, const std::string& file) {
    std::string text = small_mission;
    for (const auto& [name, usual] :
         {std::pair("MODEL", "fits/mechanical/opterra-table1.toml"), std::pair("BATTERY", "fits/battery/paper.toml"),
          std::pair("PROFILE", "fits/compute/tx2-detection.csv")})
        text = std::regex_replace(text, std::regex(name), name == what ? file : usual);
    return text;
}

/// The program that reads an example, and its arguments.
struct Reading {
    std::string program;
    Words arguments;
};

Reading reading_of(const DocumentedExample& example, const std::filesystem::path& folder) {
    const auto write = [&](const char* name, const std::string& text) {
        std::ofstream(folder / name) << text;
        return std::string(name);
    };
    const auto file = write("example", example.text);
    if (example.kind == "mission") {
        const bool is_plan = example.text.find("[plan]") != std::string::npos;
        if (is_plan && example.text.find("[policy]") == std::string::npos)
            return {"flightwatt-plan", {file, "-o", "planned.toml"}};
        if (example.text.find("[uncertainty]") != std::string::npos)
            return {"flightwatt-simulate", {file, "--samples", "10", "-o", "soc.csv"}};
        return {"flightwatt-simulate", {file, "-o", "soc.csv"}};
    }
    if (example.kind == "disturbance") {
        const auto mission = write("mission", mission_with("", ""));
        return {"flightwatt-simulate", {mission, "--disturb", file, "-o", "soc.csv"}};
    }
    if (example.kind == "model")
        return {"flightwatt-simulate", {write("mission", mission_with("MODEL", file)), "-o", "soc.csv"}};
    if (example.kind == "battery")
        return {"flightwatt-simulate", {write("mission", mission_with("BATTERY", file)), "-o", "soc.csv"}};
    if (example.kind == "profile") {
        const auto profile = write("example.csv", example.text);
        return {"flightwatt-simulate", {write("mission", mission_with("PROFILE", profile)), "-o", "soc.csv"}};
    }
    if (example.kind == "specification") return {"flightwatt-profile", {file, "-o", "profiles"}};
    if (example.kind == "series") {
        const auto series = write("example.csv", example.text);
        return {"flightwatt-parse", {series, "-o", "copy.csv"}};
    }
    if (example.kind == "columns") {
        const auto csv =
            write("own.csv",
                  "Laboratory\nday 1\nt_ms,vbat_mv,ibat_ma,height_cm,vn,ve\n0,12000,500,0,0,0\n500,11900,900,10,3,4\n");
        return {"flightwatt-parse", {csv, "--columns", write("columns.toml", example.text), "-o", "copy.csv"}};
    }
    if (example.kind == "packs") {
        const auto log = source_dir() / "logs" / "opterra_synthetic_01.data";
        return {"flightwatt-trends", {log.string(), "--packs-file", file, "-o", "trends.csv"}};
    }
    return {};
}

TEST(Examples, AreReadByTheirPrograms) {
    const auto folder = scratch_dir();
    for (const auto* files : {"fits", "missions"})
        std::filesystem::create_directory_symlink(source_dir() / files, folder / files);
    std::size_t run = 0;
    for (const auto* page : {"formats.md", "missions.md", "tests/docs/files"}) {
        const bool is_page = page != std::string("tests/docs/files");
        const auto examples = is_page ? read_document(source_dir() / "docs" / page).examples : example_files();
        for (const auto& example : examples) {
            const auto reading = reading_of(example, folder);
            ASSERT_FALSE(reading.program.empty()) << page << ":" << example.line << ": '" << example.kind << "'";
            auto code = run_program(reading.program, reading.arguments, folder);
            // A busy machine may leave a run of 0.3 s without a sample: the same command runs it again.
            if (code == 4 && example.kind == "specification")
                code = run_program(reading.program, reading.arguments, folder);
            EXPECT_EQ(code, 0) << page << ":" << example.line << ": " << read_file(folder / "stderr");
            ++run;
        }
    }
    EXPECT_GE(run, 15U);
}

/// The commands of "Your own flights in five commands", with the sample logs in place of one's own.
void type_five_commands(const std::filesystem::path& flights, const std::filesystem::path& folder) {
    const auto text = read_file(source_dir() / "README.md");
    const std::string fence = "```sh\n";
    const auto start = text.find(fence, text.find("in five commands"));
    ASSERT_NE(start, std::string::npos);
    auto commands = text.substr(start + fence.size(), text.find("```", start + 1) - start - fence.size());
    commands = std::regex_replace(commands, std::regex("~/flights"), flights.string());
    commands = std::regex_replace(commands, std::regex("\\$PWD/build/release/bin"), programs_dir().string());
    if (!std::filesystem::exists(source_dir() / "web" / "node_modules" / "vega"))
        commands = std::regex_replace(commands, std::regex("flightwatt report [^\\n]*"), "");
    const auto result = run_shell("set -e\n" + commands, folder);
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    for (const auto* file : {"my/model.toml", "my/pack.toml", "my/soc.csv"})
        EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
}

/// The commands of the guide on logs of another autopilot, with the sample flights in its format.
void type_autopilot_commands(const std::string& format) {
    const auto folder = scratch_dir();
    const auto text = read_file(source_dir() / "docs" / "guide.md");
    const auto start = text.find("```sh\n", text.find("<!-- flights of other autopilots -->"));
    ASSERT_NE(start, std::string::npos);
    auto commands = text.substr(start + 6, text.find("```", start + 1) - start - 6);
    if (!std::filesystem::exists(source_dir() / "web" / "node_modules" / "vega"))
        commands = std::regex_replace(commands, std::regex("flightwatt report [^\n]*"), "");
    const auto source = source_dir().string();
    const auto prepared = "set -e\nexport PATH=" + programs_dir().string() + ":$PATH\n" +
                          "for i in 1 2 3 4; do flightwatt parse " + source +
                          "/logs/opterra_synthetic_0$i.data -o opterra_synthetic_0$i.csv; done\n" + source +
                          "/scripts/autopilot_logs " + format + " flights opterra_synthetic_0*.csv\n";
    const auto result = run_shell(prepared + std::regex_replace(commands, std::regex("\\.bin"), "." + format), folder);
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    for (const auto* file : {"flight.csv", "my/model.toml", "model.toml", "pack.toml", "soc.csv"})
        EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
    EXPECT_NE(read_file(folder / "my" / "flights.csv").find("_synthetic"), std::string::npos);
}

TEST(Examples, LogsOfArduPilotGoThroughAllStages) { type_autopilot_commands("bin"); }
TEST(Examples, LogsOfPx4GoThroughAllStages) { type_autopilot_commands("ulg"); }

TEST(Examples, TheFiveCommandsOfTheReadmeRun) { type_five_commands(source_dir() / "logs", scratch_dir()); }

TEST(ExamplesStudy, TheFiveCommandsOfTheReadmeRunOnRealFlights) {
    const auto shared = source_dir() / ".." / "shared" / "flights";
    if (!std::filesystem::exists(shared)) GTEST_SKIP() << "no " << shared;
    const auto folder = scratch_dir();
    std::filesystem::create_directories(folder / "flights");
    std::size_t logs = 0;
    for (const auto& entry : std::filesystem::directory_iterator(shared)) {
        const auto name = entry.path().filename().string();
        const bool is_log = name.ends_with(".data") || name.ends_with(".log");
        if (!name.starts_with("20_07_") || !is_log) continue;
        std::filesystem::create_symlink(std::filesystem::canonical(entry.path()), folder / "flights" / name);
        ++logs;
    }
    ASSERT_GT(logs, 2U);
    type_five_commands(folder / "flights", folder);
}

}  // namespace
}  // namespace flightwatt::test
