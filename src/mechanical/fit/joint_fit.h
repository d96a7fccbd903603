#pragma once

#include "mechanical/fit/frequency_scan.h"
#include "mechanical/fit_records.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/phase_samples.h"

#include <span>
#include <vector>

#include <Eigen/Core>

/// The nonlinear least squares of Eq. 1: one theta = omega * duration [rad] of all flights, and coefficients of each. The
/// samples' power is less its flight's mean.
namespace flightwatt::mechanical {

/// Returns the theta that the flights have in common: the least squares from the lowest minima of the scan, unless it is
/// the subharmonic of a simpler one (resolve_subharmonic).
double find_frequency(std::span<const PhaseSamples> flights, int order, const FrequencyRange& range,
                      const FrequencyScan& scan);

/// A series of order p at theta contains the series of order p/m at m theta, so theta/2 and theta/3 fit a signal with
/// weak harmonics as well. Returns the least squares near m theta, for the largest m in 2..order at which the lost
/// harmonics are insignificant (F test at 0.1 %) and explain, less the expected noise, below 2 % of the series' power
/// (which keeps trends of less than a period); else the given theta.
double resolve_subharmonic(std::span<const PhaseSamples> flights, int order, const FrequencyRange& range,
                           const FrequencyScan& scan, const Candidate& found);

/// The frequency all flights share and each flight's own coefficients.
struct JointFit {
    double theta_rad = 0.0;
    std::vector<Eigen::VectorXd> coefficients;  ///< a0, a1, b1, ... of each flight
    std::vector<double> square_sum;             ///< of each flight's residuals
};

/// Returns each flight's linear least squares at one theta. Throws NoResultError if a flight's samples do not determine
/// its coefficients.
JointFit fit_at_frequency(std::span<const PhaseSamples> flights, int order, double theta_rad);

}  // namespace flightwatt::mechanical
