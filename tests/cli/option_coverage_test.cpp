// Every option of every program is used by a test of that program, or by a document whose output a test holds.

#include "base/atomic_file.h"
#include "helpers/golden_case.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace flightwatt::cli {
namespace {

/// What a test does: a golden case's command (its outputs hold every option, as help), the command of an output in a
/// document, or a file's text.
std::vector<std::string> texts_of_tests() {
    std::vector<std::string> texts;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(test::source_dir() / "tests")) {
        const auto& path = entry.path();
        if (path.extension() == ".case") texts.push_back(test::read_golden_case(path).command);
        if (path.extension() == ".cpp" && path.filename() != "option_coverage_test.cpp")
            texts.push_back(read_file(path));
        if (path.extension() == ".sh") texts.push_back(read_file(path));
    }
    const std::string output = "<!-- output of";
    for (const auto& entry : std::filesystem::directory_iterator(test::source_dir() / "docs")) {
        if (entry.path().extension() != ".md") continue;
        const auto text = read_file(entry.path());
        for (auto at = text.find(output); at != std::string::npos; at = text.find(output, at + 1)) {
            texts.push_back(text.substr(at, text.find('\n', at) - at));
        }
    }
    return texts;
}

bool has_word(const std::string& text, const std::string& word) {
    const auto in_word = [&](std::size_t at) {
        return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '-');
    };
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        const bool begins = word.starts_with('-') || at == 0 || !in_word(at - 1) || text[at - 1] == '-';
        if (begins && !in_word(at + word.size())) return true;
    }
    return false;
}

/// "--order" and so on: the stage's own options, "-o" and "--json".
std::set<std::string> options_of(const std::string& program) {
    const auto usage = nlohmann::json::parse(test::run_shell(program + " --json-usage", test::binary_dir()).out);
    std::set<std::string> options;
    for (const auto& option : usage.at("options")) {
        const auto name = option.at("name").get<std::string>();
        if (name == "output") options.insert("-o");
        if (option.at("group") != "Common options" || name == "json") options.insert("--" + name);
    }
    return options;
}

TEST(StageOptions, AreEachUsedByATestOfTheirProgram) {
    const auto texts = texts_of_tests();
    const std::string prefix = "flightwatt-";
    std::size_t options = 0;
    for (const auto& entry : std::filesystem::directory_iterator(test::programs_dir())) {
        const auto program = entry.path().filename().string();
        if (!program.starts_with(prefix)) continue;
        const auto stage = program.substr(prefix.size());
        for (const auto& option : options_of(program)) {
            ++options;
            EXPECT_TRUE(
                std::any_of(texts.begin(), texts.end(),
                            [&](const std::string& text) { return has_word(text, stage) && has_word(text, option); }))
                << program << " " << option << " is in no golden case, no test and no document's output";
        }
    }
    EXPECT_GT(options, 100U) << "the help was not read";
}

}  // namespace
}  // namespace flightwatt::cli
