#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <sys/types.h>

namespace flightwatt::compute {

struct SupervisionOptions {
    int output = -1;  ///< an open file for what the commands print
    int errors = -1;  ///< and for what they say
    std::chrono::milliseconds kill_timeout{2000};
};

/// What was found when the commands were ended.
struct ShutdownReport {
    bool left_processes = false;  ///< a command had ended and left processes of its group
    bool killed = false;          ///< SIGTERM was not enough
};

/// A command that has ended, or that could not be started.
struct FinishedCommand {
    int start_error = 0;  ///< errno, if it could not be started
    int wait_status = 0;  ///< as waitpid() gives it
    std::chrono::steady_clock::time_point time;
};

/// "exit code 3", "killed by SIGSEGV", "cannot be started: No such file or directory".
std::string to_string(const FinishedCommand& ended);

/// Commands (no shell) that run at the same time, each in a process group of its own. When this object goes, all
/// processes of these groups are ended: SIGTERM first, SIGKILL after the patience. Where the program itself is killed,
/// the commands are. To be used by programs of one thread. Throws OutputError if the system has no more processes or
/// files.
class SupervisedProcesses {
  public:
    /// Waits until each command is executed, or is among those that ended() reports as not started.
    SupervisedProcesses(const std::vector<std::vector<std::string>>& commands, const SupervisionOptions& options);
    ~SupervisedProcesses();
    SupervisedProcesses(const SupervisedProcesses&) = delete;
    SupervisedProcesses& operator=(const SupervisedProcesses&) = delete;

    /// A file that poll() finds readable when a command has ended.
    int poll_fd() const { return poll_fd_; }
    /// The commands that have ended since the last call.
    std::vector<FinishedCommand> ended();
    /// Ends everything that still runs and waits for that.
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
