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

struct FlightScan;

/// Power over one phase of one flight, on that flight's own normalised time.
struct PhaseSamples {
    std::string flight;
    double duration_s = 0.0;
    std::vector<double> tau;      ///< (time - begin of phase) / duration_s, in [0, 1]; gaps are allowed
    std::vector<double> power_w;  ///< as long as tau
    double start_s = 0.0;         ///< when the phase began, on the log's own clock
    /// Samples at the phase's ends that are not among these: their power is the neighbouring phase's (count_neighbour_samples).
    std::size_t edge_samples = 0;
    std::shared_ptr<const FlightScan> scan = {};  ///< of these samples, if it is kept for several fits (scan_flight)
};

/// Mean power [W] of a phase over time: trapezoids between the samples, the first and last value up to the
/// phase's ends. The samples must not be empty.
double mean_power_w(const PhaseSamples& samples);

/// Whether each flight's power varies by no more than rounding: nothing tells a frequency.
bool is_constant(std::span<const PhaseSamples> flights);

/// The median of the gaps between samples, as a part of the phase; 0 if all samples are at one time.
double median_gap(std::vector<double> tau);

/// One flight; a phase that it lacks, or that was not recorded, is absent.
struct FlightSamples {
    std::string flight;
    flight::PerPhase<std::optional<PhaseSamples>> phases;
};

/// What the search for the frequency works on: power less its flight's mean, in units of the standard
/// deviation that the phase's flights have in common, so that no threshold depends on the unit of power.
struct ScaledSamples {
    std::vector<double> tau;
    std::vector<double> value;
    std::string flight = {};                      ///< for messages
    std::shared_ptr<const FlightScan> scan = {};  ///< of these values, if it is known,
    double scan_unit = 1.0;                       ///< whose values are to be multiplied by this
};

/// The same samples in the order of time.
ScaledSamples sort_by_time(const ScaledSamples& samples);

/// Samples at the ends of a phase whose power is the neighbouring phase's.
struct EdgeSamples {
    std::size_t at_start = 0;
    std::size_t at_end = 0;
};

/// A phase ends where the height says so, which is known to the gap between two heights; the power may jump a second or
/// two off. Looked at are the samples no further from an edge than that gap and two median gaps of the power, at most a
/// tenth of the phase's. A straight line through the eight samples behind them tells what they would be of this phase,
/// one through the eight on the other side what they would be of the neighbour. Where the lines are further apart than
/// six standard errors of both, the samples nearer to the neighbour's line, those before them, and the one of the jump
/// itself (more than a tenth of it off this phase's line) count as the neighbour's. Power that goes on smoothly, or
/// noise as large as the jump, leaves all of them.
EdgeSamples count_neighbour_samples(const flight::Track& power, const flight::PhaseSpan& span);

}  // namespace flightwatt::mechanical
