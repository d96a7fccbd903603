#pragma once

#include "mechanical/fit/least_squares.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/phase_samples.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// One flight's curve at a frequency and an autocorrelation: Student t about the coefficients of generalised least
/// squares.
struct FlightCurvePosterior {
    Eigen::VectorXd coefficients;  ///< in the samples' unit
    Eigen::MatrixXd scale;         ///< of their Student t, squared
    double degrees_of_freedom = 0.0;
};

/// A frequency and an autocorrelation that the samples allow, and the curves if they are true.
struct QuadratureNode {
    double theta_rad = 0.0;
    double autocorrelation = 0.0;
    double weight = 0.0;          ///< the nodes' sum is 1
    double log_likelihood = 0.0;  ///< of both, less the greatest
    std::vector<FlightCurvePosterior> flights = {};
};

/// All that the samples tell of a phase's frequency, its noise and its curve (docs/methods.md, Eq. 13).
struct FrequencyPosterior {
    std::vector<QuadratureNode> nodes;  ///< by frequency, rising; those without weight left out
    double max_autocorrelation = 0.0;   ///< that was looked at
    std::vector<double> theta_rad;      ///< the marginal density of the frequency at places that resolve it
    std::vector<double> density;
};

/// What is integrated over.
struct PosteriorOptions {
    int order = 3;
    FrequencyRange range;
    double least_squares_rad = 0.0;       ///< of least squares: one place where the density is looked for
    const FrequencyScan* scan = nullptr;  ///< of the flights, if it is known
};

/// The highest autocorrelation of neighbours that is looked at: noise that lasts a fifth of the phase, from 0.9 (9.5
/// samples) to 0.99. Longer noise is no noise but part of the curve.
double autocorrelation_limit(std::span<const ScaledSamples> flights);

/// Integrates over theta in the range and r in [0, highest]: density ~ 1 / theta^2 times the restricted likelihood of
/// each flight (restricted_likelihood; each has a noise variance of its own, theta and r are common). Theta is first
/// screened (candidate_frequencies), then nodes are put where the density is. Order 0 has no frequency: one theta.
/// Throws NoResultError if the samples determine no series at any frequency.
FrequencyPosterior frequency_posterior(std::span<const ScaledSamples> flights, const PosteriorOptions& options);

/// The flights' weighted mean at one node: Student t as well, its degrees of freedom Satterthwaite's for the curve.
struct MeanCurveNode {
    double theta_rad = 0.0;
    double autocorrelation = 0.0;
    double weight = 0.0;
    double log_likelihood = 0.0;
    Eigen::VectorXd coefficients;
    Eigen::MatrixXd scale;
    double degrees_of_freedom = 0.0;
};

/// `weights` are the flights', in their order.
std::vector<MeanCurveNode> mean_curve_nodes(const FrequencyPosterior& posterior, std::span<const double> weights);

/// Whether the noise most likely lasts as long as was looked at: then noise and curve are not told apart, and what the
/// posterior says of the frequency and of errors is no more than a bound.
bool is_autocorrelation_at_limit(const FrequencyPosterior& posterior);

/// The 95 % interval of theta.
Interval frequency_interval(const FrequencyPosterior& posterior);

/// The same samples in the order of time.
ScaledSamples sort_by_time(const ScaledSamples& samples);

}  // namespace flightwatt::mechanical
