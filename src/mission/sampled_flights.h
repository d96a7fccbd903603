#pragma once

#include "base/statistics.h"
#include "mission/prepared_mission.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace flightwatt::mission {

struct SamplingOptions {
    std::size_t samples = 1000;
    std::uint64_t seed = 1;
    std::size_t band_points = 0;  ///< at which the state of charge is kept of every flight; 0, or 2 and more
};

/// Throws InputError for a mission whose drawn flights show no probabilities: nothing states how flights differ.
void require_known_probabilities(const MissionSetup& mission);

/// Draws flights (sampling/flight_draws.h) and simulates them, an adaptive policy in each, with the disturbances at the
/// same fraction of each flight. Flights depend on the seed and their own number alone, so the result is the same for
/// any number of threads. Throws as require_uncertainty, and UsageError for less than 2 samples or more than 10
/// million.
MonteCarloResult sample_flights(const PreparedMission& prepared, const Disturbances& disturbances,
                                const SamplingOptions& options);

/// A drawn flight with its mean powers, for forecasts of charge.
struct DrawnLoads {
    battery::Battery battery;
    PerPhase<double> power_w;  ///< mean mechanical power; 0 in a phase that is not flown
    PerPhase<double> duration_s;
    bool is_infeasible = false;  ///< its wind forbids the path
};

/// Flights as sample_flights draws them, not flown.
struct DrawnFlights {
    std::vector<DrawnLoads> flights;
    UncertaintySources sources;
    bool variability_is_known = true;  ///< as MonteCarloResult's
    double degrees_of_freedom = 0.0;   ///< of their mechanical energy; infinite: normal
};

/// Draws flights of a mission with a mechanical model, which may have no variability. Throws UsageError as
/// sample_flights.
DrawnFlights draw_flights(const MissionSetup& mission, const SamplingOptions& options);

/// Returns the 95 % interval of the fraction of new flights that has a property which `share` of the drawn ones has, by
/// their number and by the few flights that show how flights differ.
Interval share_of_new_flights_95(double share, const DrawnFlights& drawn);

/// Text for people: how many keep the reserve, and with what charge 90 of 100 land.
std::string describe_briefly(const MonteCarloResult& flights);

/// The same with intervals, quantiles and the sources of the variability.
std::string describe(const MonteCarloResult& flights);

/// time_s,soc_p05_percent,soc_p50_percent,soc_p95_percent
std::string to_csv(const std::vector<SocBand>& bands);

}  // namespace flightwatt::mission
