// Runs the command of every tests/cli/golden/NAME.case (see helpers/golden_case.h) with sh and compares what it prints
// and its exit code. FLIGHTWATT_REGENERATE=1 rewrites the cases that differ, and reports every case as skipped. A new
// case is a file with a command alone, regenerated.

#include "base/atomic_file.h"
#include "helpers/golden_case.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

std::filesystem::path golden_dir() { return test::source_dir() / "tests" / "cli" / "golden"; }

std::filesystem::path case_file(const std::string& name) { return golden_dir() / (name + ".case"); }

std::vector<std::string> case_names() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(golden_dir())) {
        if (entry.path().extension() == ".case") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

bool regenerating() {
    const char* wanted = std::getenv("FLIGHTWATT_REGENERATE");
    return wanted != nullptr && std::string(wanted) == "1";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
    return text;
}

/// Runs the command in an empty folder.
test::Outcome run_command(const std::string& command) {
    const auto folder = test::scratch_dir();
    const auto source = test::source_dir();
    const auto result = test::run_shell(command, folder,
                                        "LC_ALL=C COLUMNS=80 SOURCE=" + test::shell_quoted(source) +
                                            " HAZARDS=" + test::shell_quoted(test::hazards_dir()));
    const auto shown = [&](const std::string& text) {
        // The scratch folder may be in the source folder, so it is first.
        return replaced(replaced(text, folder.string(), "SCRATCH"), source.string(), "SOURCE");
    };
    return {result.code < 0 ? "killed" : std::to_string(result.code), shown(result.out), shown(result.err)};
}

class GoldenRun : public testing::TestWithParam<std::string> {};

TEST_P(GoldenRun, PrintsAndReturnsWhatIsExpected) {
    auto golden = test::read_golden_case(case_file(GetParam()));
    const auto outcome = run_command(golden.command);
    const auto differing = test::differing_parts(golden, outcome);
    if (regenerating()) {
        golden.expected = outcome;
        if (!differing.empty()) write_file_atomically(case_file(GetParam()), to_text(golden));
        GTEST_SKIP() << (differing.empty() ? "unchanged: " : "written again: ") << case_file(GetParam());
    }
    const auto& expected = golden.expected;
    const auto compared = [&](const std::string& actual, const std::string& wanted) {
        return golden.exact ? actual : test::with_expected_numbers(actual, wanted);
    };
    EXPECT_EQ(outcome.exit_code, expected.exit_code);
    EXPECT_EQ(compared(outcome.stdout_text, expected.stdout_text), expected.stdout_text);
    EXPECT_EQ(compared(outcome.stderr_text, expected.stderr_text), expected.stderr_text);
    EXPECT_TRUE(differing.empty()) << "if the change is wanted, FLIGHTWATT_REGENERATE=1 writes it";
}

INSTANTIATE_TEST_SUITE_P(Cli, GoldenRun, testing::ValuesIn(case_names()), [](const auto& run) { return run.param; });

/// Another file there would never be read.
TEST(Golden, HoldsCasesAlone) {
    for (const auto& entry : std::filesystem::directory_iterator(golden_dir())) {
        EXPECT_EQ(entry.path().extension(), ".case") << entry.path();
    }
}

/// Each program has a case of its own for each of these, so that a changed option fails that one alone.
TEST(Golden, HasTheHelpOfEveryProgram) {
    const auto names = case_names();
    std::size_t programs = 0;
    for (const auto& entry : std::filesystem::directory_iterator(test::programs_dir())) {
        const auto program = entry.path().filename().string();
        if (!program.starts_with("flightwatt")) continue;
        ++programs;
        auto name = program == "flightwatt" ? "front_help" : program.substr(11) + "_help";
        std::ranges::replace(name, '-', '_');  // names of tests hold no hyphen
        EXPECT_TRUE(std::binary_search(names.begin(), names.end(), name)) << name;
    }
    EXPECT_GT(programs, 10U) << "the programs were not found";
}

/// A rejected input leaves one line and nothing else: no result, no stack of messages.
TEST(Golden, RejectsBadInputsInOneLine) {
    for (const auto& name : case_names()) {
        if (!name.starts_with("bad_")) continue;
        const auto expected = test::read_golden_case(case_file(name)).expected;
        EXPECT_EQ(expected.exit_code, "3") << name;
        const auto& printed = expected.stderr_text;
        EXPECT_EQ(std::count(printed.begin(), printed.end(), '\n'), 1) << name;
        EXPECT_NE(printed.find(": error: "), std::string::npos) << name;
        EXPECT_EQ(printed.find("internal"), std::string::npos) << name;
        EXPECT_EQ(expected.stdout_text.find("result"), std::string::npos) << name;
        EXPECT_EQ(expected.stdout_text.find("made"), std::string::npos) << name;
    }
}

}  // namespace
}  // namespace flightwatt::cli
