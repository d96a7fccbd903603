#include "answer/pack_names.h"
#include "base/atomic_file.h"
#include "base/toml_reader.h"
#include "battery/battery.h"
#include "battery/battery_toml.h"
#include "compute/profile_specification.h"
#include "flight/column_map.h"
#include "flight/series_file.h"
#include "helpers/document.h"
#include "helpers/test_paths.h"
#include "mechanical/mechanical_model.h"
#include "mission/disturbance.h"
#include "mission/mission_file.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include <gtest/gtest.h>

namespace flightwatt::test {
namespace {

/// The pages that describe files, together with the examples that none of them shows.
std::vector<Document> pages() {
    const auto docs = source_dir() / "docs";
    return {read_document(docs / "missions.md"),
            read_document(docs / "formats.md"),
            {.path = {},
             .text = {},
             .keys = {},
             .examples = example_files(),
             .links = {},
             .anchors = {},
             .long_lines = {}}};
}

/// The section that describes a file, by what the examples of it are called.
const std::map<std::string, std::string> sections{
    {"mission", "Mission file"},   {"disturbance", "Disturbance file"},
    {"model", "Mechanical model"}, {"series", "Series"},
    {"battery", "Battery"},        {"specification", "Profile specification"},
    {"columns", "Column map"},     {"packs", "Packs"}};

void read_as(const std::string& kind, const std::filesystem::path& file) {
    if (kind == "mission") mission::read_mission(file, {.allow_unplanned = true, .cruise_s = {}});
    if (kind == "disturbance") mission::read_disturbances(file, flight::PerPhase<double>{{28.0, 600.0, 60.0}});
    if (kind == "model") mechanical::read_mechanical_model(file);
    if (kind == "series") flight::read_series_csv(file);
    if (kind == "columns") flight::read_column_map(file);
    if (kind == "packs") answer::read_packs_file(file);
    if (kind == "battery") battery::read_battery(file);
    if (kind == "specification") compute::read_profile_specification(file);
}

/// What kind of file a path is that was read on the way, by its folder.
std::string kind_of(const std::string& file) {
    if (file.find("/mechanical/") != std::string::npos) return "model";
    if (file.find("/fits/battery/") != std::string::npos) return "battery";
    for (const auto& [kind, section] : sections)
        if (std::filesystem::path(file).filename().string().starts_with(kind)) return kind;
    return "";
}

void write(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

/// A folder with all examples as files, KIND_NUMBER.toml, and what they name.
std::vector<std::filesystem::path> write_examples(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto* files : {"fits", "missions"})
        std::filesystem::create_directory_symlink(source_dir() / files, folder / files);
    for (const auto& page : pages()) {
        for (const auto& example : page.examples) {
            if (!sections.contains(example.kind)) continue;
            files.push_back(folder / (example.kind + "_" + std::to_string(files.size()) + ".toml"));
            write(files.back(), example.text);
        }
    }
    return files;
}

/// A mission's battery = { ... } has the keys of a battery file.
DocumentedKey as_documented(const RequestedKey& asked) {
    const std::string inline_battery = "battery";
    auto kind = kind_of(asked.file);
    auto table = asked.table;
    if (kind.empty()) kind = "mission";
    if (kind == "mission" && table.starts_with(inline_battery)) {
        kind = "battery";
        table = table.size() > inline_battery.size() ? table.substr(inline_battery.size() + 1) : "";
    }
    return {sections.at(kind), {table}, asked.key, "", "", false, 0};
}

std::string joined(const std::string& table, const std::string& key) { return table.empty() ? key : table + "." + key; }

/// Of a row `time.column` the key: "column".
std::string last_word(const std::string& key) { return key.substr(key.rfind('.') + 1); }

bool describes(const DocumentedKey& documented, const DocumentedKey& asked) {
    if (documented.section != asked.section) return false;
    const auto path = joined(asked.tables.front(), asked.key);
    if (documented.tables.empty()) return path_matches(documented.key, path);
    return std::any_of(documented.tables.begin(), documented.tables.end(),
                       [&](const auto& name) { return path_matches(joined(name, documented.key), path); });
}

std::vector<DocumentedKey> documented_keys() {
    std::vector<DocumentedKey> keys;
    for (const auto& page : pages()) {
        for (const auto& key : page.keys) {
            const bool is_toml = std::any_of(sections.begin(), sections.end(),
                                             [&](const auto& section) { return section.second == key.section; });
            if (is_toml && !key.is_column) keys.push_back(key);
        }
    }
    return keys;
}

/// Every key that the readers ask for while they read all examples and all files of the project.
std::set<RequestedKey> asked_keys(const std::filesystem::path& folder) {
    std::set<RequestedKey> asked;
    const auto examples = write_examples(folder);
    record_requested_keys(&asked);
    for (const auto& file : examples) read_as(kind_of(file.string()), file);
    for (const auto* kind : {"paper", "synthetic"}) {
        for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "missions" / kind))
            if (entry.path().extension() == ".toml") read_as("mission", entry.path());
    }
    record_requested_keys(nullptr);
    return asked;
}

