#include "batch/fit_selection.h"

#include "flight/power_check.h"

namespace flightwatt::batch {

void restore_airspeed(const FlightRecord& record, mechanical::FlightSamples& flight) {
    for (const auto& phase : record.phases) {
        if (flight.flight != mechanical::flight_name_of_sortie(record.flight, phase.sortie)) continue;
        auto& samples = flight.phases[phase.phase];
        if (samples) samples->airspeed_cubed_m3_per_s3 = phase.airspeed_cubed_m3_per_s3;
    }
}

mechanical::FlightSelection select_for_fit(const flight::FlightSeries& series,
                                           const flight::FlightPhases& phases, const FlightRecord& record,
                                           std::size_t needed_samples, const std::set<std::string>& keep) {
    auto selection = mechanical::select_samples(series, phases, needed_samples);
    for (auto& flight : selection.flights) restore_airspeed(record, flight);
    if (!keep.contains(series.flight)) {
        if (!record.absurdities.empty()) {
            mechanical::leave_out_all(selection, series.flight,
                                      flight::describe_absurdities(record.absurdities));
        } else if (!record.why_not_fitted.empty()) {
            mechanical::leave_out_all(selection, series.flight, record.why_not_fitted);
        }
    }
    for (auto& flight : selection.flights) {
        for (auto& phase : flight.phases.values) {
            if (!phase) continue;
            phase->tau.shrink_to_fit();
            phase->power_w.shrink_to_fit();
        }
    }
    return selection;
}

}  // namespace flightwatt::batch
