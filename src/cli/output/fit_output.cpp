#include "cli/output/fit_output.h"

#include "base/error.h"
#include "base/statistics.h"
#include "cli/output/records.h"
#include "mechanical/fit_records.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/model_fit.h"
#include "mechanical/prediction.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

Json intervals_json(const std::vector<Interval>& intervals) {
    return list_json(intervals, [](const auto& interval) { return interval_json(interval); });
}

Json to_json(const mechanical::PhaseModel& phase, const mechanical::PhaseErrors& errors) {
    const auto intervals = coefficient_intervals(phase);
    return {{"standard_error",
             {{"omega_rad_per_s", errors.omega_rad_per_s},
              {"a0_w", errors.a0_w},
              {"cos_w", errors.cos_w},
              {"sin_w", errors.sin_w},
              {"curve_w", errors.curve_w}}},
            {"interval_95",
             {{"omega_rad_per_s", interval_json(intervals.omega_rad_per_s)},
              {"a0_w", interval_json(intervals.a0_w)},
              {"cos_w", intervals_json(intervals.cos_w)},
              {"sin_w", intervals_json(intervals.sin_w)}}},
            {"frequency_is_given", errors.frequency_is_fixed},
            {"degrees_of_freedom", errors.degrees_of_freedom},
            {"r2", errors.r2},
            {"condition", errors.condition},
            {"autocorrelation", errors.autocorrelation},
            {"effective_samples", errors.effective_samples}};
}

Json to_json(const mechanical::FlightEnvelope& spread) {
    return {{"low_w", spread.low_w},
            {"high_w", spread.high_w},
            {"standard_deviation_w", spread.standard_deviation_w},
            {"counted_flights", spread.effective_flights}};
}

Json validation_json(const mechanical::ModelValidation& validation) {
    return {{"default_model", default_model(validation)},
            {"scores", list_json(validation.scores, [](const auto& score) { return cli::to_json(score); })}};
}

/// "off on 4 flights left out of the fit: constant_mean 18.6 %, ...; missions use constant_mean".
std::string describe(const mechanical::ModelValidation& validation, bool has_physical) {
    std::string errors;
    std::size_t flights = 0;
    for (const auto& score : validation.scores) {
        errors +=
            fmt::format("{}{} {:.1f} %", errors.empty() ? "" : ", ", score.model, score.mean_absolute_error_percent);
        if (flights > 0 && score.flights != flights) errors += fmt::format(" (on {} of them)", score.flights);
        flights = std::max(flights, score.flights);
    }
    return fmt::format("off on {} flights left out of the fit: {}; missions use {}{}", flights, errors,
                       has_physical ? "physical at a stated airspeed, else " : "", default_model(validation));
}

}  // namespace

TextTable table_of(const mechanical::MechanicalModel& model,
                   const std::optional<mechanical::MechanicalModel>& published, mechanical::TableIntervals intervals) {
    return published ? table_one_comparison(*published, model, intervals) : table_one(model, intervals);
}

TextTable mean_power_table(const mechanical::MechanicalModel& model) {
    TextTable table{{"phase", "mean W", "low 95 %", "high 95 %", "flights", "samples"}, {}};
    for (const auto phase : flight::all_phases) {
        const auto power = mean_power(model, phase);
        if (!power) continue;
        const auto end = [&](double Interval::*of) { return power->interval ? fixed((*power->interval).*of, 2) : "-"; };
        table.rows.push_back({std::string(to_string(phase)), fixed(power->mean_w, 2), end(&Interval::low),
                              end(&Interval::high), fmt::format("{}", power->flights),
                              fmt::format("{}", power->samples)});
    }
    return table;
}

std::string table_text(const TextTable& table, const std::filesystem::path& file) {
    const auto ending = file.extension().string();
    if (ending == ".txt") return to_text(table);
    if (ending == ".csv") return to_csv(table);
    if (ending == ".md") return to_markdown(table);
    if (ending == ".tex") return mechanical::to_latex(table);
    throw UsageError(fmt::format("{}: expected a name that ends in .txt, .csv, .md or .tex", file.string()));
}

Json to_json(const mechanical::HeldOutScore& score) {
    return {{"model", score.model},
            {"flights", score.flights},
            {"mean_absolute_error_percent", score.mean_absolute_error_percent}};
}

Json to_json(const mechanical::MechanicalModel& model) {
    Json json{
        {"name", model.name}, {"weighting", model.weighting}, {"phases", Json::object()}, {"flights", Json::array()}};
    for (const auto phase : flight::all_phases) {
        const auto& fitted = model.phases[phase];
        auto& entry = json["phases"][std::string(to_string(phase))];
        entry = {{"duration_s", fitted.duration_s},     {"omega_rad_per_s", fitted.fourier.omega_rad_per_s},
                 {"a0_w", fitted.fourier.a0_w},         {"cos_w", fitted.fourier.cos_w},
                 {"sin_w", fitted.fourier.sin_w},       {"rms_w", fitted.rms_w.value_or(0.0)},
                 {"samples", fitted.samples},           {"flights", fitted.flights},
                 {"edge_samples", fitted.edge_samples}, {"open_frequency", fitted.open_frequency},
                 {"not_negative", fitted.not_negative}};
        if (const auto power = mean_power(model, phase)) {
            entry["mean_power_w"] = power->mean_w;
            entry["mean_power_interval_95_w"] = interval_json(power->interval);
        }
        if (fitted.range) {
            entry["omega_duration_rad"] = {{"low", fitted.range->low_rad},
                                           {"high", fitted.range->high_rad},
                                           {"at_bound", to_string(fitted.range->at_bound)}};
        }
    }
    for (const auto& flight : model.flights) {
        Json weights = Json::object();
        for (const auto phase : flight::all_phases) {
            const auto& part = flight.phases[phase];
            weights[std::string(to_string(phase))] = part ? Json(part->weight) : Json();
        }
        json["flights"].push_back({{"flight", flight.flight}, {"weights", weights}});
    }
    if (model.validation) json["validation"] = validation_json(*model.validation);
    json["warnings"] = model_warnings(model);
    json["notes"] = fit_notes(model);
    return json;
}

void warn_of_model(const StageCall& call, const mechanical::MechanicalModel& model) {
    for (const auto phase : flight::all_phases) {
        const auto& fitted = model.phases[phase];
        if (!fitted.range || fitted.range->at_bound == mechanical::FrequencyBound::none) continue;
        warn(call, fmt::format("{}: omega * duration stands at its {} bound, {:.3f} rad: the frequency is not "
                               "determined by the data, the curve is",
                               to_string(phase), to_string(fitted.range->at_bound),
                               fitted.range->at_bound == mechanical::FrequencyBound::low ? fitted.range->low_rad
                                                                                         : fitted.range->high_rad));
    }
    for (const auto& warning : model_warnings(model)) warn(call, warning);
    for (const auto& text : fit_notes(model)) note(call, text);
    if (model.validation) note(call, describe(*model.validation, model.physical.has_value()));
}

void add_errors_json(Json& json, const mechanical::MechanicalModel& model) {
    for (const auto phase : flight::all_phases) {
        auto& entry = json["phases"][std::string(to_string(phase))];
        const auto& fitted = model.phases[phase];
        if (fitted.errors) entry["errors"] = to_json(fitted, *fitted.errors);
        if (fitted.spread) entry["spread"] = to_json(*fitted.spread);
    }
}

}  // namespace flightwatt::cli
