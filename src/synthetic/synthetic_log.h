#pragma once

#include "synthetic/synthetic_flight.h"

#include <cstdint>
#include <string>

namespace flightwatt::synthetic {

struct SyntheticSensors {
    double current_noise_a = 0.001;  ///< standard deviation; 0.02 on the real aircraft of 2020
    double current_step_a = 0.001;   ///< resolution
    double idle_current_a = 0.03;    ///< reading with the motor off
    double altitude_noise_m = 0.12;
    bool sends_other_messages = true;  ///< messages that are not required for flights, as in real logs
    double lost_fraction = 0.10;       ///< of all lines, half of them in bursts
    double pack_capacity_ah = 3.2;
    double pack_resistance_ohm = 0.06;
};

/// A log in Paparazzi's format.
struct SyntheticLog {
    std::string data;
    std::string log;
};

/// Simulates sensors and a lossy link. `name`: of the files, without ending; `made_by` is written into both files,
/// which are marked as synthetic. The same seed gives the same log.
SyntheticLog make_synthetic_log(const SyntheticScenario& scenario, const SyntheticSensors& sensors,
                                const std::string& name, const std::string& made_by, std::uint64_t seed);

}  // namespace flightwatt::synthetic
