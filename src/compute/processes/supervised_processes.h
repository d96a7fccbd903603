#pragma once

#include <chrono>
#include <cstddef>
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
    std::size_t orphans = 0;    ///< processes that were alive beside the commands themselves
    bool killed = false;        ///< SIGTERM was not enough
    std::size_t survivors = 0;  ///< processes that not even SIGKILL ended
};

/// A command that has ended, or that could not be started.
struct FinishedCommand {
    int start_error = 0;  ///< errno, if it could not be started
    int wait_status = 0;  ///< as waitpid() gives it
    std::chrono::steady_clock::time_point time;
};

/// "exit code 3", "killed by SIGSEGV", "cannot be started: No such file or directory".
std::string to_string(const FinishedCommand& ended);

/// Commands (no shell) that run at the same time, each in a process group of its own, below a supervisor: a process of
/// ours that adopts whatever they fork, also what takes itself away with setsid(). When this object goes, or the
/// program ends in whatever way, the supervisor ends all of them: SIGTERM first, SIGKILL after the patience. To be used
/// by programs of one thread. Throws OutputError if the system has no more processes or files.
class SupervisedProcesses {
  public:
    /// Waits until each command is executed, or is among those that ended() reports as not started.
    SupervisedProcesses(const std::vector<std::vector<std::string>>& commands, const SupervisionOptions& options);
    ~SupervisedProcesses();
    SupervisedProcesses(const SupervisedProcesses&) = delete;
    SupervisedProcesses& operator=(const SupervisedProcesses&) = delete;

    /// A file that poll() finds readable when a command has ended.
    int poll_fd() const { return events_; }
    /// The commands that have ended since the last call.
    std::vector<FinishedCommand> ended();
    /// Ends everything that still runs and waits for that.
    ShutdownReport end();

  private:
    int events_ = -1;
    ::pid_t supervisor_ = -1;
    ShutdownReport report_;
};

}  // namespace flightwatt::compute
