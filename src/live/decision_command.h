#pragma once

#include <map>
#include <optional>
#include <string>

#include <sys/types.h>

namespace flightwatt::live {

/// A command of sh, run at each change of a decision without waiting for it, one process at a time. If the decision
/// changes while it runs, it is run once more when it has ended, with the latest decision.
class DecisionCommand {
  public:
    using Environment = std::map<std::string, std::string>;

    explicit DecisionCommand(std::string command) : command_(std::move(command)) {}

    /// The variables are added to the program's environment. Standard output is redirected to standard error.
    void run(const Environment& variables);
    /// Starts a pending run. Returns a failure since the last call: "exit code 3", "ended by SIGKILL" ...
    std::optional<std::string> poll();
    /// Waits up to `max_ms` for all runs; false if one still runs.
    bool wait(int max_ms);

  private:
    void start(const Environment& variables);

    std::string command_;
    ::pid_t child_ = -1;
    std::optional<Environment> pending_;
    std::string failure_;
};

}  // namespace flightwatt::live
