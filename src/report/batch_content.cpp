#include "report/batch_content.h"

#include "batch/batch_files.h"
#include "batch/flight_record.h"
#include "cli/output/table_one_output.h"

#include <algorithm>
#include <iterator>

namespace flightwatt::report {

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
            for (const auto& exclusion : selection.exclusions)
                flight.exclusions.push_back(to_string(exclusion));
            std::move(selection.flights.begin(), selection.flights.end(),
                      std::back_inserter(content.measured));
            flight.verdicts = record.verdicts;
            flight.unusable_power = batch::exclusion_of(record, load);
            flight.series = std::move(series);
            flight.phases = std::move(phases);
        }
        content.flights.push_back(std::move(flight));
    }
    // Readers look at the first ones first.
    std::stable_partition(content.flights.begin(), content.flights.end(),
                          [](const ReportFlight& flight) { return flight.unusable_power.empty(); });
    return content;
}

ReportModel model_of(const batch::BatchFit& fit,
                     const std::optional<mechanical::MechanicalModel>& published) {
    ReportModel model{fit.model, "Fitted by flightwatt batch to the flights above."};
    model.bands = fit.bands;
    model.table_one = cli::table_of(fit.model, published, mechanical::TableIntervals::present);
    return model;
}

}  // namespace flightwatt::report
