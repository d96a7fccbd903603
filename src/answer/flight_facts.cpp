#include "answer/flight_facts.h"

#include "base/units.h"
#include "flight/phase_statistics.h"
#include "flight/vtol_flight.h"

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

/// Places of a log in metres, along time.
struct Places {
    std::vector<double> time_s;
    std::vector<double> east_m;
    std::vector<double> north_m;
};

/// Those of positions in metres or in degrees, which a sphere converts within 1 %.
Places places_of(const flight::FlightData& data) {
    const bool is_local = !data.east_m.empty() && !data.north_m.empty();
    const auto& east = is_local ? data.east_m : data.longitude_deg;
    const auto& north = is_local ? data.north_m : data.latitude_deg;
    if (east.empty() || north.empty()) return {};
    const auto norths = resample(north, east.time_s);
    std::optional<double> parallel;
    Places places;
    for (std::size_t i = 0; i < norths.size(); ++i) {
        if (!parallel)
            parallel = is_local ? 1.0 : units::metre_per_degree * std::cos(norths[i] / units::degree_per_rad);
        places.time_s.push_back(east.time_s[i]);
        places.east_m.push_back(east.value[i] * *parallel);
        places.north_m.push_back(norths[i] * (is_local ? 1.0 : units::metre_per_degree));
    }
    return places;
}

/// The largest distance from the first place between two times; std::nullopt without any.
std::optional<double> farthest_m(const Places& places, double start_s, double end_s) {
    std::optional<std::size_t> first;
    double farthest = 0.0;
    for (std::size_t i = 0; i < places.time_s.size(); ++i) {
        if (places.time_s[i] < start_s || places.time_s[i] > end_s) continue;
        if (!first) first = i;
        farthest = std::max(
            farthest, std::hypot(places.east_m[i] - places.east_m[*first], places.north_m[i] - places.north_m[*first]));
    }
    return first ? std::optional(farthest) : std::nullopt;
}

std::optional<double> wing_s(const flight::FlightData& data, double start_s, double end_s) {
    if (data.vtol_state.empty()) return std::nullopt;
    double sum_s = 0.0;
    for (const auto& span : flight::vtol_spans(data, start_s, end_s))
        if (span.flight == flight::VtolFlight::wing) sum_s += span.duration_s();
    return sum_s;
}

}  // namespace

std::vector<FlightFacts> flight_facts(const flight::LoadedFlight& loaded) {
    std::vector<FlightFacts> facts;
    const auto& data = loaded.data;
    const auto places = places_of(data);
    std::optional<double> pack_percent;
    if (data.circuits.size() > 1) pack_percent = circuit_shares(data, loaded.phases).front().percent;
    for (const auto& sortie : loaded.phases.sorties) {
        if (sortie.phases.empty()) continue;
        const auto farthest = farthest_m(places, sortie.phases.front().start.time_s, sortie.phases.back().end.time_s);
        for (const auto& span : sortie.phases) {
            if (span.phase != flight::Phase::cruise) continue;
            const double start_s = span.start.time_s;
            const double end_s = span.end.time_s;
            facts.push_back({data.flight, end_s - start_s, mean_between(data.ground_speed_m_per_s, start_s, end_s),
                             farthest, data.stated_capacity_ah, mean_between(data.voltage_v, start_s, end_s),
                             data.monitors, pack_percent, wing_s(data, start_s, end_s), first_value(data.payload_kg)});
        }
    }
    return facts;
}

std::vector<FlightFacts> fitted_facts(std::vector<FlightFacts> facts, const std::set<std::string>& keep) {
    const auto only_hovers = [](const FlightFacts& flight) { return flight.wing_s == 0.0 && flight.cruise_s > 0.0; };
    if (!std::ranges::all_of(facts, only_hovers))
        std::erase_if(facts, [&](const auto& flight) { return only_hovers(flight) && !keep.contains(flight.flight); });
    return facts;
}

double wing_share(const std::vector<FlightFacts>& facts) {
    double on_wing_s = 0.0;
    double duration_s = 0.0;
    for (const auto& flight : facts) {
        on_wing_s += flight.wing_s.value_or(flight.cruise_s);
        duration_s += flight.cruise_s;
    }
    return duration_s > 0.0 ? on_wing_s / duration_s : 1.0;
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
