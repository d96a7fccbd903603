#include "compute/processes/supervised_processes.h"

#include "base/error.h"
#include "base/signal_watch.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/epoll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt::compute {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int cannot_execute = 127;                       // exit code of a shell then
constexpr std::chrono::milliseconds kill_patience(5000);  // after SIGKILL, only the kernel can delay the end

OutputError process_error(int error) {
    return OutputError(fmt::format("cannot start a process: {}", std::strerror(error)));
}

struct Pipe {
    int reads = -1;
    int writes = -1;
};

Pipe make_pipe() {
    int ends[2] = {-1, -1};
    if (::pipe2(ends, O_CLOEXEC) != 0) throw OutputError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
    return {ends[0], ends[1]};
}

/// Executes the command in a forked process. Writes errno to `failure` on an error; else it is closed.
[[noreturn]] void become(const std::vector<std::string>& words, const SupervisionOptions& options, int failure,
                         ::pid_t parent) {
    ::setpgid(0, 0);  // Ctrl-C on the terminal goes to the profiler only
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(0);  // the parent has died before the line above
    const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(options.output >= 0 ? options.output : nothing, STDOUT_FILENO);
    ::dup2(options.errors >= 0 ? options.errors : nothing, STDERR_FILENO);
    for (const int signal : {SIGPIPE, SIGXFSZ, SIGCHLD, SIGTERM, SIGINT, SIGHUP}) ::signal(signal, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    std::vector<char*> arguments(words.size() + 1);  // and a null pointer
    std::ranges::transform(words, arguments.begin(), [](auto& word) { return const_cast<char*>(word.c_str()); });
    ::execvp(arguments.front(), arguments.data());
    const int error = errno;
    [[maybe_unused]] const auto ignored = ::write(failure, &error, sizeof error);
    ::_exit(cannot_execute);
}

/// Whether a process of the group is alive; reaps those that have ended.
bool is_alive(::pid_t group) {
    while (::waitpid(-group, nullptr, WNOHANG) > 0) {
    }
    return ::kill(-group, 0) == 0;
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

SupervisedProcesses::SupervisedProcesses(const SupervisionOptions& options)
    : kill_timeout_(options.kill_timeout), poll_fd_(::epoll_create1(EPOLL_CLOEXEC)) {
    if (poll_fd_ < 0) throw process_error(errno);
    ::prctl(PR_SET_CHILD_SUBREAPER, 1);  // reaps orphans also where no init does
}

SupervisedProcesses::SupervisedProcesses(const std::vector<std::vector<std::string>>& commands,
                                         const SupervisionOptions& options)
    : SupervisedProcesses(options) {
    for (const auto& words : commands) start(words, options);
}

SupervisedProcesses::~SupervisedProcesses() {
    end();
    ::close(poll_fd_);
}

void SupervisedProcesses::start(const std::vector<std::string>& words, const SupervisionOptions& options) {
    const auto failure = make_pipe();
    const auto parent = ::getpid();
    const auto child = ::fork();
    if (child == 0) become(words, options, failure.writes, parent);
    const int fork_error = errno;
    ::close(failure.writes);
    int start_error = 0;
    if (child > 0) {
        ::setpgid(child, child);  // here too: a signal may come before it runs
        while (::read(failure.reads, &start_error, sizeof start_error) < 0 && errno == EINTR) {
        }
    }
    ::close(failure.reads);
    if (child < 0) throw process_error(fork_error);
    if (start_error != 0) {
        ::waitpid(child, nullptr, 0);
        not_started_.push_back({start_error, 0, Clock::now()});
        return;
    }
    const auto process = static_cast<int>(::syscall(SYS_pidfd_open, child, 0));
    commands_.push_back({child, process});
    ::epoll_event event{EPOLLIN, {}};
    if (process < 0 || ::epoll_ctl(poll_fd_, EPOLL_CTL_ADD, process, &event) != 0) throw process_error(errno);
}

std::vector<FinishedCommand> SupervisedProcesses::ended() {
    auto all = std::exchange(not_started_, {});
    for (auto& [group, process] : commands_) {
        int status = 0;
        if (process < 0 || ::waitpid(group, &status, WNOHANG) != group) continue;
        all.push_back({0, status, Clock::now()});
        ::close(std::exchange(process, -1));
    }
    return all;
}

ShutdownReport SupervisedProcesses::end() {
    ShutdownReport report;
    ended();
    report.left_processes = std::ranges::any_of(
        commands_, [](const Command& command) { return command.process < 0 && is_alive(command.group); });
    signal_all(SIGTERM);
    if (!wait_for_end(kill_timeout_)) {
        report.killed = true;
        signal_all(SIGKILL);
        wait_for_end(kill_patience);
    }
    for (const auto& command : commands_)
        if (command.process >= 0) ::close(command.process);
    commands_.clear();
    return report;
}

bool SupervisedProcesses::any_lives() const {
    bool any = false;
    for (const auto& command : commands_) any = is_alive(command.group) || any;  // reaps of all
    return any;
}

bool SupervisedProcesses::wait_for_end(std::chrono::milliseconds patience) const {
    constexpr std::chrono::milliseconds interval(5);
    const auto until = Clock::now() + patience;
    while (any_lives()) {
        if (Clock::now() >= until) return false;
        std::this_thread::sleep_for(interval);
    }
    return true;
}

void SupervisedProcesses::signal_all(int signal) const {
    for (const auto& command : commands_) ::kill(-command.group, signal);
}

}  // namespace flightwatt::compute
