#include "mechanical/measured_flight.h"

#include "flight/phase_statistics.h"
#include "mechanical/covariates.h"

#include <utility>

namespace flightwatt::mechanical {

MeasuredFlights measure_flights(const flight::FlightSeries& series, const flight::FlightPhases& phases,
                                std::size_t needed_samples) {
    MeasuredFlights measured;
    for (const auto& sortie : phases.sorties) {
        flight::FlightPhases one;
        one.sorties.push_back(sortie);
        auto selection = select_samples(series, one, needed_samples);
        for (auto& exclusion : selection.exclusions) measured.exclusions.push_back(std::move(exclusion));
        if (selection.flights.empty()) continue;
        MeasuredFlight flight;
        flight.samples = std::move(selection.flights.front());
        if (auto& cruise = flight.samples.phases[flight::Phase::cruise]) {
            cruise->covariates = covariates_of(series, sortie);
        }
        for (const auto& span : sortie.phases) {
            if (!flight.samples.phases[span.phase]) continue;
            const auto statistics = phase_statistics(series, span.start.time_s, span.end.time_s);
            flight.energy_wh[span.phase] = statistics.energy_wh;
            flight.counter_energy_wh[span.phase] = statistics.counter_energy_wh;
        }
        measured.flights.push_back(std::move(flight));
        measured.sorties.push_back(sortie.number - 1);
    }
    return measured;
}

MeasuredFlights measure_flights(const flight::LoadedFlight& loaded, std::size_t needed_samples) {
    if (!loaded.exclusion.empty()) return {{}, {{loaded.series.flight, std::nullopt, loaded.exclusion}}, {}};
    return measure_flights(loaded.series, loaded.phases, needed_samples);
}

void exclude_short_phases(MeasuredFlights& measured, std::size_t needed_samples) {
    MeasuredFlights kept{{}, std::move(measured.exclusions), {}};
    for (std::size_t i = 0; i < measured.flights.size(); ++i) {
        auto& flight = measured.flights[i];
        bool any = false;
        for (const auto phase : flight::all_phases) {
            auto& samples = flight.samples.phases[phase];
            if (samples && samples->tau.size() < needed_samples) {
                kept.exclusions.push_back(
                    {flight.samples.flight, phase, too_few_samples(samples->tau.size(), needed_samples)});
                samples.reset();
                flight.energy_wh[phase].reset();
                flight.counter_energy_wh[phase].reset();
            }
            any = any || samples.has_value();
        }
        if (!any) continue;
        kept.flights.push_back(std::move(flight));
        kept.sorties.push_back(measured.sorties[i]);
    }
    measured = std::move(kept);
}

}  // namespace flightwatt::mechanical
