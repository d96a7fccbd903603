#pragma once

namespace flightwatt::mission {

/// How a mission's schedule is made in flight; mission/adaptive_flight.h says what the numbers do.
struct AdaptivePolicy {
    double decide_every_s = 0.0;         ///< of each phase; a mission has it from its plan's slots by default
    double mechanical_sd_percent = 5.0;  ///< how far flights' mechanical power is expected from the model's
    double learning_time_s = 60.0;       ///< after so long, what was seen counts as much as what is expected
    double probability = 0.95;           ///< with which the reserve is to be kept, of every decision
};

}  // namespace flightwatt::mission
