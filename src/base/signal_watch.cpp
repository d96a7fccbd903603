#include "base/signal_watch.h"

#include "base/error.h"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <sys/signalfd.h>
#include <unistd.h>

namespace flightwatt {

std::string signal_name(int signal) {
    const auto* name = ::sigabbrev_np(signal);
    return std::string("SIG") + (name == nullptr ? "?" : name);
}

std::vector<int> termination_signals() {
    std::vector<int> signals;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        const bool known = ::sigaction(signal, nullptr, &action) == 0;
        if (known && action.sa_handler != SIG_IGN) signals.push_back(signal);
    }
    return signals;
}

SignalWatch::SignalWatch() {
    sigset_t watched;
    sigemptyset(&watched);
    for (const int signal : termination_signals()) sigaddset(&watched, signal);
    ::sigprocmask(SIG_BLOCK, &watched, &before_);
    file_ = ::signalfd(-1, &watched, SFD_CLOEXEC | SFD_NONBLOCK);
    if (file_ >= 0) return;
    const int error = errno;
    ::sigprocmask(SIG_SETMASK, &before_, nullptr);
    throw OutputError(fmt::format("cannot watch for signals: {}", std::strerror(error)));
}

SignalWatch::~SignalWatch() {
    ::close(file_);
    ::sigprocmask(SIG_SETMASK, &before_, nullptr);
}

std::optional<int> SignalWatch::received() const {
    signalfd_siginfo info{};
    if (::read(file_, &info, sizeof info) != sizeof info) return std::nullopt;
    return static_cast<int>(info.ssi_signo);
}

}  // namespace flightwatt
