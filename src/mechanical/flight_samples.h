#pragma once

#include "flight/flight_series.h"
#include "flight/segmentation.h"
#include "mechanical/fit/phase_samples.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

/// What is not fitted, and why.
struct Exclusion {
    std::string flight;
    std::optional<flight::Phase> phase;  ///< absent: the whole flight
    std::string reason;
};

/// "NAME: landing is excluded: REASON".
std::string to_string(const Exclusion& exclusion);

/// What a fit takes from one flight: the power samples of its complete phases, each on its own normalised
/// time. Every sortie counts as a flight; from the second on it is called "NAME#2". Phases that are
/// incomplete, have fewer than `needed_samples` samples, or begin or end in a gap longer than a quarter of
/// them (so that their time is not known) are excluded, and reported.
struct FlightSelection {
    std::vector<FlightSamples> flights;
    std::vector<Exclusion> exclusions;
};

/// What a sortie is called in a fit: NAME, and NAME#2 from the second on.
std::string flight_name_of_sortie(const std::string& flight, std::size_t sortie);

FlightSelection select_samples(const flight::FlightSeries& series, const flight::FlightPhases& phases,
                               std::size_t needed_samples);

/// "7 samples, 8 are needed".
std::string too_few_samples(std::size_t samples, std::size_t needed);

}  // namespace flightwatt::mechanical
