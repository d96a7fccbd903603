#pragma once

#include "flight/flight_phases.h"

#include <string_view>

namespace flightwatt {

/// "take-off", "cruise", "landing": as people write them.
constexpr std::string_view phase_word(Phase phase) {
    return phase == Phase::takeoff ? std::string_view("take-off") : to_string(phase);
}

}  // namespace flightwatt
