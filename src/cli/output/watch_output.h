#pragma once

#include "cli/stage.h"
#include "cli/terminal.h"
#include "compute/compute_model.h"
#include "live/live_flight.h"
#include "live/live_state.h"

#include <chrono>
#include <optional>
#include <set>
#include <string>
#include <vector>

/// Output of watch.
namespace flightwatt::cli {

/// JSON of a state; `compute` names the components of its decision.
struct WatchState {
    const live::LiveState* state = nullptr;
    const compute::ComputeModel* compute = nullptr;
};
Fields<WatchState> record_fields(const WatchState*);

/// The last line of JSON.
struct WatchEnd {
    std::string ended;
    std::optional<WatchState> last_prediction;
};
Fields<WatchEnd> record_fields(const WatchEnd*);

/// An event for the page, as JSON.
struct PageEvent {
    std::string state;  ///< the state with the predicted state of charge and the point
    std::string point;  ///< values of the charts
};
PageEvent page_event(const live::LiveState& state, const compute::ComputeModel& compute, const live::TimeCurve& ahead);

/// A few lines, for a screen; alarms last.
std::vector<std::string> screen_of(const live::LiveState& state, const compute::ComputeModel& compute);

/// The same in one line, for a log.
std::string line_of(const live::LiveState& state, const compute::ComputeModel& compute);

/// The warnings that were not reported yet, whatever their numbers were; at most 200 kinds.
std::vector<std::string> fresh_warnings(const std::vector<std::string>& now, std::set<std::string>& reported);

/// The standard output of watch: a screen on a terminal, else a line or with --json an object per state. Its arguments
/// must outlive it.
class WatchOutput {
  public:
    WatchOutput(const StageCall& call, const compute::ComputeModel& compute);

    void print_state(const live::LiveState& state);
    bool is_read() const { return is_read_; }
    /// Prints the last prediction and the reason of the end.
    void end(const live::LiveFlight& flight, const std::string& why);

  private:
    void draw(const live::LiveState& state);

    const StageCall& call_;
    const compute::ComputeModel& compute_;
    bool is_screen_;
    std::set<std::string> reported_;  ///< warnings without their numbers
    std::optional<std::chrono::steady_clock::time_point> drawn_;
    bool is_read_ = true;
};

}  // namespace flightwatt::cli
