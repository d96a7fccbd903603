#pragma once

#include "mechanical/fit_records.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/phase_samples.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// The thetas of a scan, in steps. The highest harmonic's phase differs by at most 1 rad between two of them, so that
/// no minimum is missed; a whole number of steps is the range's high end.
struct ScanGrid {
    int order = 0;
    double step_rad = 0.0;
    std::size_t first = 0;
    std::size_t last = 0;
    bool operator==(const ScanGrid&) const = default;
    std::size_t size() const { return last - first + 1; }
    double theta_rad(std::size_t i) const { return static_cast<double>(first + i) * step_rad; }
};
ScanGrid scan_grid(const FrequencyRange& range, int order);

/// The residual sum of squares over theta = omega * duration, with the best coefficients at every theta.
struct FrequencyScan {
    ScanGrid grid;
    std::vector<double> square_sum;
};

/// The flight's stored scan if it has this order and range; else a new one. Power is less its mean.
FrequencyScan scan_flight(const PhaseSamples& samples, int order, const FrequencyRange& range);

/// The sum of the flights' scans, flights on all cores.
FrequencyScan scan_frequencies(std::span<const PhaseSamples> flights, int order, const FrequencyRange& range);

/// The frequency [rad per phase] that the flights have in common: the lowest minimum of the scan, refined,
/// unless it is the subharmonic of a simpler answer (see resolve_subharmonic).
double find_frequency(std::span<const PhaseSamples> flights, int order, const FrequencyRange& range,
                      const FrequencyScan& scan);

/// A series of order p at theta contains the series of order p/m at m theta, so theta/2 and theta/3 fit a signal with
/// weak harmonics as well. Returns m * theta_rad, refined, for the largest m in 2..order at which the lost harmonics
/// are insignificant (F test at 0.1 %) and explain, less the expected noise, below 2 % of the series' power (which
/// keeps trends of less than a period); else theta_rad.
double resolve_subharmonic(std::span<const PhaseSamples> flights, int order, const FrequencyRange& range,
                           const FrequencyScan& scan, double theta_rad);

/// The frequency all flights share and each flight's own coefficients.
struct JointFit {
    double theta_rad = 0.0;
    std::vector<Eigen::VectorXd> coefficients;  ///< a0, a1, b1, ... of each flight
    std::vector<double> square_sum;             ///< of each flight's residuals
};

/// Each flight's least squares at one frequency. Throws NoResultError if a flight's samples do not determine its
/// coefficients.
JointFit fit_at_frequency(std::span<const PhaseSamples> flights, int order, double theta_rad);

}  // namespace flightwatt::mechanical
