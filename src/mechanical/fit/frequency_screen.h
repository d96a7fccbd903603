#pragma once

#include "mechanical/fit/frequency_scan.h"
#include "mechanical/fit/phase_samples.h"
#include "mechanical/mechanical_model.h"

#include <span>
#include <vector>

namespace flightwatt::mechanical {

/// The autocorrelations that stand for all in a screen, from 0 to `highest`.
std::vector<double> coarse_autocorrelations(double highest);

/// The frequencies of the scan that noise of some autocorrelation up to `highest` does not rule out beside
/// `least_squares_rad`, rising, and between them the lowest ones whatever they are. Their likelihood is told from the
/// scan's sum of squares and the periodogram of the residuals at `least_squares_rad`, each harmonic's part weighed by
/// the spectrum of the noise (Whittle 1953): operations a frequency do not grow with the samples. On the generous side:
/// what is kept is to be computed. `flights` rise in time.
std::vector<double> candidate_frequencies(std::span<const ScaledSamples> flights, int order,
                                          const FrequencyRange& range, double found_rad, double highest);

/// Whether least squares alone tells that there is one frequency: no flight has fewer than 100 samples, or there are 30
/// flights and more; residuals of neighbours are correlated by at most 0.5 (in 30 flights together 0.8); and the
/// likelihood, the samples counted as so many independent ones, is less by e^-25 wherever the highest harmonic turns by
/// more than 0.5 rad from that at `least_squares_rad`, which lies inside the range. Quick, and rarely so of few real
/// flights; false says nothing. `flights` rise in time; `scan` is theirs, if it is known.
bool is_frequency_determined(std::span<const ScaledSamples> flights, int order, const FrequencyRange& range,
                             double found_rad, const FrequencyScan* scan = nullptr);

}  // namespace flightwatt::mechanical
