#include "cli/output/fit_output.h"

#include "base/error.h"
#include "base/statistics.h"
#include "cli/output/mission_output.h"
#include "cli/output/physical_output.h"
#include "mechanical/fit_records.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/prediction.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mechanical {

Fields<CoefficientIntervals> record_fields(const CoefficientIntervals*) {
    using R = CoefficientIntervals;
    return {field("omega_rad_per_s_interval_95", &R::omega_rad_per_s, "of the angular frequency"),
            field("a0_w_interval_95", &R::a0_w, "of the constant"),
            field("cos_w_interval_95", &R::cos_w, "of the cosine coefficients"),
            field("sin_w_interval_95", &R::sin_w, "of the sine coefficients")};
}

Fields<FlightContribution> record_fields(const FlightContribution*) {
    using R = FlightContribution;
    const auto weights = [](const R& flight) {
        Keyed<std::optional<double>> all;
        for (const auto phase : flight::all_phases)
            all.emplace_back(std::string(to_string(phase)),
                             flight.phases[phase] ? std::optional(flight.phases[phase]->weight) : std::nullopt);
        return all;
    };
    return {field("flight", &R::flight, "name of the flight"),
            field("weights", weights, "by phase; null: without this phase")};
}

Fields<ModelValidation> record_fields(const ModelValidation*) {
    return {field("default_model", &ModelValidation::default_model, "model of missions"),
            field("scores", &ModelValidation::scores, "hold-out errors")};
}

}  // namespace flightwatt::mechanical

