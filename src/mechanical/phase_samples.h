#pragma once

#include "flight/flight_phases.h"
#include "flight/flight_series.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

struct FrequencyScan;

/// Power over one phase of one flight, on that flight's own normalised time.
struct PhaseSamples {
    std::string flight;
    double duration_s = 0.0;
    std::vector<double> tau;      ///< (time - begin of phase) / duration_s, in [0, 1], rising; gaps are allowed
    std::vector<double> power_w;  ///< as long as tau
    double start_s = 0.0;         ///< when the phase began, on the log's own clock
    /// Samples at the phase's ends that are not among these: their power is the neighbouring phase's
    /// (count_neighbour_samples).
    std::size_t edge_samples = 0;
    /// Height that a take-off climbed to or a landing descended from; absent of cruises, and if it is unknown.
    std::optional<double> height_m = {};
    std::shared_ptr<const FrequencyScan> scan = {};  ///< of these samples, stored for several fits (cache_scans)
};

/// Mean power [W] of a phase over time: trapezoids between the samples, the first and last value up to the
/// phase's ends. The samples must not be empty.
double mean_power_w(const PhaseSamples& samples);

/// Whether each flight's power varies by no more than rounding: it has no frequency.
bool is_constant(std::span<const PhaseSamples> flights);

/// The median of the gaps between samples, as a part of the phase; 0 if all samples are at one time.
double median_gap(const std::vector<double>& tau);

/// One flight; a phase that it lacks, or that was not recorded, is absent.
struct FlightSamples {
    std::string flight;
    flight::PerPhase<std::optional<PhaseSamples>> phases;
    std::optional<double> pack_voltage_v = {};  ///< the highest of the log, but for 1 % of the samples
};

/// Samples at the ends of a phase whose power is the neighbouring phase's.
struct EdgeSamples {
    std::size_t at_start = 0;
    std::size_t at_end = 0;
};

/// The height determines a phase's edge to within the gap between two heights; the power may jump a second or two off.
/// Samples near the edge are compared with the means of eight samples on either side of it: those beyond a jump of six
/// standard deviations of both, and in it, are the neighbour's (docs/methods.md). Smooth power, or noise as large as
/// the jump, leaves all samples to the phase.
EdgeSamples count_neighbour_samples(const flight::Track& power, const flight::PhaseSpan& span);

}  // namespace flightwatt::mechanical
