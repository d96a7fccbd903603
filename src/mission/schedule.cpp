#include "mission/schedule.h"

#include <algorithm>

namespace flightwatt::mission {

MissionTimeline timeline_of(const PerPhase<double>& duration_s) {
    MissionTimeline timeline;
    for (const auto phase : all_phases) {
        timeline.start_s[phase] = timeline.duration_s;
        timeline.duration_s += duration_s[phase];
        timeline.end_s[phase] = timeline.duration_s;
    }
    return timeline;
}

double rescale_to_flown_durations_s(double time_s, const PerPhase<double>& planned_s, const PerPhase<double>& flown_s) {
    const auto planned = timeline_of(planned_s);
    const auto flown = timeline_of(flown_s);
    for (const auto phase : all_phases) {
        const double in_phase_s = time_s - planned.start_s[phase];
        if (in_phase_s < planned_s[phase])
            return flown.start_s[phase] + in_phase_s * (flown_s[phase] / planned_s[phase]);
    }
    return flown.duration_s + (time_s - planned.duration_s);
}

void append_merged(Schedule& schedule, ScheduleSegment segment) {
    if (!schedule.empty() && schedule.back().phase == segment.phase && schedule.back().run == segment.run)
        schedule.back().end_s = segment.end_s;
    else
        schedule.push_back(std::move(segment));
}

std::vector<compute::Configuration> configurations_of(const Schedule& schedule) {
    std::vector<compute::Configuration> found;
    for (const auto& segment : schedule)
        if (std::ranges::find(found, segment.run) == found.end()) found.push_back(segment.run);
    return found;
}

Schedule rescale_to_flown_durations(Schedule schedule, const PerPhase<double>& planned_s,
                                    const PerPhase<double>& flown_s) {
    for (auto& segment : schedule) {
        const double planned = planned_s[segment.phase];
        const double flown = flown_s[segment.phase];
        segment.start_s = segment.start_s / planned * flown;
        segment.end_s = segment.end_s == planned ? flown : segment.end_s / planned * flown;
    }
    return schedule;
}

}  // namespace flightwatt::mission
