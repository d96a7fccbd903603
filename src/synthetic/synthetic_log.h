#pragma once

#include "synthetic/synthetic_flight.h"

#include <cstdint>
#include <string>

namespace flightwatt::synthetic {

/// How the synthetic telemetry link and sensors behave.
struct SyntheticSensors {
    double current_noise_a = 0.001;  ///< standard deviation; 0.02 on the real aircraft of 2020
    double current_step_a = 0.001;   ///< what the current is rounded to
    double idle_current_a = 0.03;    ///< what the sensor reads with the motor off
    double altitude_noise_m = 0.12;
    bool sends_other_messages = true;  ///< beside those that flights are read from, as real aircraft do
    double lost_fraction = 0.10;       ///< of all lines, half of them in bursts
    double pack_capacity_ah = 3.2;
    double pack_resistance_ohm = 0.06;
};

/// A synthetic log as Paparazzi would have written it.
struct SyntheticLog {
    std::string data;
    std::string log;
};

/// Plays a scenario through sensors and a lossy link. `name` is the file's name without ending; `made_by`
/// stands in both files, which say that they are synthetic. The same seed gives the same log.
SyntheticLog make_synthetic_log(const SyntheticScenario& scenario, const SyntheticSensors& sensors,
                                const std::string& name, const std::string& made_by, std::uint64_t seed);

}  // namespace flightwatt::synthetic
