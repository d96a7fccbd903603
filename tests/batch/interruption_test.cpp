#include "batch/interruption.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt::batch {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

TEST(WriteGate, WaitsForThoseInside) {
    WriteGate gate;
    std::atomic<bool> left = false;
    std::atomic<bool> inside = false;
    std::jthread writer([&] {
        const WriteGate::Pass pass(gate);
        inside = true;
        std::this_thread::sleep_for(50ms);
        left = true;
    });
    while (!inside) std::this_thread::yield();
    EXPECT_TRUE(gate.close(10s));
    EXPECT_TRUE(left);
}

TEST(WriteGate, DoesNotWaitForever) {
    WriteGate gate;
    const WriteGate::Pass pass(gate);
    EXPECT_FALSE(gate.close(10ms));
}

struct Ended {
    int status = -1;  ///< of waitpid()
    std::chrono::duration<double> after{};
};

/// Runs `body` in a process of its own. Once that has called its argument, it is sent `signals`, 20 ms apart.
Ended end_by(const std::vector<int>& signals, const std::function<void(const std::function<void()>&)>& body) {
    int ready[2] = {};
    if (::pipe(ready) != 0) throw std::runtime_error("no pipe");
    const auto child = ::fork();
    if (child == 0) {
        ::alarm(20);  // nothing of us stays behind
        body([&] {
            if (::write(ready[1], "r", 1) != 1) ::_exit(99);
        });
        ::_exit(0);
    }
    char byte = 0;
    if (::read(ready[0], &byte, 1) != 1) throw std::runtime_error("the child ended early");
    const auto begin = Clock::now();
    for (const int signal : signals) {
        ::kill(child, signal);
        std::this_thread::sleep_for(20ms);
    }
    Ended ended;
    ::waitpid(child, &ended.status, 0);
    ended.after = Clock::now() - begin;
    ::close(ready[0]);
    ::close(ready[1]);
    return ended;
}

/// A thread that computes and never looks up.
void compute(const std::function<void()>& ready) {
    volatile double sum = 0.0;
    ready();
    for (;;) sum = sum + 1.0;
}

TEST(Interruption, EndsAProgramThatComputes) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const auto ended = end_by({signal}, [](const auto& ready) {
            WriteGate gate;
            const Interruption interruption(gate, [](int) {});
            const std::jthread other([] { compute([] {}); });
            compute(ready);
        });
        ASSERT_TRUE(WIFEXITED(ended.status)) << signal;
        EXPECT_EQ(WEXITSTATUS(ended.status), 128 + signal);
        EXPECT_LT(ended.after, 1s);
    }
}

TEST(Interruption, LetsAFileBeWrittenFirstAndNoOther) {
    const auto ended = end_by({SIGINT}, [](const auto& ready) {
        WriteGate gate;
        std::atomic<bool> whole = false;
        const Interruption interruption(gate, [&](int) {
            if (!whole) ::_exit(98);
        });
        {
            const WriteGate::Pass pass(gate);
            ready();
            std::this_thread::sleep_for(200ms);
            whole = true;
        }
        const WriteGate::Pass pass(gate);
        ::_exit(97);
    });
    ASSERT_TRUE(WIFEXITED(ended.status));
    EXPECT_EQ(WEXITSTATUS(ended.status), 130);
}

TEST(Interruption, EndsWithinASecondThoughAFileTakesLonger) {
    const auto ended = end_by({SIGINT}, [](const auto& ready) {
        WriteGate gate;
        const Interruption interruption(gate, [](int) {});
        const WriteGate::Pass pass(gate);
        compute(ready);
    });
    ASSERT_TRUE(WIFEXITED(ended.status));
    EXPECT_EQ(WEXITSTATUS(ended.status), 130);
    EXPECT_LT(ended.after, 1s);
}

TEST(Interruption, EndsAtOnceAtTheSecondSignal) {
    const auto ended = end_by({SIGINT, SIGINT}, [](const auto& ready) {
        WriteGate gate;
        const Interruption interruption(gate, [](int) { std::this_thread::sleep_for(10s); });
        compute(ready);
    });
    ASSERT_TRUE(WIFSIGNALED(ended.status));
    EXPECT_EQ(WTERMSIG(ended.status), SIGINT);
}

TEST(Interruption, LeavesIgnoredSignalsIgnored) {
    const auto ended = end_by({SIGHUP, SIGINT, SIGTERM}, [](const auto& ready) {
        std::signal(SIGHUP, SIG_IGN);
        std::signal(SIGINT, SIG_IGN);
        WriteGate gate;
        const Interruption interruption(gate, [](int) {});
        compute(ready);
    });
    ASSERT_TRUE(WIFEXITED(ended.status));
    EXPECT_EQ(WEXITSTATUS(ended.status), 128 + SIGTERM);
}

TEST(Interruption, IsOverWithItsScope) {
    const auto ended = end_by({SIGTERM}, [](const auto& ready) {
        WriteGate gate;
        {
            const Interruption interruption(gate, [](int) { ::_exit(98); });
        }
        compute(ready);
    });
    ASSERT_TRUE(WIFSIGNALED(ended.status));
    EXPECT_EQ(WTERMSIG(ended.status), SIGTERM);
}

}  // namespace
}  // namespace flightwatt::batch
