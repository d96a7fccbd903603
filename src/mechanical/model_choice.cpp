// The choice between the models of a file, and what predicts each phase, by cross-validation.

#include "base/error.h"
#include "mechanical/fit/phase_fit.h"
#include "mechanical/physical_fit.h"
#include "mechanical/validation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

constexpr auto mean_model = "constant_mean";
constexpr auto curve_model = "fourier";
constexpr auto by_phase = "by_phase";
constexpr auto physical = "physical";

/// The flights that the model predicts as a whole.
std::vector<ValidatedFlight> predicted_by(std::span<const ValidatedFlight> flights, const std::string& model) {
    std::vector<ValidatedFlight> predicted;
    std::ranges::copy_if(flights, std::back_inserter(predicted),
                         [&](const auto& flight) { return predicted_energy(flight, model, std::nullopt).has_value(); });
    return predicted;
}

/// Of the whole flights; std::nullopt without an error in percent.
std::optional<HeldOutScore> held_out_score(std::span<const ValidatedFlight> flights, const std::string& model) {
    const auto score = score_of(flights, model, std::nullopt);
    if (!score || !score->mean_absolute_error_percent) return std::nullopt;
    return HeldOutScore{model, score->flights, *score->mean_absolute_error_percent};
}

/// With fewer flights, no two are left to predict a third.
constexpr std::ptrdiff_t min_flights = 3;

/// The longest part of a phase without a sample; 1: it has none.
constexpr double max_gap = 0.25;

/// A curve whose energies are farther off by this factor is no worse: few flights cannot show it.
constexpr double energy_tolerance = 1.05;

bool covers_phase(const PhaseSamples& samples) {
    double last = 0.0;
    for (const double tau : samples.tau) {
        if (tau - last > max_gap) return false;
        last = tau;
    }
    return 1.0 - last <= max_gap;
}

double rms_error_w(std::span<const ValidatedFlight> flights, const std::string& model, flight::Phase phase) {
    double sum_w2 = 0.0;
    double count = 0.0;
    for (const auto& flight : flights)
        for (const auto& prediction : flight.predictions)
            if (prediction.model == model && prediction.square_error_w2[phase]) {
                sum_w2 += *prediction.square_error_w2[phase];
                count += 1.0;
            }
    return std::sqrt(sum_w2 / count);
}

/// `samples` are those of the fitted flights.
PowerDecision decide_phase(flight::Phase phase, std::span<const PhaseSamples> samples,
                           std::span<const ValidatedFlight> validated) {
    using enum PowerBasis;
    if (samples.size() == 1) return {mean, "of one flight, which has no variability between flights"};
    const auto covered = std::ranges::count_if(samples, covers_phase);
    if (covered < min_flights)
        return {mean, fmt::format("of {} flights, {} with samples all over the phase: a curve needs {}", samples.size(),
                                  covered, min_flights)};
    const auto of_curve = score_of(validated, curve_model, phase);
    const auto of_mean = score_of(validated, mean_model, phase);
    if (!of_curve || !of_mean) return {mean, "no flight could be left out of the fit"};
    const double curve_w = rms_error_w(validated, curve_model, phase);
    const double mean_w = rms_error_w(validated, mean_model, phase);
    const auto reason = fmt::format(
        "on {} flights left out the curve is {:.3g} Wh off and {:.3g} W over time, the mean power {:.3g} Wh and {:.3g} W",
        of_curve->flights, of_curve->mean_absolute_error_wh, curve_w, of_mean->mean_absolute_error_wh, mean_w);
    const bool is_no_worse =
        of_curve->mean_absolute_error_wh <= energy_tolerance * of_mean->mean_absolute_error_wh && curve_w < mean_w;
    return {is_no_worse ? curve : mean, reason};
}

/// The flights with each phase predicted by what the model decided.
void add_decided(std::vector<ValidatedFlight>& flights, const MechanicalModel& model) {
    for (auto& flight : flights) {
        FlightPrediction decided{by_phase, {}};
        for (const auto& prediction : flight.predictions)
            for (const auto phase : flight::all_phases) {
                const bool by_mean = model.phases[phase].power.by == PowerBasis::mean;
                if (prediction.model == (by_mean ? mean_model : curve_model))
                    decided.phases[phase] = prediction.phases[phase];
            }
        flight.predictions.push_back(std::move(decided));
    }
}

}  // namespace

