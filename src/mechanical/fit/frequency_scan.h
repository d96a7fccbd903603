#pragma once

#include "mechanical/fit/phase_samples.h"
#include "mechanical/mechanical_model.h"

#include <span>
#include <vector>

namespace flightwatt::mechanical {

/// What one flight contributes to a scan: its least sum of squares at every theta.
struct FlightScan {
    int order = 0;
    double step_rad = 0.0;
    std::size_t first = 0;  ///< the lowest theta, in steps
    std::vector<double> square_sum;
};

/// The one that is known, if it is of this order and range; else it is made.
FlightScan scan_flight(const ScaledSamples& samples, int order, const FrequencyRange& range);

/// The flights' common residual sum of squares over theta = omega * duration, each flight with its own best
/// coefficients at every theta.
struct FrequencyScan {
    std::vector<double> theta_rad;  ///< evenly spaced; the last is the range's high end
    std::vector<double> square_sum;
    double step_rad = 0.0;
};

/// Spacing of the scan: the highest harmonic turns by at most 1 rad over the phase from one theta to the next; a whole
/// number of steps reaches the range's high end.
double frequency_scan_step(const FrequencyRange& range, int order);

/// Scans the whole range, finely enough that the highest harmonic turns by at most 1 rad over the phase from
/// one theta to the next, so that no minimum falls between two of them. Flights are
/// scanned on all cores.
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

}  // namespace flightwatt::mechanical
