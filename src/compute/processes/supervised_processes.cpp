#include "compute/processes/supervised_processes.h"

#include "base/error.h"
#include "base/signal_watch.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

#include <boost/process/args.hpp>
#include <boost/process/child.hpp>
#include <boost/process/extend.hpp>
#include <boost/process/posix.hpp>
#include <boost/process/start_dir.hpp>
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

constexpr std::chrono::milliseconds kill_patience(5000);  // after SIGKILL, only the kernel can delay the end

OutputError process_error(int error) {
    return OutputError(fmt::format("cannot start a process: {}", std::strerror(error)));
}

/// The groups of the commands of all objects.
std::set<::pid_t>& all_groups() {
    static std::set<::pid_t> groups;
    return groups;
}

/// Whether a process of the group is alive; reaps those that have ended.
bool is_alive(::pid_t group) {
    while (::waitpid(-group, nullptr, WNOHANG) > 0) {
    }
    return ::kill(-group, 0) == 0;
}

}  // namespace

/// A process of this machine.
struct SupervisedProcesses::Process {
    ::pid_t id = 0;
    ::pid_t parent = 0;
    ::pid_t group = 0;
    char state = '?';  ///< 'Z': it has ended and is not reaped
    std::string name;

    static std::vector<Process> all() {
        std::vector<Process> found;
        std::error_code ended;
        for (std::filesystem::directory_iterator it("/proc", ended), end; it != end; it.increment(ended)) {
            std::ifstream file(it->path() / "stat");  // "321 (name) S parent group ..."
            std::string text;
            std::getline(file, text, '\0');
            const auto name = text.find('(');
            const auto rest = text.rfind(')');
            if (rest == std::string::npos) continue;
            Process process{std::atoi(text.c_str()), 0, 0, '?', text.substr(name + 1, rest - name - 1)};
            std::istringstream(text.substr(rest + 1)) >> process.state >> process.parent >> process.group;
            found.push_back(std::move(process));
        }
        return found;
    }
};

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
    : kill_timeout_(options.kill_timeout),
      owns_orphans_(options.owns_orphans),
      poll_fd_(::epoll_create1(EPOLL_CLOEXEC)) {
    if (poll_fd_ < 0) throw process_error(errno);
    ::prctl(PR_SET_CHILD_SUBREAPER, 1);
    if (!owns_orphans_) return;
    for (const auto& process : Process::all())
        if (process.parent == ::getpid()) strangers_.insert(process.id);
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
    namespace bp = boost::process;
    const auto parent = ::getpid();
    const auto prepare = [parent](auto& executor) {
        ::setpgid(0, 0);  // Ctrl-C on the terminal goes to the profiler only
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (::getppid() != parent) ::_exit(0);  // the parent has died before the line above
        for (const int signal : {SIGPIPE, SIGXFSZ, SIGCHLD, SIGTERM, SIGINT, SIGHUP}) ::signal(signal, SIG_DFL);
        sigset_t none;
        sigemptyset(&none);
        ::sigprocmask(SIG_SETMASK, &none, nullptr);
        ::execvp(executor.exe, executor.cmd_line);  // along PATH
        executor.exe = "";                          // so that Boost's own attempt fails and reports it
    };
    const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    const auto to = [&](int file) { return file >= 0 ? file : nothing; };
    std::error_code error;
    bp::child process(words.front(), bp::args(std::vector<std::string>(words.begin() + 1, words.end())),
                      bp::posix::fd.bind(STDIN_FILENO, nothing), bp::posix::fd.bind(STDOUT_FILENO, to(options.output)),
                      bp::posix::fd.bind(STDERR_FILENO, to(options.errors)),
                      bp::start_dir(options.folder.empty() ? "." : options.folder.string()),
                      bp::extend::on_exec_setup(prepare), error);
    ::close(nothing);
    if (error) return void(not_started_.push_back({error.value(), 0, Clock::now()}));
    const auto child = process.id();
    process.detach();
    all_groups().insert(child);
    const auto file = static_cast<int>(::syscall(SYS_pidfd_open, child, 0));
    commands_.push_back({child, file});
    ::epoll_event event{EPOLLIN, {}};
    if (file < 0 || ::epoll_ctl(poll_fd_, EPOLL_CTL_ADD, file, &event) != 0) throw process_error(errno);
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

ShutdownReport SupervisedProcesses::end(const std::function<void()>& waiting) {
    ShutdownReport report;
    ended();
    const bool has_ended = std::ranges::any_of(commands_, [](const Command& command) { return command.process < 0; });
    report.left_processes =
        has_ended &&
        (std::ranges::any_of(commands_, [](const Command& c) { return c.process < 0 && is_alive(c.group); }) ||
         std::ranges::any_of(orphans(), [](const Process& left) { return left.parent == ::getpid(); }));
    signal_all(SIGTERM);
    if (!wait_for_end(kill_timeout_, waiting)) {
        report.killed = true;
        const auto kill = [&] {
            signal_all(SIGKILL);  // also those that were forked since
            waiting();
        };
        if (!wait_for_end(kill_patience, kill)) {
            const auto left = orphans();
            report.survivor = left.empty() ? fmt::format("a process of group {}", commands_.front().group)
                                           : fmt::format("process {} ({})", left.front().id, left.front().name);
        }
    }
    for (const auto& command : commands_) {
        if (command.process >= 0) ::close(command.process);
        all_groups().erase(command.group);
    }
    commands_.clear();
    return report;
}

/// The processes that the commands have started and that left their groups: those below this program that belong to no
/// group of commands and were not there before. Reaps those that have ended.
std::vector<SupervisedProcesses::Process> SupervisedProcesses::orphans() const {
    if (!owns_orphans_ || commands_.empty()) return {};
    std::set<::pid_t> tree;
    for (const auto& command : commands_) tree.insert(command.group);
    const auto all = Process::all();
    const auto is_in_tree = [&](const Process& process) {
        const bool is_adopted =
            process.parent == ::getpid() && !strangers_.contains(process.id) && !all_groups().contains(process.group);
        return is_adopted || tree.contains(process.parent) || tree.contains(process.group);
    };
    for (auto before = tree.size() + 1; before != tree.size();) {
        before = tree.size();
        for (const auto& process : all)
            if (is_in_tree(process)) tree.insert(process.id);
    }
    std::vector<Process> found;
    for (const auto& process : all) {
        if (!tree.contains(process.id) || all_groups().contains(process.group)) continue;
        if (process.state == 'Z' && ::waitpid(process.id, nullptr, WNOHANG) == process.id) continue;
        found.push_back(process);
    }
    return found;
}

bool SupervisedProcesses::any_lives() const {
    bool any = false;
    for (const auto& command : commands_) any = is_alive(command.group) || any;  // reaps of all
    return any || !orphans().empty();
}

bool SupervisedProcesses::wait_for_end(std::chrono::milliseconds patience, const std::function<void()>& waiting) const {
    constexpr std::chrono::milliseconds interval(5);
    const auto until = Clock::now() + patience;
    while (any_lives()) {
        if (Clock::now() >= until) return false;
        waiting();
        std::this_thread::sleep_for(interval);
    }
    return true;
}

void SupervisedProcesses::signal_all(int signal) const {
    const auto left = orphans();  // before their parents end
    for (const auto& command : commands_) ::kill(-command.group, signal);
    for (const auto& process : left) ::kill(process.id, signal);
}

}  // namespace flightwatt::compute
