// Standard streams that are closed, full or left by their reader, for every program as a user runs it.

#include "base/atomic_file.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

enum class State { good, closed, full, left };

/// Puts a stream of this process into that state.
void put(int stream, State state, const std::filesystem::path& file) {
    if (state == State::closed) {
        ::close(stream);
        return;
    }
    int ends[2] = {-1, -1};
    if (state == State::left) {
        if (::pipe(ends) != 0) ::_exit(97);
        ::close(ends[0]);
    } else {
        ends[1] = ::open(state == State::full ? "/dev/full" : file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    }
    if (ends[1] != stream) {
        ::dup2(ends[1], stream);
        ::close(ends[1]);
    }
}

class Streams : public testing::Test {
  protected:
    std::filesystem::path folder = test::scratch_dir();
    std::string log = (test::source_dir() / "logs" / "opterra_synthetic_01.data").string();

    /// The status of waitpid().
    int run(const std::vector<std::string>& words, State out, State err, bool without_input = false) const {
        const auto child = ::fork();
        if (child == 0) {
            if (::chdir(folder.c_str()) != 0) ::_exit(98);
            put(STDOUT_FILENO, out, folder / "stdout");
            put(STDERR_FILENO, err, folder / "stderr");
            if (without_input) ::close(STDIN_FILENO);
            auto arguments = words;
            std::vector<char*> pointers;
            for (auto& word : arguments) pointers.push_back(word.data());
            pointers.push_back(nullptr);
            ::execv((test::programs_dir() / words.front()).c_str(), pointers.data());
            ::_exit(99);
        }
        return test::wait_status_of(child);
    }
    std::string printed(const char* stream) const { return read_file(folder / stream); }

    static std::vector<std::string> programs() {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(test::programs_dir())) {
            names.push_back(entry.path().filename().string());
        }
        EXPECT_GE(names.size(), 14U);
        return names;
    }
};

/// Every program died of SIGABRT.
TEST_F(Streams, StandardErrorChangesNothing) {
    std::vector<std::vector<std::string>> commands{
        {"flightwatt-parse", "missing.data"},     {"flightwatt-parse", log, "-o", "series.csv"},
        {"flightwatt-segment", log, "--explain"}, {"flightwatt-batch", log, "-o", "out"},
        {"flightwatt", "parse", "missing.data"},  {"flightwatt", "pasre"},
    };
    for (const auto& program : programs()) commands.push_back({program, "--elephant"});
    for (const auto& command : commands) {
        const auto words = command.front() + " " + command.at(1);
        const int as_usual = run(command, State::good, State::good);
        const auto out = printed("stdout");
        ASSERT_TRUE(WIFEXITED(as_usual)) << words;
        for (const auto state : {State::closed, State::full, State::left}) {
            EXPECT_EQ(run(command, State::good, state), as_usual) << words;
            EXPECT_EQ(printed("stdout"), out) << words;
        }
    }
}

bool ended_by_broken_pipe(int status) { return WIFSIGNALED(status) && WTERMSIG(status) == SIGPIPE; }

TEST_F(Streams, AReaderWhoLeavesEndsAProgramQuietly) {
    std::vector<std::vector<std::string>> commands{
        {"flightwatt-parse", log}, {"flightwatt-segment", log, "--json"}, {"flightwatt", "parse", log}, {"flightwatt"}};
    for (const auto& program : programs()) commands.push_back({program, "--help"});
    for (const auto& command : commands) {
        EXPECT_TRUE(ended_by_broken_pipe(run(command, State::left, State::good))) << command.front();
        EXPECT_THAT(printed("stderr"), Not(HasSubstr("error"))) << command.front();
    }
}

TEST_F(Streams, AReaderWhoLeavesTakesNoFilesAway) {
    ASSERT_EQ(run({"flightwatt-parse", log, "--json", "-o", "whole.csv"}, State::good, State::good), 0);
    EXPECT_TRUE(
        ended_by_broken_pipe(run({"flightwatt-parse", log, "--json", "-o", "series.csv"}, State::left, State::good)));
    EXPECT_EQ(printed("series.csv"), printed("whole.csv"));
    EXPECT_TRUE(ended_by_broken_pipe(run({"flightwatt-batch", log, "-o", "out"}, State::left, State::good)));
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / "model.toml"));
}

TEST_F(Streams, AClosedStandardOutputIsAnErrorWhereAResultGoesThere) {
    const int status = run({"flightwatt-parse", log}, State::closed, State::good);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 1);
    EXPECT_THAT(printed("stderr"), HasSubstr("cannot write the standard output: Bad file descriptor"));
    EXPECT_EQ(run({"flightwatt-parse", log, "-o", "series.csv"}, State::closed, State::good), 0);
}

/// The first file that a program opens would otherwise get the number of the closed stream, and what it prints.
TEST_F(Streams, ThatAreClosedAreNoFilesOfOurs) {
    ASSERT_EQ(run({"flightwatt-parse", log, "-o", "whole.csv"}, State::good, State::good), 0);
    EXPECT_EQ(run({"flightwatt-parse", log, "-o", "series.csv"}, State::closed, State::closed, true), 0);
    EXPECT_EQ(printed("series.csv"), printed("whole.csv"));
    EXPECT_EQ(run({"flightwatt-batch", log, "-o", "out", "--json"}, State::good, State::closed, true), 0);
    EXPECT_EQ(printed("out/flights/opterra_synthetic_01.series.csv"), printed("whole.csv"));
}

}  // namespace
}  // namespace flightwatt::cli
