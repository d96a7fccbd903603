// Columns and keys of the files that the programs write, held to docs/formats.md.

#include "base/atomic_file.h"
#include "helpers/document.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace flightwatt::test {
namespace {

using Words = std::vector<std::string>;

const std::vector<DocumentedKey>& formats() {
    static const auto keys = read_document(source_dir() / "docs" / "formats.md").keys;
    return keys;
}

std::string path_of(const char* below_source) { return (source_dir() / below_source).string(); }

const std::string log_file = path_of("logs/opterra_synthetic_01.data");
const std::string published = path_of("fits/mechanical/opterra-table1.toml");
const std::string phased = path_of("missions/paper/phased.toml");
const std::string survey_path = path_of("missions/synthetic/survey-path.toml");

/// All sample logs.
Words logs() {
    Words names;
    for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "logs"))
        if (entry.path().extension() == ".data") names.push_back(entry.path().string());
    std::sort(names.begin(), names.end());
    return names;
}

Words operator+(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// Runs a stage in `folder`; what it printed.
std::string output_of(const std::string& stage, const Words& arguments, const std::filesystem::path& folder) {
    EXPECT_EQ(run_program("flightwatt-" + stage, arguments, folder), 0)
        << stage << ": " << read_file(folder / "stderr");
    return read_file(folder / "stdout");
}

void expect_columns(const std::filesystem::path& file, const std::string& section, const Words& also = {}) {
    std::stringstream lines(read_file(file));
    std::string header;
    while (std::getline(lines, header) && header.starts_with("#")) continue;
    std::stringstream cells(header);
    std::size_t count = 0;
    for (std::string column; std::getline(cells, column, ','); ++count) {
        column = std::regex_replace(column, std::regex("\\.[0-9]+$"), "");  // another candidate of the name
        const bool documented = std::any_of(formats().begin(), formats().end(), [&](const DocumentedKey& key) {
            return key.section == section && (key.key == column || path_matches(key.key, column));
        });
        EXPECT_TRUE(documented || std::find(also.begin(), also.end(), column) != also.end())
            << file.filename() << ": '" << column << "' is not in docs/formats.md, " << section;
    }
    EXPECT_GT(count, 1U) << file;
}

/// The example of a specification as a file, with times in which a busy machine has samples, too.
void write_specification(const std::filesystem::path& file) {
    for (const auto& example : read_document(source_dir() / "docs" / "formats.md").examples) {
        if (example.kind != "specification") continue;
        auto text = std::regex_replace(example.text, std::regex("(duration|idle)_s = 0\\.3"), "$1_s = 1");
        text = std::regex_replace(text, std::regex("repeats = 2"), "repeats = 1");
        text = std::regex_replace(text, std::regex("from = 1, to = 4"), "from = 61, to = 64");  // seconds of a sleep
        std::ofstream(file) << text;
    }
}

TEST(WrittenColumns, AreDocumented) {
    const auto folder = scratch_dir();
    write_specification(folder / "specification.toml");
    output_of("parse", {log_file, "-o", "series.csv"}, folder);
    expect_columns(folder / "series.csv", "Series");
    output_of("segment", {log_file, "-o", "phases.csv"}, folder);
    expect_columns(folder / "phases.csv", "Phases");
    output_of("batch", Words{log_file} + Words{"-o", "out"}, folder);
    expect_columns(folder / "out" / "flights.csv", "Catalogue");
    expect_columns(folder / "out" / "flights" / "opterra_synthetic_01.series.csv", "Series");
    output_of("fit", logs() + Words{"--curves", "curves.csv", "-o", "model.toml"}, folder);
    expect_columns(folder / "curves.csv", "Curves");
    output_of("simulate", {phased, "--samples", "10", "--samples-csv", "samples.csv", "-o", "soc.csv"}, folder);
    expect_columns(folder / "soc.csv", "State of charge");
    expect_columns(folder / "samples.csv", "Sampled state of charge");
    output_of("replay", logs() + Words{"--order", "1", "--mission", phased, "-o", "replay.csv"}, folder);
    expect_columns(folder / "replay.csv", "Replayed schedules");
    output_of("path", {survey_path, "-o", "legs.csv"}, folder);
    expect_columns(folder / "legs.csv", "Legs of a path");
    output_of("compare", {phased, "-o", "ranking.csv"}, folder);
    expect_columns(folder / "ranking.csv", "Ranking");
    output_of("profile", {"specification.toml", "-o", "profiles"}, folder);
    expect_columns(folder / "profiles" / "runs.csv", "Runs");
    expect_columns(folder / "profiles" / "idle.csv", "Power profile");
    expect_columns(folder / "profiles" / "detection.csv", "Power profile");
    output_of("synthesize", {published, "--flights", "1", "--cruise", "60", "--truth", "-o", "made"}, folder);
    expect_columns(folder / "made" / "opterra_synthetic_01.truth.csv", "Truth");
}

/// Calls `found` for each value of a JSON text, with its path: "phases.takeoff.cos_w[]".
void visit(const nlohmann::json& json, const std::string& path, const std::function<void(const std::string&)>& found) {
    if (json.is_object()) {
        for (const auto& [key, value] : json.items()) visit(value, path.empty() ? key : path + "." + key, found);
    } else if (json.is_array()) {
        for (const auto& value : json) visit(value, path, found);
    } else {
        found(path);
    }
}

/// The last word of a row that stands for the keys of a file: "phases.PHASE.KEY".
bool ends_in_key(const std::string& documented) {
    return documented.ends_with("KEY") || documented.ends_with("COLUMN") || documented.ends_with("KEY.low") ||
           documented.ends_with("KEY.high");
}

bool is_key_of_a_file(const std::string& path, const std::string& documented) {
    std::set<std::string> words;
    std::stringstream stream(path);
    std::string last;
    for (std::string word; std::getline(stream, word, '.');) {
        if (word != "low" && word != "high") last = word;
    }
    if (!ends_in_key(documented)) return true;
    return std::any_of(formats().begin(), formats().end(),
                       [&](const DocumentedKey& key) { return key.section != "JSON summaries" && key.key == last; });
}

void expect_keys(const std::string& json, const std::string& stage, const std::string& section) {
    std::set<std::string> paths;
    visit(nlohmann::json::parse(json), "", [&](const std::string& path) { paths.insert(path); });
    EXPECT_GT(paths.size(), 1U) << stage;
    for (const auto& path : paths) {
        const bool documented = std::any_of(formats().begin(), formats().end(), [&](const DocumentedKey& key) {
            const bool here =
                key.section == section &&
                (stage.empty() || std::find(key.tables.begin(), key.tables.end(), stage) != key.tables.end());
            return here && path_matches(key.key, path) && is_key_of_a_file(path, key.key);
        });
        EXPECT_TRUE(documented) << stage << ": '" << path << "' is not in docs/formats.md, " << section;
    }
}

void expect_summary(const std::string& stage, const Words& arguments, const std::filesystem::path& folder) {
    expect_keys(output_of(stage, arguments + Words{"--json"}, folder), stage, "JSON summaries");
}

TEST(WrittenKeys, OfFlightsAreDocumented) {
    const auto folder = scratch_dir();
    expect_summary("parse", {log_file, "-o", "series.csv"}, folder);
    expect_summary("segment", {log_file, "--explain", "-o", "phases.csv"}, folder);
    expect_summary("batch", {log_file, "-o", "out"}, folder);
    expect_keys(read_file(folder / "out" / "flights" / "opterra_synthetic_01.record.json"), "", "Record");
    expect_keys(read_file(folder / "out" / "fit.json"), "", "Fit of a batch");
    expect_keys(read_file(folder / "out" / "batch.json"), "", "Manifest");
    expect_summary("validate", logs(), folder);
    expect_summary("validate", logs() + Words{"--at", "300"}, folder);
    expect_summary("battery", logs() + Words{"-o", "pack.toml"}, folder);
    expect_summary("export", {log_file, "-o", "track.kml"}, folder);
    expect_summary("export", {log_file, "-o", "columns.csv"}, folder);
    expect_summary("synthesize", {published, "--flights", "1", "--cruise", "60", "-o", "made"}, folder);
}

TEST(WrittenKeys, OfProfilesAreDocumented) {
    const auto folder = scratch_dir();
    write_specification(folder / "specification.toml");
    expect_summary("profile", {"specification.toml", "-o", "profiles"}, folder);
    expect_summary("profile", {"--check-interpolation", path_of("fits/compute/tx2-detection.csv")}, folder);
}

TEST(WrittenKeys, OfModelsAreDocumented) {
    const auto folder = scratch_dir();
    expect_summary("fit", logs() + Words{"--errors", "-o", "model.toml"}, folder);
    expect_summary("predict", {log_file, "--model", "model.toml", "--at", "300", "--remaining", "300"}, folder);
}

TEST(WrittenKeys, OfAWatchAreDocumented) {
    const auto folder = scratch_dir();
    const auto said = run_shell("head -n 4000 " + shell_quoted(log_file) + " | flightwatt watch - --json --replan" +
                                    " --mission " + shell_quoted(survey_path),
                                folder);
    EXPECT_EQ(said.code, 0) << said.err;
    std::stringstream lines(said.out);
    std::size_t count = 0;
    for (std::string line; std::getline(lines, line); ++count)
        if (count % 50 == 49 || line.starts_with("{\"ended\"")) expect_keys(line, "watch", "JSON summaries");
    EXPECT_GT(count, 100U);
}

TEST(WrittenKeys, OfMissionsAreDocumented) {
    const auto folder = scratch_dir();
    expect_summary("simulate", {phased, "--samples", "10", "-o", "soc.csv"}, folder);
    expect_summary("compare", {phased, path_of("missions/paper/adaptive-replanned.toml")}, folder);
    expect_summary("init", {"home"}, folder);
    expect_summary("new-mission", {"--model", published, "--battery", path_of("fits/battery/paper.toml")}, folder);
    expect_summary("plan", {path_of("missions/paper/plan.toml"), "-o", "planned.toml"}, folder);
    expect_summary("plan", {phased, "--longest-cruise"}, folder);
    expect_summary("plan", {phased, "--largest-payload"}, folder);
    expect_summary("plan", {survey_path, "--longest-cruise"}, folder);
    expect_summary("path", {survey_path, "-o", "legs.csv"}, folder);
    expect_summary("replay",
                   {log_file, "--model", published, "--mission", path_of("missions/paper/adaptive-replanned.toml")},
                   folder);
}

TEST(WrittenKeys, OfAReportAreDocumented) {
    if (!std::filesystem::exists(source_dir() / "web" / "node_modules" / "vega"))
        GTEST_SKIP() << "web/node_modules is not here";
    expect_summary("report", {phased, "-o", "report.html"}, scratch_dir());
}

}  // namespace
}  // namespace flightwatt::test
