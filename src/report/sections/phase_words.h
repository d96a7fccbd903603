#pragma once

#include "flight/flight_phases.h"

#include <string_view>

namespace flightwatt::report {

/// "take-off", "cruise", "landing": as people write them.
constexpr std::string_view phase_word(flight::Phase phase) {
    return phase == flight::Phase::takeoff ? std::string_view("take-off") : to_string(phase);
}

}  // namespace flightwatt::report
