#pragma once

#include "flight/flight_phases.h"
#include "flight/flight_series.h"

#include <cstddef>

namespace flightwatt::mechanical {

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
