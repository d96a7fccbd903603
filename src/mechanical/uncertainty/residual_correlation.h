#pragma once

#include "mechanical/mechanical_model.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// How alike the noise of samples is, r^(|tau_j - tau_k| / step) where r is the autocorrelation of samples one step
/// apart: that between sample j - 1 and j; the first is 0. A gap is thus what it is, time for the noise to be
/// forgotten. `tau` must rise (equal times are allowed); step > 0; r in [0, 1).
std::vector<double> sample_correlation(std::span<const double> tau, double step, double autocorrelation);

/// The correlation matrix times `rows` (one row a sample), in one pass forth and one back.
Eigen::MatrixXd correlated(std::span<const double> correlation, const Eigen::MatrixXd& rows);

/// How many independent samples tell the mean as well as these: n^2 over the sum of all correlations. Without
/// gaps and for many samples that is n (1 - r) / (1 + r).
double effective_samples(std::span<const double> correlation);

/// One flight's residuals and what the fit has taken out of them.
struct FlightResiduals {
    std::vector<double> tau;  ///< rising
    double step = 0.0;        ///< the median gap
    Eigen::VectorXd residual_w;
    /// The directions that the fit used up: orthonormal columns; the one that several flights share (their
    /// frequency) is scaled by the root of this flight's part in it.
    Eigen::MatrixXd used_up;
};

/// The autocorrelation r of the noise one step apart, common to the flights, in [0, highest_autocorrelation]: that at
/// which the correlation of the residuals is what is expected of them (docs/methods.md, Eq. 12), for residuals of a fit
/// are less correlated than the noise was. Neighbours further apart than 1.5 steps do not count, and negative
/// correlation counts as none, so no flight counts more than its samples. A short phase hardly tells: in 25 samples
/// less 8 that the fit used up, r is within about 0.25, and usually too low if the noise really is correlated. At the
/// upper end the residuals are alike for as long as the phase lasts: how long is not known.
double estimate_autocorrelation(std::span<const FlightResiduals> flights);

/// The variance of the noise, unbiased, and how well it is known (docs/methods.md, Eq. 12).
struct NoiseLevel {
    double variance_w2 = 0.0;
    double degrees_of_freedom = 0.0;  ///< Satterthwaite's, at least 1
};

NoiseLevel noise_level(const FlightResiduals& flight, double autocorrelation);

}  // namespace flightwatt::mechanical
