#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// How alike the noise of samples is: r^(|tau_j - tau_k| / step), where r is the autocorrelation of samples
/// one step apart. A gap is thus what it is, time for the noise to be forgotten.
struct SampleCorrelation {
    std::vector<double> decay;  ///< between sample j - 1 and j; the first is 0
};

/// `tau` must rise (equal times are allowed); step > 0; r in [0, 1).
SampleCorrelation sample_correlation(std::span<const double> tau, double step, double autocorrelation);

/// The correlation matrix times `rows` (one row a sample), in one pass forth and one back.
Eigen::MatrixXd correlated(const SampleCorrelation& correlation, const Eigen::MatrixXd& rows);

/// How many independent samples tell the mean as well as these: n^2 over the sum of all correlations. Without
/// gaps and for many samples that is n (1 - r) / (1 + r).
double effective_samples(const SampleCorrelation& correlation);

/// One flight's residuals and what the fit has taken out of them.
struct FlightResiduals {
    std::vector<double> tau;  ///< rising
    double step = 0.0;        ///< the median gap
    Eigen::VectorXd residual_w;
    /// The directions that the fit used up: orthonormal columns; the one that several flights share (their
    /// frequency) is scaled by the root of this flight's part in it.
    Eigen::MatrixXd used_up;
};

/// The autocorrelation r of the noise one step apart, common to the flights, in [0, 0.99]. Residuals of a fit
/// are less correlated than the noise was, and look anticorrelated if samples are few; therefore r is
/// sought at which the correlation of the residuals is what is expected of them: the moments of M R M, M the
/// residual projector and R the correlation of the noise. Neighbours further apart than 1.5 steps do not
/// count. Negative correlation counts as none, so no flight is worth more than its samples. A short phase
/// hardly tells: in 25 samples less 8 that the fit used up, r is within about 0.25, and if the noise really
/// is correlated its estimate is usually too low (see IntervalCoverage for what that costs).
double estimate_autocorrelation(std::span<const FlightResiduals> flights);

/// The variance of the noise and how well it is known.
struct NoiseLevel {
    double variance_w2 = 0.0;         ///< unbiased: e'e / trace(M R)
    double degrees_of_freedom = 0.0;  ///< Satterthwaite's: trace(M R)^2 / trace(M R M R), at least 1
};

NoiseLevel noise_level(const FlightResiduals& flight, double autocorrelation);

}  // namespace flightwatt::mechanical
