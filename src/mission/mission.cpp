#include "mission/mission.h"

#include <algorithm>

namespace flightwatt::mission {

const MissionSetup& setup_of(const AnyMission& mission) {
    return std::visit([](const MissionSetup& setup) -> const MissionSetup& { return setup; }, mission);
}

std::optional<double> mean_utility(const MissionSetup& mission, const std::vector<ScheduleSegment>& schedule,
                                   double until_s) {
    const auto& utilities = mission.utilities;
    if (std::none_of(utilities.begin(), utilities.end(), [](const auto& u) { return u.has_value(); })) {
        return std::nullopt;
    }
    const auto timeline = timeline_of(mission.duration_s);
    double sum = 0.0;
    for (const auto& segment : schedule) {
        const double phase_start_s = timeline.start_s[segment.phase];
        const double runs_s =
            std::min(phase_start_s + segment.end_s, until_s) - (phase_start_s + segment.start_s);
        if (runs_s > 0.0) sum += utility_per_s(utilities, segment.run) * runs_s;
    }
    return sum / timeline.duration_s;
}

}  // namespace flightwatt::mission
