#include "batch/write_guard.h"

#include "base/error.h"
#include "helpers/test_paths.h"

#include <csignal>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt::batch {
namespace {

/// Runs `body` in a process of its own. Once that has called its argument, it is sent the first of `signals`, and each
/// other once it has called its argument again. Returns the status of waitpid(): SIGALRM where the process did not end
/// for a minute.
int end_by(const std::vector<int>& signals, const std::function<void(const std::function<void()>&)>& body) {
    int ready[2] = {};
    if (::pipe(ready) != 0) throw std::runtime_error("no pipe");
    const auto child = ::fork();
    if (child == 0) {
        ::alarm(60);  // nothing of us stays behind
        for (const int signal : {SIGINT, SIGTERM, SIGHUP})
            std::signal(signal, SIG_DFL);  // a background job ignores one
        body([&] {
            if (::write(ready[1], "r", 1) != 1) ::_exit(99);
        });
        ::_exit(0);
    }
    ::close(ready[1]);
    for (const int signal : signals) {
        char byte = 0;
        if (::read(ready[0], &byte, 1) != 1) throw std::runtime_error("the child ended early");
        ::kill(child, signal);
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    ::close(ready[0]);
    return status;
}

/// A thread that computes and never looks up.
void compute(const std::function<void()>& ready) {
    volatile double sum = 0.0;
    ready();
    for (;;) sum = sum + 1.0;
}

TEST(EndAtSignals, EndsAProgramThatComputes) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const int status = end_by({signal}, [](const auto& ready) {
            end_at_signals("a test");
            const std::jthread other([] { compute([] {}); });
            compute(ready);
        });
        ASSERT_TRUE(WIFEXITED(status)) << signal;
        EXPECT_EQ(WEXITSTATUS(status), 128 + signal);
    }
}

TEST(EndAtSignals, EndsThoughNobodyReadsItsStandardError) {
    const int status = end_by({SIGINT}, [](const auto& ready) {
        int full[2] = {};
        if (::pipe(full) != 0 || ::fcntl(full[1], F_SETFL, O_NONBLOCK) != 0) ::_exit(97);
        while (::write(full[1], "x", 1) == 1) continue;
        ::fcntl(full[1], F_SETFL, 0);
        ::dup2(full[1], STDERR_FILENO);
        end_at_signals("a test");
        compute(ready);
    });
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
}

TEST(EndAtSignals, LeavesIgnoredSignalsIgnored) {
    const int status = end_by({SIGHUP, SIGINT, SIGTERM}, [](const auto& ready) {
        std::signal(SIGHUP, SIG_IGN);
        std::signal(SIGINT, SIG_IGN);
        end_at_signals("a test");
        for (int signals = 0; signals < 2; ++signals) ready();
        compute(ready);
    });
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 128 + SIGTERM);
}

TEST(FolderLock, KeepsASecondRunOut) {
    const auto folder = test::scratch_dir();
    std::optional<FolderLock> first(folder);
    try {
        const FolderLock second(folder);
        ADD_FAILURE() << "two at once";
    } catch (const OutputError& error) {
        EXPECT_EQ(std::string(error.what()),
                  "another run is writing into " + folder.string() + "; wait for it, or choose another folder");
    }
    first.reset();
    EXPECT_NO_THROW(FolderLock{folder});
    EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(FolderLock, HoldsOneFolderOnly) {
    const auto folder = test::scratch_dir();
    std::filesystem::create_directories(folder / "a");
    std::filesystem::create_directories(folder / "b");
    const FolderLock first(folder / "a");
    EXPECT_NO_THROW(FolderLock{folder / "b"});
}

TEST(FolderLock, FailsWhereThereIsNoFolder) { EXPECT_THROW(FolderLock{test::scratch_dir() / "missing"}, OutputError); }

}  // namespace
}  // namespace flightwatt::batch
