// Runs every tests/cli/golden/NAME.cmd with sh and compares what it prints, what it says and its exit code
// with NAME.stdout, NAME.stderr (no file: nothing) and NAME.exit. FLIGHTWATT_REGENERATE=1 writes them anew.

#include "base/atomic_file.h"
#include "base/error.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>

namespace flightwatt::cli {
namespace {

std::filesystem::path golden_dir() { return test::source_dir() / "tests" / "cli" / "golden"; }

std::vector<std::string> case_names() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(golden_dir())) {
        if (entry.path().extension() == ".cmd") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

bool regenerating() {
    const char* wanted = std::getenv("FLIGHTWATT_REGENERATE");
    return wanted != nullptr && std::string(wanted) == "1";
}

struct Outcome {
    std::string out;
    std::string err;
    std::string code;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
    return text;
}

std::string quoted(const std::filesystem::path& path) {
    return "'" + replaced(path.string(), "'", "'\\''") + "'";
}

/// Runs the case in an empty folder; what it prints goes beside that folder, so that `ls` shows the case's
/// own files alone.
Outcome run_case(const std::string& name) {
    const auto scratch = test::scratch_dir();
    const auto work = scratch / "work";
    make_directories(work);
    const auto bin = test::binary_dir() / "bin";
    const auto command = "cd " + quoted(work) +
                         " && LC_ALL=C COLUMNS=80 SOURCE=" + quoted(test::source_dir()) +
                         " PATH=" + quoted(bin) + ":\"$PATH\" sh " + quoted(golden_dir() / (name + ".cmd")) +
                         " < /dev/null > ../stdout 2> ../stderr";
    const int status = std::system(command.c_str());
    const auto shown = [&](const char* file) {
        // The scratch folder may lie in the source folder, so it goes first.
        return replaced(replaced(read_file(scratch / file), work.string(), "SCRATCH"),
                        test::source_dir().string(), "SOURCE");
    };
    const auto code = WIFEXITED(status) ? std::to_string(WEXITSTATUS(status)) : "killed";
    return {shown("stdout"), shown("stderr"), code + "\n"};
}

std::filesystem::path expectation(const std::string& name, const char* ending) {
    return golden_dir() / (name + ending);
}

std::string expected(const std::string& name, const char* ending) {
    const auto path = expectation(name, ending);
    return std::filesystem::exists(path) ? read_file(path) : "";
}

void regenerate(const std::string& name, const char* ending, const std::string& text) {
    if (text.empty())
        std::filesystem::remove(expectation(name, ending));
    else
        write_file_atomically(expectation(name, ending), text);
}

class GoldenRun : public testing::TestWithParam<std::string> {};

TEST_P(GoldenRun, PrintsSaysAndReturnsWhatIsExpected) {
    const auto& name = GetParam();
    const auto outcome = run_case(name);
    if (regenerating()) {
        regenerate(name, ".stdout", outcome.out);
        regenerate(name, ".stderr", outcome.err);
        regenerate(name, ".exit", outcome.code);
        return;
    }
    EXPECT_EQ(outcome.out, expected(name, ".stdout"));
    EXPECT_EQ(outcome.err, expected(name, ".stderr"));
    EXPECT_EQ(outcome.code, expected(name, ".exit"));  // a case without it has never been generated
}

INSTANTIATE_TEST_SUITE_P(Cli, GoldenRun, testing::ValuesIn(case_names()),
                         [](const auto& run) { return run.param; });

/// Expectations of a case that was renamed would never be looked at again.
TEST(Golden, HasACommandForEveryExpectation) {
    if (regenerating()) GTEST_SKIP();
    const auto names = case_names();
    EXPECT_GT(names.size(), 100U);
    for (const auto& entry : std::filesystem::directory_iterator(golden_dir())) {
        const auto name = entry.path().stem().string();
        EXPECT_TRUE(std::binary_search(names.begin(), names.end(), name)) << entry.path();
    }
}

/// A rejected input leaves one line and nothing else: no result, no stack of messages.
TEST(Golden, RejectsBadInputsInOneLine) {
    if (regenerating()) GTEST_SKIP();
    for (const auto& name : case_names()) {
        if (!name.starts_with("bad_")) continue;
        EXPECT_EQ(expected(name, ".exit"), "3\n") << name;
        const auto said = expected(name, ".stderr");
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << name;
        EXPECT_NE(said.find(": error: "), std::string::npos) << name;
        EXPECT_EQ(said.find("internal"), std::string::npos) << name;
        const auto left = expected(name, ".stdout");
        EXPECT_EQ(left.find("result"), std::string::npos) << name;
        EXPECT_EQ(left.find("made"), std::string::npos) << name;
    }
}

}  // namespace
}  // namespace flightwatt::cli
