#include "report/batch_content.h"

#include "batch/batch_files.h"
#include "batch/batch_run.h"
#include "flight/flight_identity.h"

#include <algorithm>
#include <iterator>

namespace flightwatt::report {

std::string_view fitted_part(const ReportFlight& flight) {
    if (flight.exclusions.empty()) return "all";
    return flight.unusable_power.empty() ? "in part" : "no";
}

BatchContent read_batch_content(const std::filesystem::path& out) {
    BatchContent content;
    content.fit = batch::read_batch_fit(out);
    const auto fit = content.fit.value_or(batch::BatchFit{});
    const auto needed = mechanical::min_samples(fit.options.phases.order);
    flight::LoadOptions load;
    load.excluded = fit.excluded;
    load.keep = fit.keep;
    for (auto& [record, series, phases, damage] : batch::read_stored_flights(out)) {
        const auto& rejected = damage.empty() ? record.error : damage;
        ReportFlight flight{record.flight, record.log, record.accepted ? "" : rejected, {}, {}, record.warnings, {}};
        if (!damage.empty()) content.damaged.push_back(record.flight + ": " + damage);
        if (record.accepted) {
            auto selection = batch::select_for_fit(record, needed, load);
            const auto* copy = batch::original_of(record.flight, fit.repeated);
            if (copy != nullptr) {
                selection.flights.clear();
                selection.exclusions.push_back({record.flight, std::nullopt, batch::duplicate_reason(*copy)});
            }
            for (const auto& exclusion : selection.exclusions) flight.exclusions.push_back(to_string(exclusion));
            std::move(selection.flights.begin(), selection.flights.end(), std::back_inserter(content.measured));
            flight.verdicts = record.verdicts;
            flight.unusable_power = batch::exclusion_reason(record, load);
            if (copy != nullptr) flight.unusable_power = batch::duplicate_reason(*copy);
            flight.series = std::move(series);
            flight.phases = std::move(phases);
        }
        content.flights.push_back(std::move(flight));
    }
    // Readers look at the first ones first.
    std::ranges::stable_sort(content.flights, {}, [](const auto& flight) { return !flight.unusable_power.empty(); });
    return content;
}

std::vector<mechanical::MeasuredFlight> flights_with_power(const BatchContent& content) {
    auto flights = content.measured;
    for (const auto& logged : content.flights) {
        if (!logged.rejected.empty()) continue;
        for (auto& measured : mechanical::extract_flights(logged.series, logged.phases, 1).flights) {
            const auto same = std::ranges::find_if(
                flights, [&](const auto& flight) { return flight.samples.flight == measured.samples.flight; });
            if (same != flights.end()) same->power = std::move(measured.power);
        }
    }
    return flights;
}

std::string aircraft_mix(const BatchContent& content) {
    std::vector<flight::FlightAircraft> flown;
    for (const auto& flight : content.flights) {
        if (!flight.rejected.empty() || !flight.unusable_power.empty()) continue;
        flown.push_back({flight.name, flight.series.aircraft_id, flight.series.aircraft_name});
    }
    return content.fit ? "" : describe_mixed_aircraft(flown);
}

}  // namespace flightwatt::report
