#pragma once

#include "compute/compute_model.h"
#include "mechanical/mechanical_model.h"

#include <vector>

namespace flightwatt::mission {

using flight::all_phases;
using flight::PerPhase;
using flight::Phase;
using flight::PhaseSegment;
using flight::TimeInterval;

/// When each phase is flown, in seconds since the mission began; a phase that is not flown starts as it ends.
struct MissionTimeline {
    PerPhase<double> start_s;
    PerPhase<double> end_s;
    double duration_s = 0.0;  ///< of the whole mission
};

MissionTimeline timeline_of(const PerPhase<double>& duration_s);

/// Times of a phase nearer than this are one: percentages of a phase meet seconds only up to rounding.
constexpr double same_time_tolerance_s(double phase_duration_s) {
    return 1e-9 * (phase_duration_s > 1.0 ? phase_duration_s : 1.0);
}

/// A mission time for other phase durations: at the same fraction of the same phase.
double rescale_to_flown_durations_s(double time_s, const PerPhase<double>& planned_s, const PerPhase<double>& flown_s);

/// A part of a phase in which one configuration runs.
struct ScheduleSegment : PhaseSegment {
    compute::Configuration run;
    bool operator==(const ScheduleSegment&) const = default;
};

/// In the order of time.
using Schedule = std::vector<ScheduleSegment>;

/// A schedule for the rest of a mission.
struct Plan {
    bool feasible = false;
    /// From the start to the mission's end; if infeasible, the one of least energy demand.
    Schedule schedule;
    double utility = 0.0;            ///< mean utility a second of the rest of the mission
    double utility_bound = 0.0;      ///< no schedule that keeps the reserve has more; 0 if infeasible
    bool bound_is_proven = true;     ///< false: something charges the battery
    double final_soc_percent = 0.0;  ///< minus infinity where the battery does not last
};

/// Appends a segment, or extends the last one if phase and configuration are the same.
void append_merged(Schedule& schedule, ScheduleSegment segment);

/// Every different configuration of a schedule, in order of appearance.
std::vector<compute::Configuration> configurations_of(const Schedule& schedule);

/// The schedule when its phases, none of which may be planned to take 0 s, take other durations: each segment
/// keeps its part of the phase.
Schedule rescale_to_flown_durations(Schedule schedule, const PerPhase<double>& planned_s,
                                    const PerPhase<double>& flown_s);

}  // namespace flightwatt::mission
