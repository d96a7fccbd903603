#pragma once

#include "compute/compute_model.h"
#include "mission/timeline.h"

#include <vector>

namespace flightwatt::mission {

/// A part of a phase in which one configuration runs.
struct ScheduleSegment : PhaseSegment {
    compute::Configuration run;
    bool operator==(const ScheduleSegment&) const = default;
};

/// Appends a segment; if it runs what the last one of the same phase runs, that one becomes longer.
void append_merged(std::vector<ScheduleSegment>& schedule, ScheduleSegment segment);

/// Every different configuration of a schedule, in order of appearance.
std::vector<compute::Configuration> configurations_of(const std::vector<ScheduleSegment>& schedule);

/// The schedule when its phases, none of which may be planned to take 0 s, take other durations: each segment
/// keeps its part of the phase.
std::vector<ScheduleSegment> rescale_to_flown_durations(std::vector<ScheduleSegment> schedule,
                                                        const flight::PerPhase<double>& planned_s,
                                                        const flight::PerPhase<double>& flown_s);

}  // namespace flightwatt::mission
