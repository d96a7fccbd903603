// Progress on a terminal of our own.

#include "cli/terminal.h"

#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <array>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

constexpr auto beyond_interval = std::chrono::milliseconds(120);

/// A terminal of our own, and what was printed on it.
class Terminal {
  public:
    explicit Terminal(unsigned short columns) : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
        if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) {
            throw std::runtime_error("no terminal");
        }
        stream_ = std::fopen(::ptsname(master_), "w");
        if (stream_ == nullptr) throw std::runtime_error("no terminal");
        winsize size{};
        size.ws_col = columns;
        ::ioctl(::fileno(stream_), TIOCSWINSZ, &size);
    }
    ~Terminal() {
        std::fclose(stream_);
        ::close(master_);
    }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    std::FILE* stream() { return stream_; }
    /// What was printed since the last call. The kernel brings it to this end when it has time: a mark behind it shows
    /// that all of it has come.
    std::string printed() {
        constexpr char mark = '\1';
        std::string text;
        if (::write(::fileno(stream_), &mark, 1) != 1) throw std::runtime_error("the terminal takes nothing");
        constexpr int limit_ms = 60'000;
        for (::pollfd line{master_, POLLIN, 0}; !text.ends_with(mark) && ::poll(&line, 1, limit_ms) == 1;) {
            std::array<char, 4096> part{};
            const auto n = ::read(master_, part.data(), part.size());
            if (n > 0) text.append(part.data(), static_cast<std::size_t>(n));
        }
        if (!text.ends_with(mark)) throw std::runtime_error("what was printed never came");
        text.pop_back();
        return text;
    }

  private:
    int master_;
    std::FILE* stream_ = nullptr;
};

/// A container may have no pseudo-terminals.
bool has_terminals() {
    const int master = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (master < 0) return false;
    const bool usable = ::grantpt(master) == 0 && ::unlockpt(master) == 0 && ::access(::ptsname(master), W_OK) == 0;
    ::close(master);
    return usable;
}

TEST(ProgressBar, DrawsAtMostTenTimesASecond) {
    constexpr double most_per_s = 10.0;
    if (!has_terminals()) GTEST_SKIP() << "no pseudo-terminal here";
    Terminal terminal(60);
    const auto start = std::chrono::steady_clock::now();
    ProgressBar bar("logs", terminal.stream());
    for (std::size_t i = 1; i <= 50; ++i) bar.show(i, 1000);
    std::this_thread::sleep_for(beyond_interval);
    for (std::size_t i = 51; i <= 100; ++i) bar.show(i, 1000);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    const auto printed = terminal.printed();
    EXPECT_THAT(printed, HasSubstr("51/1000 logs, "));
    EXPECT_THAT(printed, HasSubstr(" left"));
    int drawn = 0;
    for (auto at = printed.find("/1000"); at != std::string::npos; at = printed.find("/1000", at + 1)) ++drawn;
    EXPECT_LE(drawn, most_per_s * taken.count()) << "of 100 calls";
}

std::string first_drawn(ProgressBar& bar, Terminal& terminal) {
    std::this_thread::sleep_for(beyond_interval);
    bar.show(3, 8);
    return terminal.printed();
}

TEST(ProgressBar, StaysOnOneLineAndIsGoneInTheEnd) {
    if (!has_terminals()) GTEST_SKIP() << "no pseudo-terminal here";
    Terminal terminal(30);
    ProgressBar bar("logs", terminal.stream());
    const auto drawn = first_drawn(bar, terminal);
    EXPECT_THAT(drawn, HasSubstr("3/8"));
    EXPECT_LT(drawn.size(), 30U);
    bar.hide();
    EXPECT_EQ(terminal.printed(), "\r" + std::string(drawn.size(), ' ') + "\r");
}

TEST(ProgressBar, GoesOnAfterItWasHidden) {
    if (!has_terminals()) GTEST_SKIP() << "no pseudo-terminal here";
    Terminal terminal(30);
    ProgressBar bar("logs", terminal.stream());
    const auto drawn = first_drawn(bar, terminal);
    bar.hide();
    EXPECT_EQ(terminal.printed(), "\r" + std::string(drawn.size(), ' ') + "\r");
    std::this_thread::sleep_for(beyond_interval);
    bar.show(4, 8);
    EXPECT_THAT(terminal.printed(), HasSubstr("4/8"));
}

TEST(Terminal, WrapsBetweenWords) {
    EXPECT_EQ(wrapped("warning: one two three", 14), "warning: one\n  two three");
    EXPECT_EQ(wrapped("one two", 7), "one two");
    EXPECT_EQ(wrapped("one two", 5, ""), "one\ntwo");
    EXPECT_EQ(wrapped("a a-word-that-is-too-long b", 10), "a\n  a-word-that-is-too-long\n  b");
    EXPECT_EQ(wrapped("\u00e4\u00e4\u00e4 \u00e4\u00e4\u00e4", 7), "\u00e4\u00e4\u00e4 \u00e4\u00e4\u00e4")
        << "columns are characters";
}

TEST(Terminal, LeavesTextForFilesAsItIs) {
    const auto text = std::string(60, 'a') + " " + std::string(60, 'b') + "\nc\n";
    auto* file = std::tmpfile();
    EXPECT_EQ(fitted(text, file), text);
    EXPECT_FALSE(is_coloured(file));
    std::fclose(file);
}

TEST(ProgressBar, SaysNothingWhereTheStandardErrorIsNoTerminal) {
    if (::isatty(STDERR_FILENO) != 0) GTEST_SKIP() << "the standard error is a terminal here";
    testing::internal::CaptureStderr();
    {
        ProgressBar progress("logs");
        const auto show = progress.callback();
        std::this_thread::sleep_for(beyond_interval);
        show(1, 2);
        progress.hide();
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ProgressBar, IsDrawnForAProgramThatReadsIt) {
    if (::isatty(STDERR_FILENO) != 0) GTEST_SKIP() << "the standard error is a terminal here";
    ASSERT_EQ(::setenv("FLIGHTWATT_PROGRESS", "1", 1), 0);
    testing::internal::CaptureStderr();
    {
        ProgressBar progress("logs");
        std::this_thread::sleep_for(beyond_interval);
        progress.show(1, 2);
    }
    ::unsetenv("FLIGHTWATT_PROGRESS");
    EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::StartsWith("1/2 logs"));
}

}  // namespace
}  // namespace flightwatt::cli
