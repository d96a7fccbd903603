// Columns of the files that the programs write, held to docs/formats.md.

#include "base/atomic_file.h"
#include "helpers/document.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

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

/// The columns of flights.csv, as the reference of `batch` has them.
Words columns_of_flights() {
    const auto text = read_file(source_dir() / "docs" / "reference" / "batch.md");
    std::stringstream lines(text.substr(text.find("## Columns of flights.csv")));
    Words columns;
    for (std::string line; std::getline(lines, line);) columns.push_back(line.substr(0, line.find(' ')));
    return columns;
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

/// The example of a specification as a file.
void write_specification(const std::filesystem::path& file) {
    for (const auto& example : read_document(source_dir() / "docs" / "formats.md").examples) {
        if (example.kind != "specification") continue;
        auto text = std::regex_replace(example.text, std::regex("repeats = 2"), "repeats = 1");
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
    expect_columns(folder / "phases.csv", "Phases", columns_of_flights());
    output_of("batch", Words{log_file} + Words{"-o", "out"}, folder);
    expect_columns(folder / "out" / "flights" / "opterra_synthetic_01.series.csv", "Series");
    output_of("fit", logs() + Words{"--curves", "curves.csv", "-o", "model.toml"}, folder);
    expect_columns(folder / "curves.csv", "Curves");
    output_of("simulate", {phased, "--samples", "10", "--samples-csv", "samples.csv", "-o", "soc.csv"}, folder);
    expect_columns(folder / "soc.csv", "State of charge");
    expect_columns(folder / "samples.csv", "Sampled state of charge");
    output_of("path", {survey_path, "-o", "legs.csv"}, folder);
    expect_columns(folder / "legs.csv", "Legs of a path");
    output_of("profile", {"specification.toml", "-o", "profiles"}, folder);
    expect_columns(folder / "profiles" / "runs.csv", "Runs");
    expect_columns(folder / "profiles" / "idle.csv", "Power profile");
    expect_columns(folder / "profiles" / "detection.csv", "Power profile");
    output_of("synthesize", {published, "--flights", "1", "--cruise", "60", "--truth", "-o", "made"}, folder);
    expect_columns(folder / "made" / "opterra-table1_synthetic_01.truth.csv", "Truth", columns_of_flights());
}

}  // namespace
}  // namespace flightwatt::test
