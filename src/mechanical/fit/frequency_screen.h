#pragma once

#include "mechanical/fit/phase_samples.h"
#include "mechanical/mechanical_model.h"

#include <span>
#include <vector>

namespace flightwatt::mechanical {

/// The autocorrelations that stand for all in a screen, from 0 to `highest`.
std::vector<double> coarse_autocorrelations(double highest);

/// The frequencies of the scan that noise of some autocorrelation up to `highest` does not rule out beside `found_rad`,
/// rising, and between them the lowest ones whatever they are. Their likelihood is told from the scan's sum of squares
/// and the periodogram of the residuals at `found_rad`, each harmonic's part weighed by the spectrum of the noise
/// (Whittle 1953): operations a frequency do not grow with the samples. On the generous side: what is kept is to be
/// computed. `flights` rise in time.
std::vector<double> promising_frequencies(std::span<const ScaledSamples> flights, int order,
                                          const FrequencyRange& range, double found_rad, double highest);

}  // namespace flightwatt::mechanical
