#pragma once

#include "batch/batch_files.h"
#include "batch/fit_selection.h"
#include "batch/stored_flights.h"
#include "cli/output/table_one_output.h"
#include "flight/power_check.h"
#include "mechanical/measured_flight.h"
#include "mechanical/model_errors.h"
#include "mechanical/phase_curve.h"
#include "report/flights_section.h"
#include "report/model_section.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

/// What flightwatt report takes from a batch's folder.
namespace flightwatt::report {

struct BatchContent {
    std::vector<ReportFlight> flights;
    std::vector<mechanical::FlightSamples> samples;  ///< what a fit takes of them
    std::vector<mechanical::MeasuredFlight> measured;
};

inline BatchContent read_batch_content(const std::filesystem::path& out,
                                       const mechanical::ModelFitOptions& options,
                                       const std::set<std::string>& keep) {
    BatchContent content;
    const auto needed = mechanical::samples_needed(options.phases.order);
    for (auto& [record, series, phases] : batch::read_stored_flights(out)) {
        ReportFlight flight{record.flight,   record.log, record.accepted ? "" : record.error, {}, {},
                            record.warnings, {}};
        if (record.accepted) {
            auto selection = batch::select_for_fit(series, phases, record, needed, keep);
            for (const auto& left_out : selection.left_out) flight.exclusions.push_back(to_string(left_out));
            if (!selection.flights.empty()) {
                for (auto& measured : mechanical::measure_flights(series, phases, needed).flights) {
                    batch::restore_airspeed(record, measured.samples);
                    content.measured.push_back(std::move(measured));
                }
            }
            std::move(selection.flights.begin(), selection.flights.end(),
                      std::back_inserter(content.samples));
            flight.verdicts = record.verdicts;
            if (!keep.contains(record.flight)) {
                flight.unusable_power = !record.why_not_fitted.empty() ? record.why_not_fitted
                                        : record.absurdities.empty()
                                            ? ""
                                            : flight::describe_absurdities(record.absurdities);
            }
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

/// OUT/model.toml with bands and intervals from a fit of the same flights. Where that comes to another model
/// (the batch had other options), the file's stands alone, and it is said. std::nullopt without model.toml.
inline std::optional<ReportModel> read_batch_model(
    const std::filesystem::path& out, const BatchContent& content, const mechanical::ModelFitOptions& options,
    const std::optional<mechanical::MechanicalModel>& published) {
    constexpr double same_curve_w = 1e-6;
    const auto file = out / batch::model_names.front();
    if (!std::filesystem::exists(file)) return std::nullopt;
    ReportModel model{mechanical::read_mechanical_model(file),
                      "Fitted by flightwatt batch to the flights above."};
    auto fit = fit_model(content.samples, options);
    for (const auto phase : flight::all_phases) {
        const double apart_w = curve_rms_difference_w(fit.model.phases[phase], model.model.phases[phase]);
        if (apart_w < same_curve_w) continue;
        model.table_one = cli::table_of(model.model, published);
        model.notes.push_back(fmt::format(
            "{} was fitted with other options than this report was given ({} differs by {:.2g} W): "
            "bands, intervals and validation are not shown. Give the report the batch's options.",
            file.filename().string(), to_string(phase), apart_w));
        return model;
    }
    const auto reports = mechanical::add_errors(fit);
    model.bands = curve_bands(fit, reports);
    model.table_one = cli::table_of(fit.model, published, mechanical::TableIntervals::present);
    return model;
}

}  // namespace flightwatt::report
