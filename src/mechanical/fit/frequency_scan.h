#pragma once

#include "mechanical/fit_records.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/phase_samples.h"

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace flightwatt::mechanical {

/// The phase of the highest harmonic [rad] between two thetas of a scan, so that no minimum is missed.
inline constexpr double turn_between_rad = 1.0;

/// The thetas of a scan, in steps; a whole number of steps is the range's high end.
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

/// Returns the flight's stored scan if it has this order and range; else a new one. Power is less its mean.
FrequencyScan scan_flight(const PhaseSamples& samples, int order, const FrequencyRange& range);

/// Returns the sum of the flights' scans, which are made on all cores.
FrequencyScan scan_frequencies(std::span<const PhaseSamples> flights, int order, const FrequencyRange& range);

/// A theta with its residual sum of squares.
struct Candidate {
    double theta_rad = 0.0;
    double square_sum = std::numeric_limits<double>::infinity();
};

/// Returns the scan's local minima, its ends included, lowest first.
std::vector<Candidate> minima(const FrequencyScan& scan);

/// Returns where the scan is lowest between two thetas; its sum is infinite if it has none there.
Candidate lowest_between(const FrequencyScan& scan, double low_rad, double high_rad);

}  // namespace flightwatt::mechanical
