#pragma once

#include "mechanical/mechanical_model.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace flightwatt::synthetic {

/// Half width [W] of the band in which flights differ, at tau in [0, 1] of a phase: the grey bands of Fig. 2
/// as the paper describes them (they were not digitised). Take-off varies at its beginning and hardly at its
/// end, cruise little, landing most at its beginning and end.
double band_w(flight::Phase phase, double tau);

/// How synthetic flights differ from the model and from each other.
struct SpreadOptions {
    double band_scale = 1.0;        ///< standard deviation of a flight, in half widths of the band
    double duration_spread = 0.06;  ///< durations are uniform within +- this part of the model's
};

/// Draws `count` flights about a model: each phase of each is a Fourier series of the model's own frequency
/// (the assumption of Eqs. 5-7) that lies in the band, with its own duration. Flights come in opposite pairs
/// (an odd one out is the model itself), so that the mean of all, and of any weights that treat a pair alike,
/// is the model. The same seed gives the same flights.
std::vector<flight::PerPhase<mechanical::PhaseModel>> draw_flights(const mechanical::MechanicalModel& model,
                                                                   std::size_t count, std::uint64_t seed,
                                                                   const SpreadOptions& options = {});

}  // namespace flightwatt::synthetic
