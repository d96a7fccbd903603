#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "mechanical/measured_flight.h"

#include <flightwatt/flight.h>

namespace flightwatt {

const char* name_of(Phase phase) { return flight::to_string(static_cast<flight::Phase>(phase)).data(); }

double Flight::energy_wh() const {
    double sum_wh = 0.0;
    for (const auto& part : parts) sum_wh += part.energy_wh;
    return sum_wh;
}

double Flight::duration_s() const { return parts.empty() ? 0.0 : parts.back().end_s - parts.front().start_s; }

std::vector<Flight> find_flights(const Log& log) {
    const auto& loaded = log.loaded();
    const flight::PowerStatistics statistics(loaded.data);
    std::vector<Flight> flights;
    for (std::size_t i = 0; i < loaded.phases.sorties.size(); ++i) {
        auto& flight = flights.emplace_back(Flight{mechanical::sortie_name(log.name(), i + 1), {}});
        for (const auto& span : loaded.phases.sorties[i].phases) {
            const auto measured = statistics.between(span.start.time_s, span.end.time_s);
            flight.parts.push_back({static_cast<Phase>(span.phase), span.start.time_s, span.end.time_s,
                                    measured.energy_wh, measured.mean_power_w, measured.counter_energy_wh,
                                    span.complete});
        }
    }
    return flights;
}

}  // namespace flightwatt
