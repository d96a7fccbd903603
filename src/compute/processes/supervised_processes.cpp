#include "compute/processes/supervised_processes.h"

#include "base/error.h"
#include "base/number.h"
#include "base/signal_watch.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <type_traits>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt::compute {
namespace {

using Clock = std::chrono::steady_clock;

/// What the supervisor reports through its pipe; smaller than PIPE_BUF, so written whole.
struct SupervisorEvent {
    FinishedCommand finished;
    std::optional<ShutdownReport> report;  ///< the last event: instead of a command
};
static_assert(std::is_trivially_copyable_v<SupervisorEvent>);

/// Of each process: the child, and whether it lives.
std::multimap<::pid_t, std::pair<::pid_t, bool>> children_by_parent() {
    std::multimap<::pid_t, std::pair<::pid_t, bool>> children;
    std::error_code gone;  // a process may end while we look
    for (std::filesystem::directory_iterator it("/proc", gone), end; it != end; it.increment(gone)) {
        const auto pid = parse_unsigned(it->path().filename().string());
        if (!pid) continue;
        std::ifstream file(it->path() / "stat");
        std::string stat;
        if (!std::getline(file, stat, '\0')) continue;
        // "PID (name) state parent ..."; the name may hold blanks and brackets.
        std::istringstream fields(stat.substr(std::min(stat.rfind(')'), stat.size() - 1) + 1));
        char state = 'Z';
        ::pid_t parent = 0;
        fields >> state >> parent;
        children.emplace(parent, std::pair(static_cast<::pid_t>(*pid), state != 'Z' && state != 'X'));
    }
    return children;
}

/// The living processes below `root` (children, their children, ...), from /proc. Zombies are not among them.
/// What a process forked away with setsid() is still below the nearest ancestor that is a subreaper.
std::vector<::pid_t> descendants_of(::pid_t root) {
    const auto children = children_by_parent();
    std::vector<::pid_t> found;
    std::vector<::pid_t> open{root};
    while (!open.empty()) {
        const auto [first, last] = children.equal_range(open.back());
        open.pop_back();
        for (auto child = first; child != last; ++child) {
            const auto& [pid, lives] = child->second;
            open.push_back(pid);
            if (lives) found.push_back(pid);
        }
    }
    return found;
}

constexpr int cannot_execute = 127;               // what a shell exits with then
constexpr std::chrono::seconds kill_patience(5);  // after SIGKILL only the kernel can delay an end

void report(int events, const SupervisorEvent& event) {
    // Where the profiler is gone this fails, and what runs is ended in any case.
    [[maybe_unused]] const auto ignored = ::write(events, &event, sizeof event);
}

[[noreturn]] void become(const std::vector<std::string>& words, const SupervisionOptions& options, int events) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // should the supervisor itself be killed
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
    report(events, {{errno, 0, Clock::now()}, {}});
    ::_exit(cannot_execute);
}

class Supervisor {
  public:
    Supervisor(int events, std::chrono::milliseconds patience) : events_(events), patience_(patience) {}

    void start(const std::vector<std::string>& words, const SupervisionOptions& options) {
        const auto child = ::fork();
        if (child == 0) become(words, options, events_);
        if (child < 0) report(events_, {{errno, 0, Clock::now()}, {}});
        if (child > 0) ::setpgid(child, child);  // here too: it may be signalled before it runs
        commands_.push_back(child);
    }

    /// Tells of those that have ended; false if no process is left.
    bool reap() {
        while (true) {
            int status = 0;
            const auto child = ::waitpid(-1, &status, WNOHANG);
            if (child == 0) return true;
            if (child < 0) return errno != ECHILD;
            const auto known = std::find(commands_.begin(), commands_.end(), child);
            if (known == commands_.end()) continue;
            *known = -1;
            report(events_, {{0, status, Clock::now()}, {}});
        }
    }

    ShutdownReport end_all() {
        ShutdownReport shutdown;
        auto living = descendants_of(::getpid());
        shutdown.orphans = static_cast<std::size_t>(std::count_if(living.begin(), living.end(), [&](auto pid) {
            return std::find(commands_.begin(), commands_.end(), pid) == commands_.end();
        }));
        for (const auto pid : living) ::kill(pid, SIGTERM);
        const auto term_until = Clock::now() + patience_;
        const auto kill_until = term_until + kill_patience;
        while (reap() && Clock::now() < kill_until) {
            if (Clock::now() >= term_until) {
                shutdown.killed = true;
                // Anew every time: they may fork on while they are being killed.
                for (const auto pid : descendants_of(::getpid())) ::kill(pid, SIGKILL);
            }
            wait_for_child(std::chrono::milliseconds(10));
        }
        shutdown.survivors = descendants_of(::getpid()).size();
        return shutdown;
    }

  private:
    static void wait_for_child(std::chrono::nanoseconds time) {
        sigset_t child;
        sigemptyset(&child);
        sigaddset(&child, SIGCHLD);
        const ::timespec limit{0, static_cast<long>(time.count())};
        ::sigtimedwait(&child, nullptr, &limit);
    }

    int events_;
    std::chrono::milliseconds patience_;
    std::vector<::pid_t> commands_;  ///< -1 once ended
};

/// Starts the commands, adopts what they fork, reports each that ends, and on SIGTERM, or when `parent` is gone, ends
/// all of them. `starting` is closed here and by each command that is executed. To be called in a forked process.
[[noreturn]] void supervise(const std::vector<std::vector<std::string>>& commands, const SupervisionOptions& options,
                            int events, int starting, ::pid_t parent) {
    ::setpgid(0, 0);  // Ctrl-C on the terminal is the profiler's to answer
    sigset_t awaited;
    sigemptyset(&awaited);
    for (const int signal : {SIGCHLD, SIGTERM, SIGINT, SIGHUP, SIGPIPE}) sigaddset(&awaited, signal);
    ::sigprocmask(SIG_BLOCK, &awaited, nullptr);
    ::signal(SIGCHLD, SIG_DFL);
    ::prctl(PR_SET_CHILD_SUBREAPER, 1);
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(0);  // it has died before the line above
    Supervisor supervisor(events, options.kill_timeout);
    for (const auto& words : commands) supervisor.start(words, options);
    ::close(starting);
    while (true) {
        int signal = 0;
        if (::sigwait(&awaited, &signal) != 0 || signal == SIGTERM) break;
        if (signal == SIGCHLD) supervisor.reap();
    }
    report(events, {{}, supervisor.end_all()});
    ::_exit(0);
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
    const auto events = make_pipe();
    const auto starting = make_pipe();
    const auto parent = ::getpid();
    supervisor_ = ::fork();
    if (supervisor_ == 0) {
        ::close(events.reads);
        ::close(starting.reads);
        supervise(commands, options, events.writes, starting.writes, parent);
    }
    const int error = errno;
    ::close(events.writes);
    ::close(starting.writes);
    events_ = events.reads;
    ::fcntl(events_, F_SETFL, O_NONBLOCK);
    // At its end when the supervisor and all commands have closed it: each is executed, or reported as not started.
    char nothing = 0;
    while (::read(starting.reads, &nothing, 1) < 0 && errno == EINTR) {
    }
    ::close(starting.reads);
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
    // Of one that cannot be started its exit code follows, and is of no interest.
    while (const auto event = next_event(events_)) {
        if (event->report)
            report_ = *event->report;
        else
            all.push_back(event->finished);
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
