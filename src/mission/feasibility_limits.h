#pragma once

#include "mission/mission.h"

#include <functional>
#include <optional>

namespace flightwatt::mission {

/// The mission as it is with a cruise of so many seconds. May throw InputError where its schedule does not
/// fit.
using MissionOfCruise = std::function<Mission(double cruise_s)>;

/// The most of something with which a mission still lands with its reserve.
struct MostThatLands {
    double value = 0.0;
    double final_soc_percent = 0.0;  ///< then, simulated
    double residual_percent = 0.0;   ///< that, less the reserve
    /// Beyond, the battery could not deliver the power, whatever its charge.
    bool power_is_the_limit = false;
    bool cut_off_is_the_limit = false;  ///< beyond, its voltage would fall below the cut-off
};

/// The longest cruise [s] with the mission's schedule, or if it is yet to be planned with the one that drains
/// least. Throws NoAnswerError if no cruise that the schedule fits into is short enough, or none is too long.
MostThatLands longest_cruise(const MissionOfCruise& mission_of);

/// The greatest constant power [W] that the mission can feed besides, all the way. Throws NoAnswerError if it
/// does not land with its reserve as it is.
MostThatLands largest_payload(const Mission& mission);

/// The mission, with the schedule that drains least if it has none, and a constant load besides.
Mission with_payload(const Mission& mission, double payload_w);

/// The least capacity [Ah] with which the mission lands with its reserve, its battery otherwise as it is,
/// with the mission's own schedule or the one that drains least. None if no capacity is enough.
std::optional<double> least_capacity_ah(const Mission& mission);

/// State of charge at the end less the reserve [points]: by tables where they hold, else simulated. Negative
/// if the reserve is not kept, and the more so the earlier the battery ends.
double spare_percent(const Mission& mission);

}  // namespace flightwatt::mission
