#include "base/signal_watch.h"

#include <csignal>

#include <gtest/gtest.h>
#include <poll.h>

namespace flightwatt {
namespace {

bool is_readable(int file) {
    pollfd watched{file, POLLIN, 0};
    return ::poll(&watched, 1, 0) == 1;
}

TEST(SignalWatch, KeepsSignalsUntilTheyAreAskedFor) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        std::signal(signal, SIG_DFL);  // a background job of a shell ignores SIGINT, nohup SIGHUP
    }
    const SignalWatch watch;
    EXPECT_FALSE(watch.received());
    EXPECT_FALSE(is_readable(watch.fd()));
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        std::raise(signal);
        EXPECT_TRUE(is_readable(watch.fd()));
        EXPECT_EQ(watch.received(), signal);
        EXPECT_FALSE(watch.received());
    }
}

TEST(SignalWatch, LeavesIgnoredSignalsIgnored) {
    const auto before = std::signal(SIGHUP, SIG_IGN);
    {
        const SignalWatch watch;
        std::raise(SIGHUP);
        EXPECT_FALSE(watch.received());
    }
    std::signal(SIGHUP, before);
}

TEST(SignalWatch, EndsWithItsScope) {
    std::signal(SIGTERM, SIG_DFL);
    { const SignalWatch watch; }
    EXPECT_EXIT(std::raise(SIGTERM), testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace flightwatt
