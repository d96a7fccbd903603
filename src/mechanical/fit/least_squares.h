#pragma once

#include "mechanical/fit_records.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/phase_samples.h"

#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// What one flight contributes to a scan: its least sum of squares at every theta.
struct FlightScan {
    int order = 0;
    double step_rad = 0.0;
    std::size_t first = 0;  ///< the lowest theta, in steps
    std::vector<double> square_sum;
};

/// The flight's own if it is of this order and range; else it is made.
FlightScan scan_flight(const ScaledSamples& samples, int order, const FrequencyRange& range);

/// The flights' common residual sum of squares over theta = omega * duration, each flight with its own best
/// coefficients at every theta.
struct FrequencyScan {
    std::vector<double> theta_rad;  ///< evenly spaced; the last is the range's high end
    std::vector<double> square_sum;
    double step_rad = 0.0;
};

/// The thetas of a scan, in steps: the highest harmonic turns by at most 1 rad over the phase from one to the next, so
/// that no minimum is between two; a whole number of steps reaches the range's high end.
struct ScanGrid {
    double step_rad = 0.0;
    std::size_t first = 0;
    std::size_t last = 0;
};
ScanGrid scan_grid(const FrequencyRange& range, int order);

/// Scans the whole range, flights on all cores.
FrequencyScan scan_frequencies(std::span<const ScaledSamples> flights, int order, const FrequencyRange& range);

/// The frequency [rad per phase] that the flights have in common: the lowest minimum of the scan, refined,
/// unless it is the subharmonic of a simpler answer (see resolve_subharmonic).
double find_frequency(std::span<const ScaledSamples> flights, int order, const FrequencyRange& range,
                      const FrequencyScan& scan);

/// A series of order p at theta holds the series of order p/m at m theta, so a signal whose harmonics are weak is
/// fitted as well by theta/2 and theta/3. Returns m * theta_rad, refined, for the largest m in 2..order at which
/// the harmonics that get lost are both insignificant (F test at 0.1 %) and, less what noise would give them,
/// below 2 % of what the series explains (which keeps trends of less than a period); else theta_rad itself.
double resolve_subharmonic(std::span<const ScaledSamples> flights, int order, const FrequencyRange& range,
                           double theta_rad);

/// The frequency all flights share and each flight's own coefficients.
struct JointFit {
    double theta_rad = 0.0;
    std::vector<Eigen::VectorXd> coefficients;  ///< a0, a1, b1, ... a flight, in scaled values
    std::vector<double> square_sum;             ///< a flight, of the plain residuals
};

/// Each flight's least squares at one frequency. Throws NoResultError if a flight's samples do not determine its
/// coefficients.
JointFit fit_at_frequency(std::span<const ScaledSamples> flights, int order, double theta_rad);

/// The sum of squares of the residuals' slopes over theta, all coefficients following (variable projection).
double frequency_information(std::span<const ScaledSamples> flights, const JointFit& fit);

/// Levenberg and Marquardt's method over theta with variable projection, from `start_rad`, within the range: the least
/// common sum of squares near where the search began. Throws what fit_at_frequency throws.
JointFit refine_jointly(std::span<const ScaledSamples> flights, int order, const FrequencyRange& range,
                        double start_rad);

}  // namespace flightwatt::mechanical
