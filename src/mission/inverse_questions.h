#pragma once

#include "mission/mission.h"

#include <functional>

namespace flightwatt {

/// The mission as it is with a cruise of so many seconds. May throw InputError where its schedule does not
/// fit.
using MissionOfCruise = std::function<Mission(double cruise_s)>;

/// The most of something with which a mission still lands with its reserve.
struct MostThatLands {
    double value = 0.0;
    double final_soc_percent = 0.0;  ///< then, simulated
    double residual_percent = 0.0;   ///< that, less the reserve
    bool power_is_the_limit =
        false;  ///< beyond, the battery could not deliver the power, whatever its charge
};

/// The longest cruise [s] with the mission's schedule, or if it is yet to be planned with the one that drains
/// least. Throws NoAnswerError if no cruise that the schedule fits into is short enough, or none is too long.
MostThatLands longest_cruise(const MissionOfCruise& mission_of);

/// The greatest constant power [W] that the mission can feed besides, all the way. Throws NoAnswerError if it
/// does not land with its reserve as it is.
MostThatLands largest_payload(const Mission& mission);

/// The mission, with the schedule that drains least if it has none, and a constant load besides.
Mission with_payload(const Mission& mission, double payload_w);

/// State of charge at the end less the reserve [points]: by tables where they hold, else simulated. Negative
/// if the reserve is not kept, and the more so the earlier the battery ends.
double spare_percent(const Mission& mission);

}  // namespace flightwatt
