#pragma once

#include "cli/stage.h"
#include "cli/terminal.h"
#include "compute/compute_model.h"
#include "live/decision_command.h"
#include "live/live_flight.h"

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// What watch says of a flight in the air.
namespace flightwatt::cli {

/// All of a state; null for what is not known (docs/live.md). `compute` names what its decision runs.
Json json_of(const live::LiveState& state, const compute::ComputeModel& compute);

/// What a page is told.
struct PageEvent {
    std::string state;  ///< all of it, with the state of charge ahead and the point, as JSON
    std::string point;  ///< what charts show of it
};
PageEvent page_event(const live::LiveState& state, const compute::ComputeModel& compute, const live::TimeCurve& ahead);

/// One line, for a log of what was said.
std::string line_of(const live::LiveState& state, const compute::ComputeModel& compute);

/// A few lines, for a screen; alarms last.
std::vector<std::string> screen_of(const live::LiveState& state, const compute::ComputeModel& compute);

/// What --on-decision's command finds in its environment: FLIGHTWATT_TIME_S, FLIGHTWATT_PHASE, FLIGHTWATT_SOC_PERCENT,
/// FLIGHTWATT_RUN (JSON), and of each component FLIGHTWATT_COMPONENT_NAME (1 or 0) and, where it runs,
/// FLIGHTWATT_COMPONENT_NAME_PARAMETER. The state has a decision.
live::DecisionCommand::Environment decision_environment(const live::LiveState& state,
                                                        const compute::ComputeModel& compute);

/// Warnings of something that goes on: each is said when it first holds, whatever its numbers become.
class WarningThrottle {
  public:
    static constexpr std::size_t max_kinds = 200;

    /// Those that hold now and were not said yet.
    std::vector<std::string> due(const std::vector<std::string>& now);
    /// At the end: those whose numbers are others than those last said.
    std::vector<std::string> final_updates(const std::vector<std::string>& now);

  private:
    std::map<std::string, std::string> said_;  ///< by their texts without numbers
};

/// The standard output of watch: a screen on a terminal, else a line or with --json an object a state. What it is made
/// from has to outlive it.
class WatchOutput {
  public:
    WatchOutput(const StageCall& call, const compute::ComputeModel& compute);

    void print_state(const live::LiveState& state);
    bool is_read() const { return is_read_; }
    /// The last prediction, and why the stage ends.
    void end(const live::LiveFlight& flight, const std::string& why);

  private:
    void draw(const live::LiveState& state);

    const StageCall& call_;
    const compute::ComputeModel& compute_;
    std::optional<std::size_t> columns_;  ///< of the terminal that shows a screen
    WarningThrottle said_;
    std::vector<std::string> warnings_;  ///< of the latest state
    std::optional<std::chrono::steady_clock::time_point> drawn_;
    bool is_read_ = true;
};

}  // namespace flightwatt::cli
