#pragma once

#include "mechanical/mechanical_model.h"
#include "mechanical/phase_samples.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// A frequency and an autocorrelation that the samples allow, and the flights' weighted mean curve if they are true:
/// Student t about the coefficients of generalised least squares.
struct PosteriorNode {
    double theta_rad = 0.0;
    double autocorrelation = 0.0;
    double weight = 0.0;           ///< the nodes' sum is 1
    Eigen::VectorXd coefficients;  ///< in the samples' unit
    Eigen::MatrixXd scale;         ///< of their Student t, squared
    double degrees_of_freedom = 0.0;
};

/// All that the samples tell of a phase's frequency, its noise and its mean curve (docs/methods.md, Eq. 13).
struct FrequencyPosterior {
    std::vector<PosteriorNode> nodes;  ///< by frequency, rising; those without weight left out
    double max_autocorrelation = 0.0;  ///< that was looked at
    bool is_open_below = false;        ///< the density at the bound of the range is more than a tenth of its peak
    bool is_open_above = false;
};

/// What is integrated over.
struct PosteriorOptions {
    int order = 3;
    FrequencyRange range;
    double least_squares_rad = 0.0;  ///< of least squares: one place where the density is looked for
};

/// The highest autocorrelation of neighbours that is looked at: noise that lasts a fifth of the phase, from 0.9 (9.5
/// samples) to 0.99. Longer noise is no noise but part of the curve.
double autocorrelation_limit(std::span<const ScaledSamples> flights);

/// Integrates over theta in the range and r in [0, highest]: density ~ 1 / theta^2 times the restricted likelihood of
/// each flight (restricted_likelihood; each has a noise variance of its own, theta and r are common). Theta is looked
/// for where the scan's sum of squares is not hopeless. Order 0 has no frequency: one theta. `weights` are the
/// flights' in the mean curve. Throws NoResultError if the samples determine no series.
FrequencyPosterior frequency_posterior(std::span<const ScaledSamples> flights, std::span<const double> weights,
                                       const PosteriorOptions& options);

/// Whether the noise most likely lasts as long as was looked at: then noise and curve are not told apart, and what the
/// posterior says of the frequency and of errors is no more than a bound.
bool is_autocorrelation_at_limit(const FrequencyPosterior& posterior);

/// The 95 % interval of theta.
Interval frequency_interval(const FrequencyPosterior& posterior);

}  // namespace flightwatt::mechanical
