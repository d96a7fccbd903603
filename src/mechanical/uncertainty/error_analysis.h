#pragma once

#include "mechanical/fit/phase_fit.h"

#include <span>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// The uncertainty of a phase's weighted mean curve that comes from the noise of the samples.
struct ErrorAnalysis {
    PhaseErrors errors;
    double theta_rad = 0.0;
    Eigen::VectorXd coefficients_w;  ///< of the mean curve: a0, a1, b1, ...
    Eigen::MatrixXd covariance;      ///< of theta and the coefficients, theta first
    /// The standard error of theta were it free, also where it stands at a bound; 0 if the data do not show it.
    double free_theta_rad = 0.0;
    double theta_information = 0.0;  ///< half the curvature of the sum of squares over theta [W^2/rad^2]
};

/// Linearised error propagation through the joint least squares of all flights, with noise that is correlated
/// (residual_correlation.h) and has a variance of its own in each flight: every estimate is a linear function of the
/// noise, whose covariance is carried through it (docs/methods.md, Eq. 13). Where theta stands at a bound it is taken
/// as given. Where the autocorrelation stands at its bound, the flights' own differences are taken instead if they tell
/// less (PhaseErrors::from_flights). After a robust fit the residuals are Huber's pseudo-residuals, psi / mean psi'.
/// `flights`, `fit` and `weights` are in the same order; their samples are those that were fitted.
ErrorAnalysis analyse_errors(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                             std::span<const double> weights);

/// The standard error [W] of the mean curve at tau in [0, 1] of the phase.
double curve_standard_error_w(const ErrorAnalysis& analysis, double tau);

}  // namespace flightwatt::mechanical
