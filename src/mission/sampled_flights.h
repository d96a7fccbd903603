#pragma once

#include "mission/prepared_mission.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace flightwatt::mission {

struct SamplingOptions {
    std::size_t samples = 1000;
    std::uint64_t seed = 1;
    std::size_t band_times = 0;  ///< at which the state of charge is kept of every flight; 0, or 2 and more
};

/// Draws flights (draw_flight) and flies them, an adaptive policy each anew, under the disturbances, which
/// happen at the same part of each flight. Flights depend on the seed and their own number alone, so the
/// answer is the same for any number of threads. Throws as spreads_of does, and UsageError for fewer than 2
/// samples or more than 10 million.
SampledFlights sample_flights(const Flyable& flyable, const std::vector<Disturbance>& disturbances,
                              const SamplingOptions& options);

/// For people.
std::string describe(const SampledFlights& flights);

/// time_s,soc_p05_percent,soc_p50_percent,soc_p95_percent
std::string to_csv(const std::vector<SocBand>& bands);

}  // namespace flightwatt::mission
