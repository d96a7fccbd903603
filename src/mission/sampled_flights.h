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

/// Draws flights (sampling/flight_draws.h) and flies them, an adaptive policy each anew, under the disturbances, which
/// happen at the same part of each flight. Flights depend on the seed and their own number alone, so the
/// answer is the same for any number of threads. Throws as require_spread does, and UsageError for fewer than 2
/// samples or more than 10 million.
MonteCarloResult sample_flights(const PreparedMission& prepared, const Disturbances& disturbances,
                                const SamplingOptions& options);

/// What 95 of 100 flights of two missions, and their difference b - a, lie between.
struct DrawnIntervals {
    Interval a, b, difference;
};

/// Two missions on flights drawn for both. What they have in common (the same mechanical model, the same battery, a
/// component with the same profile, the wind) deviates alike in both; what they do not deviates on its own.
struct SampledDifference {
    std::size_t samples = 0;
    DrawnIntervals duration_s, mechanical_energy_wh, compute_energy_wh, energy_wh, final_soc_percent;
    UncertaintySources sources_a, sources_b;
    std::vector<std::string> shared_sources;  ///< "mechanical model", "battery" ...
    std::vector<std::string> independent_sources;
};

/// Flies both with common random numbers (docs/methods.md, Two missions); a battery that failed has 0 % left. None
/// where nothing says how flights of one of them differ. Throws as sample_flights for a number of samples.
std::optional<SampledDifference> sample_difference(const PreparedMission& a, const PreparedMission& b,
                                                   const SamplingOptions& options = {});

/// For people.
std::string describe(const MonteCarloResult& flights);
std::string describe(const SampledDifference& difference);

/// time_s,soc_p05_percent,soc_p50_percent,soc_p95_percent
std::string to_csv(const std::vector<SocBand>& bands);

}  // namespace flightwatt::mission
