#include "answer/flight_facts.h"

#include "base/units.h"

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

/// The largest distance from the first point of two tracks, whose values are so many metres each.
double farthest_m(const flight::Track& east, const flight::Track& north, double east_m, double north_m) {
    const auto norths = resample(north, east.time_s);
    double farthest = 0.0;
    for (std::size_t i = 0; i < norths.size(); ++i)
        farthest = std::max(farthest, std::hypot((east.value[i] - east.value.front()) * east_m,
                                                 (norths[i] - norths.front()) * north_m));
    return farthest;
}

/// The same of a log, by its positions in metres or in degrees, which a sphere converts within 1 %.
std::optional<double> farthest_m(const flight::FlightData& data) {
    constexpr double m_per_degree = 111195.0;
    if (!data.east_m.empty() && !data.north_m.empty()) return farthest_m(data.east_m, data.north_m, 1.0, 1.0);
    if (data.latitude_deg.empty() || data.longitude_deg.empty()) return std::nullopt;
    const double parallel = std::cos(data.latitude_deg.value.front() / units::degree_per_rad);
    return farthest_m(data.longitude_deg, data.latitude_deg, m_per_degree * parallel, m_per_degree);
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
                             farthest, data.stated_capacity_ah, mean_between(data.voltage_v, start_s, end_s),
                             data.monitors});
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
