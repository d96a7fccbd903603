// flightwatt watch as it runs next to a flight: a log that grows, signals, a reader that leaves.

#include "base/atomic_file.h"
#include "helpers/running_program.h"
#include "helpers/sample_logs.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

std::string printed(const std::filesystem::path& folder) {
    const auto file = folder / "stdout";
    return std::filesystem::exists(file) ? read_file(file) : "";
}

void append(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::app | std::ios::binary) << text;
}

TEST(Watch, FollowsALogThatGrowsAndEndsBySignalWithItsLastWords) {
    const auto folder = test::scratch_dir();
    const auto log = read_file(test::sample(1));
    const auto half = log.find('\n', log.size() / 2) + 1;
    append(folder / "a.data", log.substr(0, half / 2));
    const auto source = test::source_dir();
    const auto child = test::start_program(
        "flightwatt-watch",
        {"--follow", "a.data", "--log", test::sample(1, ".log").string(), "--model",
         (source / "fits/mechanical/synthetic-wing.toml").string(), "--remaining", "100", "--battery",
         (source / "fits/battery/synthetic-3s.toml").string(), "--record", "kept", "--silence-s", "1"},
        folder);
    EXPECT_TRUE(test::wait_until([&] { return printed(folder).find("cruise") != std::string::npos; }));
    append(folder / "a.data", log.substr(half / 2, half - half / 2));
    const auto lines_in = [](const std::string& text) { return std::ranges::count(text, '\n'); };
    const auto kept_lines = [&] {
        std::ptrdiff_t lines = 0;
        std::error_code not_yet;
        for (const auto& entry : std::filesystem::directory_iterator(folder / "kept", not_yet))
            if (entry.path().extension() == ".data") lines += lines_in(read_file(entry.path()));
        return lines;
    };
    EXPECT_TRUE(test::wait_until([&] { return kept_lines() == lines_in(log.substr(0, half)); }));
    EXPECT_TRUE(
        test::wait_until([&] { return printed(folder).find("nothing was received for") != std::string::npos; }));
    ::kill(child, SIGTERM);
    EXPECT_EQ(test::exit_code_of(child), 0);
    EXPECT_THAT(read_file(folder / "stderr"), HasSubstr("ended by SIGTERM"));
    const auto words = printed(folder);
    EXPECT_THAT(words, HasSubstr("\nremaining "));
    EXPECT_THAT(words, HasSubstr(" at landing, "));
    std::size_t kept = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "kept")) {
        if (entry.path().extension() != ".data") continue;
        ++kept;
        const auto lines = read_file(entry.path());
        EXPECT_EQ(lines_in(lines), lines_in(log.substr(0, half)));
    }
    EXPECT_EQ(kept, 1U);
}

TEST(Watch, EndsWhereNobodyReadsItAnyMore) {
    const auto run = test::run_shell(
        "flightwatt watch --follow " + test::shell_quoted(test::sample(1)) + " | head -n 3", test::scratch_dir());
    EXPECT_EQ(run.code, 0);
    EXPECT_EQ(std::ranges::count(run.out, '\n'), 3);
}

TEST(Watch, WithoutAnyPredictionThereIsNoAnswer) {
    const auto run =
        test::run_shell("head -n 500 " + test::shell_quoted(test::sample(1)) + " | flightwatt watch - --log " +
                            test::shell_quoted(test::sample(1, ".log")) + " --remaining 100 --model " +
                            test::shell_quoted(test::source_dir() / "fits/mechanical/synthetic-wing.toml"),
                        test::scratch_dir());
    EXPECT_EQ(run.code, 4);
    EXPECT_THAT(run.out, HasSubstr("no prediction: "));
}

}  // namespace
}  // namespace flightwatt::cli
