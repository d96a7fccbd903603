#include "batch/write_guard.h"

#include "base/error.h"
#include "helpers/test_paths.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt::batch {
namespace {

using namespace std::chrono_literals;

TEST(WriteGate, WaitsForThoseInside) {
    WriteGate gate;
    std::atomic<bool> left = false;
    std::atomic<bool> inside = false;
    std::jthread writer([&] {
        const WriteGate::WriterGuard pass(gate);
        inside = true;
        std::this_thread::sleep_for(50ms);
        left = true;
    });
    while (!inside) std::this_thread::yield();
    EXPECT_TRUE(gate.close(60s));
    EXPECT_TRUE(left);
}

TEST(WriteGate, DoesNotWaitForever) {
    WriteGate gate;
    const WriteGate::WriterGuard pass(gate);
    EXPECT_FALSE(gate.close(10ms));
}

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

TEST(Interruption, EndsAProgramThatComputes) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const int status = end_by({signal}, [](const auto& ready) {
            WriteGate gate;
            const TerminationHandler interruption(gate, [](int) {});
            const std::jthread other([] { compute([] {}); });
            compute(ready);
        });
        ASSERT_TRUE(WIFEXITED(status)) << signal;
        EXPECT_EQ(WEXITSTATUS(status), 128 + signal);
    }
}

TEST(Interruption, LetsAFileBeWrittenFirstAndNoOther) {
    const int status = end_by({SIGINT}, [](const auto& ready) {
        WriteGate gate;
        std::atomic<bool> whole = false;
        const TerminationHandler interruption(gate, [&](int) {
            if (!whole) ::_exit(98);
        });
        {
            const WriteGate::WriterGuard pass(gate);
            ready();
            std::this_thread::sleep_for(50ms);  // much less than what a writer is given
            whole = true;
        }
        const WriteGate::WriterGuard pass(gate);
        ::_exit(97);
    });
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
}

TEST(Interruption, EndsThoughAFileTakesForEver) {
    const int status = end_by({SIGINT}, [](const auto& ready) {
        WriteGate gate;
        const TerminationHandler interruption(gate, [](int) {});
        const WriteGate::WriterGuard pass(gate);
        compute(ready);
    });
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
}

TEST(Interruption, EndsAtOnceAtTheSecondSignal) {
    const int status = end_by({SIGINT, SIGINT}, [](const auto& ready) {
        WriteGate gate;
        const TerminationHandler interruption(gate, [&](int) {
            ready();
            std::this_thread::sleep_for(50s);
        });
        compute(ready);
    });
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), SIGINT);
}

TEST(Interruption, LeavesIgnoredSignalsIgnored) {
    const int status = end_by({SIGHUP, SIGINT, SIGTERM}, [](const auto& ready) {
        std::signal(SIGHUP, SIG_IGN);
        std::signal(SIGINT, SIG_IGN);
        WriteGate gate;
        const TerminationHandler interruption(gate, [](int) {});
        for (int signals = 0; signals < 2; ++signals) ready();
        compute(ready);
    });
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 128 + SIGTERM);
}

TEST(Interruption, IsOverWithItsScope) {
    const int status = end_by({SIGTERM}, [](const auto& ready) {
        WriteGate gate;
        {
            const TerminationHandler interruption(gate, [](int) { ::_exit(98); });
        }
        compute(ready);
    });
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), SIGTERM);
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
