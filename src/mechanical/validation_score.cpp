#include "mechanical/validation_score.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::mechanical {
namespace {

const FlightPrediction* find_prediction(const ValidatedFlight& flight, const std::string& model) {
    const auto found = std::find_if(flight.predictions.begin(), flight.predictions.end(),
                                    [&](const auto& prediction) { return prediction.model == model; });
    return found == flight.predictions.end() ? nullptr : &*found;
}

bool was_predicted(const ValidatedFlight& flight, std::optional<flight::Phase> phase) {
    return std::any_of(flight::all_phases.begin(), flight::all_phases.end(), [&](flight::Phase p) {
        return (!phase || p == *phase) && flight.measured_wh[p].has_value();
    });
}

}  // namespace

std::optional<PredictedEnergy> predicted_energy(const ValidatedFlight& flight, const std::string& model,
                                                std::optional<flight::Phase> phase) {
    const auto* prediction = find_prediction(flight, model);
    if (prediction == nullptr || !was_predicted(flight, phase)) return std::nullopt;
    PredictedEnergy energy;
    for (const auto p : flight::all_phases) {
        if ((phase && p != *phase) || !flight.measured_wh[p]) continue;
        if (!prediction->phases[p]) return std::nullopt;
        energy.measured_wh += *flight.measured_wh[p];
        energy.estimate = sum_of(energy.estimate, *prediction->phases[p]);
    }
    return energy;
}

std::optional<ModelScore> score_of(std::span<const ValidatedFlight> flights, const std::string& model,
                                   std::optional<flight::Phase> phase) {
    ModelScore score;
    double percent = 0.0;
    std::size_t covered = 0;
    std::size_t with_interval = 0;
    for (const auto& flight : flights) {
        if (!was_predicted(flight, phase)) continue;
        const auto energy = predicted_energy(flight, model, phase);
        if (!energy) return std::nullopt;
        const double error_wh = energy->estimate.energy_wh - energy->measured_wh;
        ++score.flights;
        score.mean_absolute_error_wh += std::abs(error_wh);
        score.bias_wh += error_wh;
        percent += units::percent_of(std::abs(error_wh), energy->measured_wh);
        if (const auto interval = interval_95(energy->estimate)) {
            ++with_interval;
            if (interval->contains(energy->measured_wh)) ++covered;
        }
    }
    if (score.flights == 0) return std::nullopt;
    const auto count = static_cast<double>(score.flights);
    score.mean_absolute_error_wh /= count;
    score.bias_wh /= count;
    if (phase != flight::Phase::landing && std::isfinite(percent))
        score.mean_absolute_error_percent = percent / count;
    if (with_interval > 0)
        score.coverage_95 = static_cast<double>(covered) / static_cast<double>(with_interval);
    return score;
}

std::vector<std::string> model_names(std::span<const ValidatedFlight> flights) {
    std::vector<std::string> names;
    for (const auto& flight : flights) {
        for (const auto& prediction : flight.predictions) {
            if (std::find(names.begin(), names.end(), prediction.model) == names.end()) {
                names.push_back(prediction.model);
            }
        }
    }
    return names;
}

}  // namespace flightwatt::mechanical
