#pragma once

#include "cli/stage.h"
#include "compute/compute_model.h"
#include "live/decision_command.h"
#include "live/live_curves.h"
#include "live/live_flight.h"

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

}  // namespace flightwatt::cli
