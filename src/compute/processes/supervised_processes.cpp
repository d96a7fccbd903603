#include "compute/processes/supervised_processes.h"

#include "base/error.h"
#include "base/signal_watch.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt::compute {
namespace {

std::optional<SupervisorEvent> next_event(int events) {
    SupervisorEvent event;
    while (true) {
        const auto count = ::read(events, &event, sizeof event);
        if (count == sizeof event) return event;
        if (count < 0 && errno == EINTR) continue;
        return std::nullopt;
    }
}

}  // namespace

std::string to_string(const FinishedCommand& ended) {
    if (ended.start_error != 0) {
        return fmt::format("cannot be started: {}", std::strerror(ended.start_error));
    }
    if (WIFSIGNALED(ended.wait_status)) {
        return fmt::format("killed by {}", signal_name(WTERMSIG(ended.wait_status)));
    }
    return fmt::format("exit code {}", WEXITSTATUS(ended.wait_status));
}

SupervisedProcesses::SupervisedProcesses(const std::vector<std::vector<std::string>>& commands,
                                         const SupervisionOptions& options) {
    int ends[2] = {-1, -1};
    if (::pipe2(ends, O_CLOEXEC) != 0) {
        throw OutputError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
    }
    const auto parent = ::getpid();
    supervisor_ = ::fork();
    if (supervisor_ == 0) {
        ::close(ends[0]);
        supervise(commands, options, ends[1], parent);
    }
    const int error = errno;
    ::close(ends[1]);
    events_ = ends[0];
    ::fcntl(events_, F_SETFL, O_NONBLOCK);
    if (supervisor_ > 0) return;
    ::close(events_);
    throw OutputError(fmt::format("cannot start a process: {}", std::strerror(error)));
}

SupervisedProcesses::~SupervisedProcesses() {
    end();
    ::close(events_);
}

std::vector<FinishedCommand> SupervisedProcesses::ended() {
    std::vector<FinishedCommand> all;
    while (const auto event = next_event(events_)) {
        if (event->kind == SupervisorEvent::Kind::finished) {
            report_ = event->report;
            continue;
        }
        const std::chrono::steady_clock::time_point time{std::chrono::nanoseconds(event->time_ns)};
        const bool started = event->kind == SupervisorEvent::Kind::ended;
        // Of one that cannot be started the exit code follows, and is of no interest.
        all.push_back({event->command, started ? 0 : event->status, started ? event->status : 0, time});
    }
    return all;
}

ShutdownReport SupervisedProcesses::end() {
    if (supervisor_ < 0) return report_;
    ::kill(supervisor_, SIGTERM);
    while (::waitpid(supervisor_, nullptr, 0) < 0 && errno == EINTR) {
    }
    supervisor_ = -1;
    ended();  // its last words are the report
    return report_;
}

}  // namespace flightwatt::compute
