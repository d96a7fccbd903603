#pragma once

#include "mechanical/fit/frequency_posterior.h"
#include "mechanical/fit/phase_fit.h"
#include "mechanical/uncertainty/student_mixture.h"

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// The uncertainty of a phase's weighted mean curve that comes from the noise of the samples.
struct ErrorAnalysis {
    PhaseErrors errors;
    double theta_rad = 0.0;
    Eigen::VectorXd coefficients_w;  ///< of the mean curve: a0, a1, b1, ...
    std::shared_ptr<const FrequencyPosterior> posterior;
    std::vector<MeanCurveNode> nodes;  ///< its weighted mean of the flights
};

/// Integrates over the frequency and the autocorrelation of the noise (frequency_posterior.h): the mean curve and its
/// coefficients are mixtures of Student distributions (docs/methods.md, Eqs. 12 to 14). After a robust fit the samples
/// are the curve with Huber's pseudo-residuals, psi / mean psi'. `flights`, `fit` and `weights` are in the same order;
/// their samples are those that were fitted. Throws NoResultError for samples that do not determine the errors.
ErrorAnalysis analyse_errors(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                             std::span<const double> weights);

/// The standard deviation [W] of the mean curve at tau in [0, 1] of the phase.
double curve_standard_error_w(const ErrorAnalysis& analysis, double tau);

/// Many times of the same analysis: the mean curve's 95 % intervals [W], each with the fitted curve inside.
std::vector<Interval> curve_intervals_w(const ErrorAnalysis& analysis, std::span<const double> tau);

}  // namespace flightwatt::mechanical
