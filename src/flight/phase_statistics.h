#pragma once

#include "flight/flight_series.h"
#include "flight/segmentation.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// What was measured between two times.
struct PhaseStatistics {
    std::size_t samples = 0;                  ///< power samples in [start, end]
    double mean_power_w = 0.0;                ///< of these samples; 0 without any
    double energy_wh = 0.0;                   ///< integral of the power, linear between samples
    std::optional<double> counter_energy_wh;  ///< what the on-board counter counted meanwhile
    std::size_t gaps = 0;                     ///< times without a sample, longer than three usual intervals
    double longest_gap_s = 0.0;
};

/// Statistics of [start_s, end_s].
PhaseStatistics phase_statistics(const FlightSeries& series, double start_s, double end_s);

/// Energy [Wh] of the series' power between two times: trapezoids, the ends interpolated.
double integrated_energy_wh(const FlightSeries& series, double start_s, double end_s);

/// Integral of any channel over time between two times, linear between samples [channel * s].
double integrated(const std::vector<double>& time_s, const std::vector<double>& values, double start_s,
                  double end_s);

/// A longer interval without a power sample is a gap: three usual ones [s].
double gap_threshold_s(const std::vector<double>& time_s);

/// Median interval of the power samples [s].
double usual_interval_s(const std::vector<double>& time_s);

/// The phases CSV: sortie, phase, start_s, end_s, duration_s, samples, mean_power_w, energy_wh, ... and the
/// evidence at both edges; a witness that is absent leaves its cell empty.
std::string phases_csv(const FlightSeries& series, const FlightPhases& phases);

}  // namespace flightwatt::flight
