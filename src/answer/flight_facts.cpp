#include "answer/flight_facts.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::answer {
namespace {

/// The mean of a track between two times; std::nullopt without samples there.
std::optional<double> mean_between(const flight::Track& track, double start_s, double end_s) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < track.time_s.size(); ++i) {
        if (track.time_s[i] < start_s || track.time_s[i] > end_s) continue;
        sum += track.value[i];
        count += 1.0;
    }
    return count > 0.0 ? std::optional(sum / count) : std::nullopt;
}

/// The largest distance from the first position.
std::optional<double> farthest_m(const flight::FlightData& data) {
    if (data.east_m.empty() || data.north_m.empty()) return std::nullopt;
    const auto north_m = resample(data.north_m, data.east_m.time_s);
    double farthest = 0.0;
    for (std::size_t i = 0; i < north_m.size(); ++i)
        farthest = std::max(farthest,
                            std::hypot(data.east_m.value[i] - data.east_m.value.front(), north_m[i] - north_m.front()));
    return farthest;
}

}  // namespace

std::vector<FlightFacts> flight_facts(const flight::LoadedFlight& loaded) {
    std::vector<FlightFacts> facts;
    const auto& data = loaded.data;
    const auto farthest = farthest_m(data);
    for (const auto& sortie : loaded.phases.sorties)
        for (const auto& span : sortie.phases) {
            if (span.phase != flight::Phase::cruise) continue;
            const double start_s = span.start.time_s;
            const double end_s = span.end.time_s;
            facts.push_back({data.flight, end_s - start_s, mean_between(data.ground_speed_m_per_s, start_s, end_s),
                             farthest, data.stated_capacity_ah, mean_between(data.voltage_v, start_s, end_s)});
        }
    return facts;
}

std::optional<double> mean_ground_speed_m_per_s(const std::vector<FlightFacts>& facts) {
    double distance_m = 0.0;
    double duration_s = 0.0;
    for (const auto& flight : facts) {
        if (!flight.ground_speed_m_per_s) continue;
        distance_m += *flight.ground_speed_m_per_s * flight.cruise_s;
        duration_s += flight.cruise_s;
    }
    return duration_s > 0.0 ? std::optional(distance_m / duration_s) : std::nullopt;
}

}  // namespace flightwatt::answer
