#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flight/flight_phases.h"

namespace flightwatt {

/// How one made-up flight differs from the model, phase by phase.
struct FlightDeviation {
    PerPhase<double> level{};            ///< of the phase's band: 1 is one standard deviation
    PerPhase<double> tilt{};             ///< opposite at the phase's two ends
    PerPhase<double> duration_factor{};  ///< flown duration over the model's
};

/// Half width [W] of the band in which flights differ, at tau in [0, 1] of a phase: the grey bands of Fig. 2 as
/// the paper describes them (they were not digitised). Take-off varies at its beginning and hardly at its end,
/// cruise little, landing most at its beginning and end.
double band_w(Phase phase, double tau);

/// Draws `count` deviations that average to none, so that the flights' mean is the model: levels and tilts are
/// normal, durations uniform within +-`duration_spread`, all centred over the flights. Same seed, same draw.
std::vector<FlightDeviation> draw_deviations(std::size_t count, std::uint64_t seed, double duration_spread = 0.06);

/// The deviation's power [W] at tau.
double deviation_w(const FlightDeviation& deviation, Phase phase, double tau);

}  // namespace flightwatt