TEST(TomlKeys, OfAllReadersAreDocumented) {
    const auto documented = documented_keys();
    const auto asked = asked_keys(scratch_dir());
    ASSERT_GT(asked.size(), 200U);
    for (const auto& key : asked) {
        if (key.key == "format") continue;  // of all files: docs/formats.md has it above its sections
        const auto wanted = as_documented(key);
        EXPECT_TRUE(
            std::any_of(documented.begin(), documented.end(), [&](const auto& is) { return describes(is, wanted); }))
            << wanted.section << " lacks [" << key.table << "] " << key.key << ", which is read from " << key.file;
    }
}

TEST(TomlKeys, ThatAreDocumentedAreRead) {
    const auto asked = asked_keys(scratch_dir());
    for (const auto& key : documented_keys()) {
        EXPECT_TRUE(
            std::any_of(asked.begin(), asked.end(), [&](const auto& is) { return describes(key, as_documented(is)); }))
            << "line " << key.line << ": no reader asks for " << key.key << " of " << key.section;
    }
}

TEST(TomlKeys, HaveUnitDefaultAndExample) {
    std::map<std::string, std::string> examples;
    for (const auto& page : pages()) {
        for (const auto& example : page.examples) {
            const auto section = sections.find(example.kind);
            if (section != sections.end()) examples[section->second] += example.text;
        }
    }
    for (const auto& key : documented_keys()) {
        EXPECT_FALSE(key.unit.empty() || key.fallback.empty()) << "line " << key.line << ": " << key.key;
        const auto word = last_word(key.key);
        const bool is_any_name = std::ranges::all_of(word, [](char c) { return c >= 'A' && c <= 'Z'; });
        EXPECT_TRUE(is_any_name || key.unit == "any" || examples[key.section].find(word) != std::string::npos)
            << "line " << key.line << ": no example of " << key.section << " shows " << key.key;
    }
}

/// Keys that are literals where the source asks a table for one: what runs may miss, this finds.
std::set<std::string> keys_in_source() {
    const std::regex asked(
        R"re((?:\.|->)(?:(?:optional_)?(?:number|string|boolean|real|text|flag|table)s?|counts?|choice|has)\(\s*"([a-z][a-z0-9_]*)")re");
    const std::regex through_helper(
        R"re(\b\w*(?:number|positive|count|between|weight|sd|interval|seconds|sizes|from|in|or|file_of)\w*\((?:[^()";]|\(\w*\))*\b(?:table|entry|root|plan|policy|mission|range|group)\w*,\s*"([a-z][a-z0-9_]*)")re");
    const std::regex list(R"re(refuse_keys_except\(\s*\{([^}]*)\})re");
    const std::regex literal(R"re("([a-z][a-z0-9_]*)")re");
    std::set<std::string> keys;
    const auto add = [&](const std::string& text, const std::regex& pattern) {
        for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it) keys.insert((*it)[1]);
    };
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source_dir() / "src")) {
        if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
        const auto text = read_file(entry.path());
        if (text.find("Toml") == std::string::npos || entry.path().filename() == "toml_reader.cpp") continue;
        add(text, asked);
        add(text, through_helper);
        for (std::sregex_iterator it(text.begin(), text.end(), list), end; it != end; ++it)
            add((*it)[1].str(), literal);
    }
    return keys;
}

TEST(TomlKeys, ThatTheSourceNamesAreDocumented) {
    std::set<std::string> documented{"format"};
    for (const auto& key : documented_keys()) documented.insert(last_word(key.key));
    const auto named = keys_in_source();
    ASSERT_GT(named.size(), 60U);
    for (const auto& key : named)
        EXPECT_TRUE(documented.contains(key)) << "a reader names '" << key << "', and no page describes it";
}

}  // namespace
}  // namespace flightwatt::test
