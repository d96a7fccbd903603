#pragma once

#include <map>
#include <optional>
#include <string>

#include <sys/types.h>

namespace flightwatt::live {

/// A command of sh that is run at each change of a decision, one at a time, without waiting for it. Where it still runs
/// at the next change, it is run again once it has ended, with the latest decision.
class DecisionCommand {
  public:
    using Environment = std::map<std::string, std::string>;

    explicit DecisionCommand(std::string command) : command_(std::move(command)) {}
    DecisionCommand(const DecisionCommand&) = delete;
    DecisionCommand& operator=(const DecisionCommand&) = delete;
    ~DecisionCommand() = default;

    /// With these variables beside the program's own. Its standard output goes to the standard error.
    void run(const Environment& variables);
    /// What ended since, and badly: "exit code 3", "ended by SIGKILL", "cannot be run: ..."; starts what waits.
    std::optional<std::string> poll();
    /// Waits for what runs, at most so long; false if it still does.
    bool wait(int max_ms);

  private:
    void start(const Environment& variables);

    std::string command_;
    ::pid_t child_ = -1;
    std::optional<Environment> waiting_;
    std::string failure_;
};

}  // namespace flightwatt::live
