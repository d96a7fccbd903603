#include "mission/mission_utility.h"

#include <algorithm>

namespace flightwatt::mission {

std::optional<double> mean_worth(const Mission& mission, double until_s) {
    const auto& utilities = mission.utilities;
    if (std::none_of(utilities.begin(), utilities.end(), [](const auto& u) { return u.has_value(); })) {
        return std::nullopt;
    }
    flight::PerPhase<double> begins_s;
    double duration_s = 0.0;
    for (const auto phase : flight::all_phases) {
        begins_s[phase] = duration_s;
        duration_s += mission.duration_s[phase];
    }
    double sum = 0.0;
    for (const auto& stretch : mission.schedule) {
        const double begin_s = begins_s[stretch.phase];
        const double runs_s = std::min(begin_s + stretch.to_s, until_s) - (begin_s + stretch.from_s);
        if (runs_s > 0.0) sum += worth(utilities, stretch.run) * runs_s;
    }
    return sum / duration_s;
}

}  // namespace flightwatt::mission
