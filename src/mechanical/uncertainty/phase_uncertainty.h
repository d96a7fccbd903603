#pragma once

#include <cstddef>
#include <vector>

namespace flightwatt::mechanical {

/// How well the noise of the samples lets a phase's averaged coefficients be known: standard errors of the
/// weighted mean of these very flights, weights and durations taken as given. How flights differ is another
/// question: see PhaseSpread.
struct PhaseErrors {
    double omega_rad_per_s = 0.0;  ///< 0 if the frequency stands at a bound
    double a0_w = 0.0;
    std::vector<double> cos_w;
    std::vector<double> sin_w;
    double curve_w = 0.0;             ///< root mean square over the phase of the curve's own standard error
    double degrees_of_freedom = 0.0;  ///< of the Student's t that makes 95 % intervals of them
    /// The errors hold for the frequency as given: it stands at a bound, or the data do not show it.
    bool frequency_is_given = false;
    double r2 = 0.0;                 ///< of all samples about their own flights' curves and means
    double condition = 0.0;          ///< of the basis on the samples, columns of length 1; the worst flight's
    double autocorrelation = 0.0;    ///< of the noise of samples one median gap apart
    double effective_samples = 0.0;  ///< independent samples that would tell the mean as well
};

/// How the flights' own curves differ over the phase, at evenly spread parts of it from begin to end.
struct PhaseSpread {
    std::vector<double> low_w;   ///< the least of the flights that count (the paper's grey band)
    std::vector<double> high_w;  ///< the greatest of them
    std::vector<double> standard_deviation_w;  ///< of one flight about the weighted mean
    double counted_flights = 0.0;              ///< 1 / sum of squared weights: equal flights worth as much
};

}  // namespace flightwatt::mechanical
