#include "mission/disturbance.h"

namespace flightwatt::mission {

battery::Battery disturbed(battery::Battery battery, const std::vector<Disturbance>& disturbances) {
    for (const auto& disturbance : disturbances) {
        battery.capacity_ah *= disturbance.capacity_factor;
        battery.resistance_ohm *= disturbance.resistance_factor;
        if (battery.thevenin) battery.thevenin->rc_resistance_ohm *= disturbance.resistance_factor;
    }
    return battery;
}

std::vector<Disturbance> rescale_to_flown_durations(std::vector<Disturbance> disturbances,
                                                    const flight::PerPhase<double>& planned_s,
                                                    const flight::PerPhase<double>& flown_s) {
    for (auto& disturbance : disturbances) {
        disturbance.start_s = rescale_to_flown_durations_s(disturbance.start_s, planned_s, flown_s);
        disturbance.end_s = rescale_to_flown_durations_s(disturbance.end_s, planned_s, flown_s);
    }
    return disturbances;
}

}  // namespace flightwatt::mission
