#pragma once

#include "mechanical/mechanical_model.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace flightwatt::synthetic {

/// Half width [W] of the band of flights at tau in [0, 1] of a phase, by the paper's description of the grey bands of
/// Fig. 2: take-off varies mostly at its beginning, cruise little, landing most at its beginning and end.
double band_w(flight::Phase phase, double tau);

struct SpreadOptions {
    double band_scale = 1.0;        ///< standard deviation between flights, in half widths of the band
    double duration_spread = 0.06;  ///< uniform within +- this fraction of the model's duration
};

/// Draws `count` flights about a model. Each phase is a Fourier series of the model's frequency (as in Eqs. 5-7) in the
/// band, with its own duration. Flights are drawn in opposite pairs (with an odd number, one is the model), so that
/// their mean is the model. The same seed gives the same flights.
std::vector<flight::PerPhase<mechanical::PhaseModel>> draw_flights(const mechanical::MechanicalModel& model,
                                                                   std::size_t count, std::uint64_t seed,
                                                                   const SpreadOptions& options = {});

}  // namespace flightwatt::synthetic
