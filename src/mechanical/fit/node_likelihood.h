#pragma once

#include "mechanical/fit/phase_samples.h"

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// One flight's samples about its best series at one frequency.
struct FrequencyProjection {
    Eigen::MatrixXd columns;           ///< orthonormal columns of the basis and, last, the residuals
    Eigen::MatrixXd from_orthonormal;  ///< coefficients = this * coordinates
    Eigen::VectorXd coordinates;       ///< of least squares
    std::vector<double> gap;           ///< to the sample before, in median gaps; the first is 0
    double rounding = 0.0;             ///< a sum of squares below this is rounding
};

/// `samples` rise in time. std::nullopt where they do not determine a series of the order.
std::optional<FrequencyProjection> project_at_frequency(const ScaledSamples& samples, int order, double theta_rad);

/// The gaps between samples in median gaps, as noise forgets them. Samples at (almost) one time count as a quarter of a
/// gap apart: two that differ could not be, were their noise the same.
std::vector<double> normalised_gaps(const ScaledSamples& samples);

/// What one flight says of an autocorrelation r of its noise (R_jk = r^(gaps between), docs/methods.md, Eq. 13).
struct RestrictedLikelihood {
    double log_likelihood = 0.0;      ///< coefficients and the noise's variance integrated out
    double square_sum = 0.0;          ///< e'R^-1 e of generalised least squares
    double degrees_of_freedom = 0.0;  ///< samples less coefficients
    Eigen::VectorXd coordinates;      ///< generalised least squares, in the orthonormal basis
    Eigen::MatrixXd covariance;       ///< of the coordinates, for noise of variance 1
};

/// Restricted likelihood |R|^-1/2 |Q'R^-1 Q|^-1/2 SSE^(-(n - k)/2), Q the orthonormal basis: the prior of the
/// coefficients is flat on that basis, so that a frequency does not count more because its harmonics are alike.
RestrictedLikelihood restricted_likelihood(const FrequencyProjection& flight, double autocorrelation);

/// Its log_likelihood alone: most places of a search need no more.
double restricted_log_likelihood(const FrequencyProjection& flight, double autocorrelation);

/// x'R^-1 x and log |R|.
struct WhitenedSum {
    double square_sum = 0.0;
    double log_determinant = 0.0;
};
WhitenedSum whitened_sum(std::span<const double> values, const std::vector<double>& gap, double autocorrelation);

}  // namespace flightwatt::mechanical
