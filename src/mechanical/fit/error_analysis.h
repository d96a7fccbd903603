#pragma once

#include "mechanical/fit/frequency_posterior.h"
#include "mechanical/fit/student_t.h"
#include "mechanical/fit_records.h"
#include "mechanical/phase_samples.h"

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// The weighted mean curve of a phase.
struct MeanCurve {
    Eigen::VectorXd coefficients_w;  ///< a0, a1, b1, ...
    FrequencyPosterior posterior;
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

/// The profile about the frequency found, over twice the interval or as far as the range goes. The interval is that of
/// the analysis, all minima included, and holds the frequency found; it says when the data leave the frequency open. A
/// robust fit's profile is that of least squares. Order 0 and data without a frequency have an open interval and no
/// points.
FrequencyProfile frequency_profile(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                                   const ErrorAnalysis& analysis);

/// How alike the noise of samples is, r^(|tau_j - tau_k| / step) where r is the autocorrelation of samples one step
/// apart: that between sample j - 1 and j; the first is 0. A gap is thus what it is, time for the noise to be
/// forgotten. `tau` must rise (equal times are allowed); step > 0; r in [0, 1).
std::vector<double> sample_correlation(std::span<const double> tau, double step, double autocorrelation);

/// How many independent samples tell the mean as well as these: n^2 over the sum of all correlations. Without
/// gaps and for many samples that is n (1 - r) / (1 + r).
double effective_samples(std::span<const double> correlation);

}  // namespace flightwatt::mechanical
