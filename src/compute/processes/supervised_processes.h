#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace flightwatt::compute {

struct SupervisionOptions {
    int output = -1;  ///< file descriptor for standard output; -1: /dev/null
    int errors = -1;  ///< for standard error
    std::chrono::milliseconds kill_timeout{2000};
    std::filesystem::path folder = {};  ///< where the commands run; empty: the current one
};

/// Result of ending the commands.
struct ShutdownReport {
    bool left_processes = false;  ///< a command had ended, processes of its group had not
    bool killed = false;          ///< SIGTERM was not enough
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
/// these groups by SIGTERM, after kill_timeout by SIGKILL. If the program is killed, the commands are. For programs of
/// one thread. Throws OutputError without free processes or file descriptors.
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
    /// Ends all processes of the groups and waits for their end.
    ShutdownReport end();

  private:
    struct Command {
        ::pid_t group = -1;  ///< its process, which leads the group
        int process = -1;    ///< readable when it has ended (pidfd_open); -1: ended() reported it
    };

    explicit SupervisedProcesses(const SupervisionOptions& options);
    void start(const std::vector<std::string>& words, const SupervisionOptions& options);
    bool any_lives() const;
    bool wait_for_end(std::chrono::milliseconds patience) const;
    void signal_all(int signal) const;

    std::chrono::milliseconds kill_timeout_;
    int poll_fd_ = -1;
    std::vector<Command> commands_;
    std::vector<FinishedCommand> not_started_;
};

}  // namespace flightwatt::compute