namespace flightwatt::cli {
namespace {

/// A fitted phase.
struct PhaseOutput {
    const mechanical::PhaseModel* fitted = nullptr;
    std::optional<mechanical::MeanPower> mean_power;
    std::optional<mechanical::CoefficientIntervals> intervals;  ///< of --errors
};

Fields<PhaseOutput> record_fields(const PhaseOutput*) {
    using R = PhaseOutput;
    using M = mechanical::PhaseModel;
    using F = decltype(M::fourier);
    using P = mechanical::MeanPower;
    using D = mechanical::PowerDecision;
    const auto rms_w = [](const R& r) { return r.fitted->rms_w.value_or(0.0); };
    return list_fields<R>(
        field("duration_s", at(&R::fitted, &M::duration_s), "duration of the phase"),
        field("omega_rad_per_s", at(&R::fitted, &M::fourier, &F::omega_rad_per_s), "angular frequency"),
        field("a0_w", at(&R::fitted, &M::fourier, &F::a0_w), "constant"),
        field("cos_w", at(&R::fitted, &M::fourier, &F::cos_w), "cosine coefficients"),
        field("sin_w", at(&R::fitted, &M::fourier, &F::sin_w), "sine coefficients"),
        field("rms_w", rms_w, "residual of the samples"),
        field("samples", at(&R::fitted, &M::samples), "power samples"),
        field("flights", at(&R::fitted, &M::flights), "flights with this phase"),
        field("edge_samples", at(&R::fitted, &M::edge_samples), "samples of the neighbouring phases"),
        field("open_frequency", at(&R::fitted, &M::open_frequency), "the data do not determine the frequency"),
        field("power", at(&R::fitted, &M::power, &D::by), "what predicts the phase: its `curve`, or its `mean` power"),
        field("power_reason", at(&R::fitted, &M::power, &D::reason), "why; empty with `--model-kind fourier`"),
        field("not_negative", at(&R::fitted, &M::not_negative), "the curve was limited to 0 W or more"),
        field("mean_power_w", at(&R::mean_power, &P::mean_w), "mean over the flights", optional_key{}),
        field("mean_power_w_interval_95", at(&R::mean_power, &P::interval), "null: a single flight"),
        embedded_if_any(&R::intervals));
}

/// "hold-out error of 4 flights: constant_mean 18.6 %, ...; missions use constant_mean".
std::string describe(const mechanical::ModelValidation& validation, bool has_physical) {
    std::vector<std::string> errors;
    std::size_t flights = 0;
    for (const auto& score : validation.scores) {
        errors.push_back(fmt::format("{} {:.1f} %", score.model, score.mean_absolute_error_percent));
        flights = std::max(flights, score.flights);
    }
    return fmt::format("hold-out error of {} flights: {}; missions use {}{}", flights, fmt::join(errors, ", "),
                       has_physical ? "physical at a stated airspeed, else " : "", validation.default_model);
}

}  // namespace

TextTable model_table(const mechanical::MechanicalModel& model,
                      const std::optional<mechanical::MechanicalModel>& published,
                      mechanical::TableIntervals intervals) {
    return published ? table_one_comparison(*published, model, intervals) : table_one(model, intervals);
}

TextTable mean_power_table(const mechanical::MechanicalModel& model) {
    // R2 is part of the errors (--errors).
    const bool has_r2 = std::ranges::any_of(flight::all_phases,
                                            [&](const auto phase) { return model.phases[phase].errors.has_value(); });
    TextTable table{{"phase", "mean W", "low 95 %", "high 95 %", "RMS W", "flights", "samples"}, {}};
    if (has_r2) table.header.insert(table.header.begin() + 5, "R2");
    for (const auto phase : flight::all_phases) {
        const auto power = mean_power(model, phase);
        if (!power) continue;
        const auto& fitted = model.phases[phase];
        const auto r2 = fitted.errors ? std::optional(fitted.errors->r2) : std::nullopt;
        const auto end = [&](double Interval::*of) { return power->interval ? fixed((*power->interval).*of, 2) : "-"; };
        table.rows.push_back({std::string(to_string(phase)), fixed(power->mean_w, 2), end(&Interval::low),
                              end(&Interval::high), fixed(fitted.rms_w, 2), fmt::format("{}", power->flights),
                              fmt::format("{}", power->samples)});
        if (has_r2) table.rows.back().insert(table.rows.back().begin() + 5, fixed(r2, 3));
    }
    return table;
}

std::string table_text(const TextTable& table, const std::filesystem::path& file, std::string_view caption) {
    const auto ending = file.extension().string();
    if (ending == ".txt") return to_text(table);
    if (ending == ".csv") return to_csv(table);
    if (ending == ".md") return to_markdown(table);
    const auto label = "tab:" + file.stem().string();
    if (ending == ".tex") return caption.empty() ? mechanical::to_latex(table, label) : to_latex(table, caption, label);
    throw UsageError(fmt::format("{}: expected a name that ends in .txt, .csv, .md or .tex", file.string()));
}

void warn_of_model(const StageCall& call, const mechanical::MechanicalModel& model) {
    for (const auto& warning : model_warnings(model)) warn(call, warning);
    append(*call.diagnostics, Severity::note, "fit of the curves", "", fit_notes(model));
    if (!model.validation) return;
    if (call.notes) return note(call, describe(*model.validation, motion_predicts_best(model)));
    for (const auto& score : model.validation->scores)
        if (score.model == model.validation->default_model) note(call, mission::describe(score));
}

Fields<FitOutput> record_fields(const FitOutput*) {
    using R = FitOutput;
    using M = mechanical::MechanicalModel;
    const auto phases = [](const R& r) {
        Keyed<PhaseOutput> all;
        for (const auto phase : flight::all_phases) {
            const auto& fitted = r.model->phases[phase];
            auto& output = all.emplace_back(std::string(to_string(phase)), PhaseOutput{}).second;
            output = {&fitted, mean_power(*r.model, phase), std::nullopt};
            if (r.with_errors && fitted.errors) output.intervals = coefficient_intervals(fitted);
        }
        return all;
    };
    return {
        field("name", at(&R::model, &M::name), "name of the model"),
        field("weighting", at(&R::model, &M::weighting), "`--weights`"),
        field("phases", phases, "phases of the model"),
        field("flights", at(&R::model, &M::flights), "flights of the fit"),
        field("validation", at(&R::model, &M::validation), "hold-out errors, of `--model-kind best`", optional_key{}),
        field("warnings", at(&R::model, mechanical::model_warnings), "warnings"),
        field("notes", at(&R::model, mechanical::fit_notes), "remarks on the fit"),
        field("physical", &R::physical, "physical model, of `--model-kind physical`", optional_key{})};
}

}  // namespace flightwatt::cli
