#pragma once

#include "base/statistics.h"
#include "mission/prepared_mission.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::mission {

struct SamplingOptions {
    std::size_t samples = 1000;
    std::uint64_t seed = 1;
    std::size_t band_points = 0;  ///< at which the state of charge is kept of every flight; 0, or 2 and more
};

/// Draws flights (sampling/flight_draws.h) and simulates them, an adaptive policy in each, with the disturbances at the
/// same fraction of each flight. Flights depend on the seed and their own number alone, so the result is the same for
/// any number of threads. Throws as require_uncertainty, and UsageError for less than 2 samples or more than 10
/// million.
MonteCarloResult sample_flights(const PreparedMission& prepared, const Disturbances& disturbances,
                                const SamplingOptions& options);

/// 95 % intervals over the flights of two missions, and of the difference b - a.
struct DrawnIntervals {
    Interval a, b, difference;
};

/// Two missions on flights drawn for both. Common sources (the same mechanical model, battery, profile of a component,
/// the wind) vary jointly, the others independently.
struct SampledDifference {
    std::size_t samples = 0;
    DrawnIntervals duration_s, mechanical_energy_wh, compute_energy_wh, energy_wh, final_soc_percent;
    UncertaintySources sources_a, sources_b;
    std::vector<std::string> shared_sources;  ///< "mechanical model", "battery" ...
    std::vector<std::string> independent_sources;
};

/// Simulates both with common random numbers (docs/methods.md, Two missions); a failed battery has 0 % left. None if
/// the variability of one of them is unknown. Throws as sample_flights for a number of samples.
std::optional<SampledDifference> sample_difference(const PreparedMission& a, const PreparedMission& b,
                                                   const SamplingOptions& options = {});

/// Text for people.
std::string describe(const MonteCarloResult& flights);
std::string describe(const SampledDifference& difference);

/// time_s,soc_p05_percent,soc_p50_percent,soc_p95_percent
std::string to_csv(const std::vector<SocBand>& bands);

}  // namespace flightwatt::mission
