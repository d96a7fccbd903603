#pragma once

#include "flight/flight_series.h"
#include "flight/segmentation.h"
#include "mechanical/phase_samples.h"

#include <string>
#include <vector>

namespace flightwatt {

/// A phase that cannot be fitted, and why.
struct LeftOutPhase {
    std::string flight;
    Phase phase;
    std::string reason;
};

/// What a fit takes from one flight: the power samples of its complete phases, each on its own normalised
/// time. Every sortie counts as a flight; from the second on it is called "NAME#2". Phases that are
/// incomplete, have fewer than `needed_samples` samples, or begin or end in a gap longer than a quarter of
/// them (so that their time is not known) are left out, and reported.
struct FlightSelection {
    std::vector<FlightSamples> flights;
    std::vector<LeftOutPhase> left_out;
};

FlightSelection select_samples(const FlightSeries& series, const FlightPhases& phases,
                               std::size_t needed_samples);

}  // namespace flightwatt
