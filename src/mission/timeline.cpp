#include "mission/timeline.h"

namespace flightwatt::mission {

MissionTimeline timeline_of(const flight::PerPhase<double>& duration_s) {
    MissionTimeline timeline;
    for (const auto phase : flight::all_phases) {
        timeline.start_s[phase] = timeline.duration_s;
        timeline.duration_s += duration_s[phase];
        timeline.end_s[phase] = timeline.duration_s;
    }
    return timeline;
}

double rescale_to_flown_durations_s(double time_s, const flight::PerPhase<double>& planned_s,
                                    const flight::PerPhase<double>& flown_s) {
    const auto planned = timeline_of(planned_s);
    const auto flown = timeline_of(flown_s);
    for (const auto phase : flight::all_phases) {
        const double in_phase_s = time_s - planned.start_s[phase];
        if (in_phase_s < planned_s[phase])
            return flown.start_s[phase] + in_phase_s * (flown_s[phase] / planned_s[phase]);
    }
    return flown.duration_s + (time_s - planned.duration_s);
}

}  // namespace flightwatt::mission
