#include "batch/fit_selection.h"

#include "flight/power_check.h"

#include <utility>

namespace flightwatt::batch {

std::string exclusion_of(const FlightRecord& record, const flight::LoadOptions& options) {
    if (options.excluded.contains(record.flight)) return "--exclude names it";
    if (options.keep.contains(record.flight)) return "";
    if (!record.power_faults.empty()) return flight::describe_power_faults(record.power_faults);
    return record.why_not_fitted;
}

mechanical::MeasuredFlights select_for_fit(FlightRecord& record, std::size_t needed_samples,
                                           const flight::LoadOptions& options) {
    auto measured = std::exchange(record.measured, {});
    if (const auto exclusion = exclusion_of(record, options); !exclusion.empty() && record.accepted) {
        measured.flights.clear();
        measured.sorties.clear();
        measured.exclusions.push_back({record.flight, std::nullopt, exclusion});
        return measured;
    }
    mechanical::exclude_short_phases(measured, needed_samples);
    return measured;
}

}  // namespace flightwatt::batch
