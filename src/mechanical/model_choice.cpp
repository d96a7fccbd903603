// The choice between the models of a file for missions, by cross-validation.

#include "base/error.h"
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
constexpr auto curve = "fourier";
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

double error_wh(const ValidatedFlight& flight, const std::string& model) {
    const auto energy = predicted_energy(flight, model, std::nullopt).value();
    return std::abs(energy.estimate.energy_wh - energy.measured_wh);
}

bool is_curve_better(std::span<const ValidatedFlight> flights, const HeldOutScore& of_curve,
                     const HeldOutScore& of_mean) {
    if (of_curve.mean_absolute_error_percent > (1.0 - min_gain_of_curve) * of_mean.mean_absolute_error_percent)
        return false;
    const auto nearer = std::ranges::count_if(
        flights, [](const auto& flight) { return error_wh(flight, curve) < error_wh(flight, mean_model); });
    return 2 * static_cast<std::size_t>(nearer) > flights.size();
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

std::optional<ModelValidation> validation_of(std::vector<ValidatedFlight> flights) {
    remove_rejected(flights);
    const auto of_mean = held_out_score(flights, mean_model);
    const auto of_curve = held_out_score(flights, curve);
    if (!of_mean || !of_curve) return std::nullopt;
    std::erase_if(flights, [](const auto& flight) { return !predicted_energy(flight, curve, std::nullopt); });
    ModelValidation validation{is_curve_better(flights, *of_curve, *of_mean), {*of_mean, *of_curve}};
    if (auto score = held_out_score(predicted_by(flights, physical), physical))
        validation.scores.push_back(*std::move(score));
    return validation;
}

void add_best_power(MechanicalModel& model, std::span<const MeasuredFlight> flights, const ModelFitOptions& options,
                    const std::function<void(std::size_t, std::size_t)>& progress) {
    if (flights.size() < 2) return;
    try {
        model.validation = validation_of(leave_one_out(validated_flights(flights), options, progress));
        const auto is_physical = [](const auto& score) { return score.model == physical; };
        if (!model.validation || std::ranges::none_of(model.validation->scores, is_physical)) return;
        std::vector<BinnedFlight> motions(flights.size());
        std::ranges::transform(flights, motions.begin(), &MeasuredFlight::motion);
        model.physical = fit_physical_model(motions).model;
    } catch (const NoResultError&) {  // the curves are the model then
        model.validation.reset();
    }
}

}  // namespace flightwatt::mechanical
