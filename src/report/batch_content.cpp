#include "report/batch_content.h"

#include "batch/batch_files.h"

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
    const auto needed = mechanical::samples_needed(fit.options.phases.order);
    flight::LoadOptions load;
    load.excluded = fit.excluded;
    load.keep = fit.keep;
    for (auto& [record, series, phases] : batch::read_stored_flights(out)) {
        ReportFlight flight{record.flight,   record.log, record.accepted ? "" : record.error, {}, {},
                            record.warnings, {}};
        if (record.accepted) {
            auto selection = batch::select_for_fit(record, needed, load);
            for (const auto& exclusion : selection.exclusions) flight.exclusions.push_back(to_string(exclusion));
            std::move(selection.flights.begin(), selection.flights.end(), std::back_inserter(content.measured));
            flight.verdicts = record.verdicts;
            flight.unusable_power = batch::exclusion_of(record, load);
            flight.series = std::move(series);
            flight.phases = std::move(phases);
        }
        content.flights.push_back(std::move(flight));
    }
    // Readers look at the first ones first.
    std::ranges::stable_sort(content.flights, {}, [](const auto& flight) { return !flight.unusable_power.empty(); });
    return content;
}

}  // namespace flightwatt::report
