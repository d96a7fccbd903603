#include "mechanical/measured_flight.h"

#include "flight/phase_statistics.h"
#include "mechanical/covariates.h"

#include <utility>

namespace flightwatt::mechanical {

MeasuredFlights measure_flights(const flight::FlightSeries& series, const flight::FlightPhases& phases,
                                std::size_t needed_samples) {
    MeasuredFlights measured;
    for (std::size_t s = 0; s < phases.sorties.size(); ++s) {
        // One sortie at a time, so that each knows its number; names as if all had been selected at once.
        flight::FlightPhases one;
        one.sorties.resize(s);
        one.sorties.push_back(phases.sorties[s]);
        auto selection = select_samples(series, one, needed_samples);
        for (auto& left_out : selection.left_out) measured.left_out.push_back(std::move(left_out));
        if (selection.flights.empty()) continue;
        MeasuredFlight flight;
        flight.samples = std::move(selection.flights.front());
        if (auto& cruise = flight.samples.phases[flight::Phase::cruise]) {
            cruise->covariates = covariates_of(series, phases.sorties[s]);
        }
        for (const auto& span : phases.sorties[s].phases) {
            if (!flight.samples.phases[span.phase]) continue;
            const auto statistics = phase_statistics(series, span.start.time_s, span.end.time_s);
            flight.energy_wh[span.phase] = statistics.energy_wh;
            flight.counter_energy_wh[span.phase] = statistics.counter_energy_wh;
        }
        measured.flights.push_back(std::move(flight));
        measured.sorties.push_back(s);
    }
    return measured;
}

}  // namespace flightwatt::mechanical