std::vector<MeasuredFlight> validated_flights(std::span<const MeasuredFlight> flights) {
    const auto count = std::min(flights.size(), max_validation_folds);
    std::vector<MeasuredFlight> chosen;
    chosen.reserve(count);
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(flights[i * flights.size() / count]);
    return chosen;
}

std::string remove_rejected(std::vector<ValidatedFlight>& flights) {
    const auto predicted = predicted_by(flights, physical);
    const auto own = held_out_score(predicted, physical);
    const auto of_mean = held_out_score(predicted, mean_model);
    if (!own || !of_mean || own->mean_absolute_error_percent <= of_mean->mean_absolute_error_percent) return "";
    for (auto& flight : flights)
        std::erase_if(flight.predictions, [](const auto& prediction) { return prediction.model == physical; });
    return fmt::format("{} is rejected: {:.1f} % off on {} flights left out, the mean power {:.1f} %", physical,
                       own->mean_absolute_error_percent, own->flights, of_mean->mean_absolute_error_percent);
}

void decide_power(MechanicalModel& model, std::span<const MeasuredFlight> flights,
                  std::span<const ValidatedFlight> validated) {
    for (const auto phase : flight::all_phases) {
        auto& fitted = model.phases[phase];
        if (!fitted.power.reason.empty()) continue;  // the samples determine no curve
        std::vector<PhaseSamples> samples;
        for (std::size_t i = 0; i < flights.size(); ++i)
            if (model.flights.at(i).phases[phase]) samples.push_back(flights[i].samples.phases[phase].value());
        fitted.power = decide_phase(phase, samples, validated);
        if (fitted.power.by == PowerBasis::curve) continue;
        fitted.level_spread = estimate_variance_components(with_decided_power(model).phases[phase], samples);
    }
}

std::optional<ModelValidation> validation_of(std::vector<ValidatedFlight> flights, const MechanicalModel& model) {
    remove_rejected(flights);
    const auto of_mean = held_out_score(flights, mean_model);
    const auto of_curve = held_out_score(flights, curve_model);
    if (!of_mean || !of_curve) return std::nullopt;
    ModelValidation validation{default_model(model), {*of_mean, *of_curve}};
    if (validation.default_model == by_phase) {
        add_decided(flights, model);
        validation.scores.push_back(held_out_score(flights, by_phase).value());
    }
    if (auto score = held_out_score(predicted_by(flights, physical), physical))
        validation.scores.push_back(*std::move(score));
    return validation;
}

void add_best_power(MechanicalModel& model, std::span<const MeasuredFlight> flights, const ModelFitOptions& options,
                    const std::function<void(std::size_t, std::size_t)>& progress) {
    std::vector<ValidatedFlight> validated;
    try {
        if (flights.size() > 1) validated = leave_one_out(validated_flights(flights), options, progress);
    } catch (const NoResultError&) {  // the mean powers are the model then
    }
    decide_power(model, flights, validated);
    model.is_rotorcraft = std::ranges::all_of(flights, [](const auto& flight) { return flight.motion.is_rotorcraft; });
    model.validation = validation_of(std::move(validated), model);
    if (model.physical) return;
    std::vector<BinnedFlight> motions(flights.size());
    std::ranges::transform(flights, motions.begin(), &MeasuredFlight::motion);
    try {
        model.physical = fit_physical_model(motions).model;
    } catch (const NoResultError&) {  // no motion was measured, or it does not determine the power
    }
}

bool motion_predicts_best(const MechanicalModel& model) {
    if (!model.physical || !model.validation) return model.physical && model.physical->flights.size() > 1;
    const auto is_physical = [](const auto& score) { return score.model == physical; };
    return std::ranges::any_of(model.validation->scores, is_physical);
}

}  // namespace flightwatt::mechanical
