#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <sys/types.h>

namespace flightwatt::compute {

struct SupervisionOptions {
    int output = -1;  ///< file descriptor for standard output; -1: /dev/null
    int errors = -1;  ///< for standard error
    std::chrono::milliseconds kill_timeout{2000};
    std::filesystem::path folder = {};  ///< where the commands run; empty: the current one
    /// Whether processes that left the commands' groups are ended with them: not those of a sampler, as it is restarted
    /// while others run.
    bool owns_orphans = true;
};

/// Result of ending the commands.
struct ShutdownReport {
    bool left_processes = false;  ///< a command had ended, processes that it had started had not
    bool killed = false;          ///< SIGTERM was not enough
    std::string survivor;         ///< "process 321 (name)", which SIGKILL did not end either; or empty
};

/// A command that has ended, or that could not be started.
struct FinishedCommand {
    int start_error = 0;  ///< errno, if it could not be started
    int wait_status = 0;  ///< of waitpid()
    std::chrono::steady_clock::time_point time;
};

/// "exit code 3", "killed by SIGSEGV", "cannot be started: No such file or directory".
std::string to_string(const FinishedCommand& ended);

/// Commands (no shell) that run at the same time, each in its own process group. The destructor ends all processes of
/// these groups, and those that left them as daemons do, by SIGTERM, after kill_timeout by SIGKILL. The program adopts
/// such processes when their parents end (PR_SET_CHILD_SUBREAPER), so that they are found as its descendants; what a
/// service starts for a command (docker, systemd) is not. If the program is killed, the commands are, but not what left
/// their groups. For programs of one thread. Throws OutputError without free processes or file descriptors.
class SupervisedProcesses {
  public:
    /// Waits until each command is executed; ended() reports those that cannot be started.
    SupervisedProcesses(const std::vector<std::vector<std::string>>& commands, const SupervisionOptions& options);
    ~SupervisedProcesses();
    SupervisedProcesses(const SupervisedProcesses&) = delete;
    SupervisedProcesses& operator=(const SupervisedProcesses&) = delete;

    /// Readable (poll()) when a command has ended.
    int poll_fd() const { return poll_fd_; }
    /// The commands that have ended since the last call.
    std::vector<FinishedCommand> ended();
    /// Ends all processes of the commands and waits for their end, in which it calls `waiting` every few milliseconds.
    ShutdownReport end(const std::function<void()>& waiting = [] {});

  private:
    struct Process;
    struct Command {
        ::pid_t group = -1;  ///< its process, which leads the group
        int process = -1;    ///< readable when it has ended (pidfd_open); -1: ended() reported it
    };

    explicit SupervisedProcesses(const SupervisionOptions& options);
    void start(const std::vector<std::string>& words, const SupervisionOptions& options);
    std::vector<Process> orphans() const;
    bool any_lives() const;
    bool wait_for_end(std::chrono::milliseconds patience, const std::function<void()>& waiting) const;
    void signal_all(int signal) const;

    std::chrono::milliseconds kill_timeout_;
    bool owns_orphans_;
    std::set<::pid_t> strangers_;  ///< children of this program from before the commands
    int poll_fd_ = -1;
    std::vector<Command> commands_;
    std::vector<FinishedCommand> not_started_;
};

}  // namespace flightwatt::compute
