#include "mechanical/validation.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/statistics.h"
#include "base/units.h"
#include "mechanical/fit/phase_fit.h"
#include "mechanical/physical_fit.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <set>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// The flights that are not left out, and the models fitted to them.
struct Others {
    std::vector<FlightSamples> samples;
    flight::PerPhase<std::vector<PhaseSamples>> phases;
    std::optional<PhysicalModel> physical;
    flight::PerPhase<std::optional<WeightedPhase>> forecasts;  ///< fitted on first use
};

const WeightedPhase& forecast_of_others(Others& others, flight::Phase phase, const ModelFitOptions& options) {
    auto& forecast = others.forecasts[phase];
    if (!forecast) {
        const auto fitted = fit_phase_model(phase, others.phases[phase], options);
        forecast = {fitted.model,
                    std::inner_product(fitted.weights.begin(), fitted.weights.end(), fitted.weights.begin(), 0.0)};
    }
    return *forecast;
}

using Estimates = std::vector<std::pair<std::string, EnergyEstimate>>;

/// One phase of a flight that has not taken off, from its duration and motion.
Estimates predict_phase(const MeasuredFlight& flight, flight::Phase phase, double duration_s, const Others& others,
                        const WeightedPhase& forecast) {
    const auto by_mean = energy_of(constant_mean(others.phases[phase]), duration_s);
    Estimates estimates{{"fourier", predict_before_flight(forecast, duration_s)}, {"constant_mean", by_mean}};
    if (flight.flown || !others.physical || flight.motion.bins.empty()) return estimates;
    std::vector<FlightBin> bins;
    for (const auto& bin : flight.motion.bins)
        if (bin.phase == phase) bins.push_back(bin);
    estimates.emplace_back(
        "physical", bins.empty()
                        ? by_mean
                        : energy_of(predicted_power(*others.physical, mean_values(bins), duration_s), duration_s));
    return estimates;
}

/// The whole cruise of a flight in the air: the energy measured so far and the remaining cruise's.
Estimates predict_cruise_in_flight(const MeasuredFlight& flight, double remaining_s, const Others& others,
                                   const WeightedPhase& forecast) {
    const auto& flown = *flight.flown;
    Estimates estimates{{"fourier", predict_remaining_before_flight(forecast, flown.cruise_s(), remaining_s)},
                        {"constant_mean", energy_of(constant_mean(others.phases[flight::Phase::cruise]), remaining_s)}};
    if (forecast.model.level_spread) {
        for (const auto& [name, prior] :
             {std::pair{"in_flight", CruisePrior::curve}, {"in_flight_constant", CruisePrior::constant}})
            estimates.emplace_back(name, predict_remaining_cruise(forecast, flown, remaining_s, prior).energy);
        if (others.physical && others.physical->level_sd && !flight.remaining_cruise.empty())
            estimates.emplace_back(
                "in_flight_physical",
                predict_remaining_physical(*others.physical, flown, {mean_values(flight.remaining_cruise), remaining_s})
                    .energy);
    }
    for (auto& [name, estimate] : estimates) estimate.energy_wh += flown.cruise_energy_wh;
    return estimates;
}

/// Of a phase that other flights have too.
Estimates estimates_of(const MeasuredFlight& flight, flight::Phase phase, Others& others,
                       const ModelFitOptions& options) {
    const double duration_s = flight.samples.phases[phase]->duration_s;
    if (flight.flown && phase == flight::Phase::takeoff) return {};
    const double remaining_s = flight.flown ? duration_s - flight.flown->cruise_s() : 0.0;
    const bool is_flying = flight.flown && phase == flight::Phase::cruise;
    if (is_flying && remaining_s <= 0.0) return {};
    const auto& forecast = forecast_of_others(others, phase, options);
    if (is_flying) return predict_cruise_in_flight(flight, remaining_s, others, forecast);
    auto estimates = predict_phase(flight, phase, duration_s, others, forecast);
    // Models that observe the cruise predict the landing by the curve.
    const auto by_curve = estimates.front().second;
    if (flight.flown)
        for (const auto* model : {"in_flight", "in_flight_constant", "in_flight_physical"})
            estimates.emplace_back(model, by_curve);
    return estimates;
}

FlightPrediction& prediction_of(ValidatedFlight& flight, const std::string& model) {
    const auto found = std::ranges::find(flight.predictions, model, &FlightPrediction::model);
    if (found != flight.predictions.end()) return *found;
    return flight.predictions.emplace_back(FlightPrediction{model, {}});
}

/// std::nullopt where the flights' motion does not determine their power.
std::optional<PhysicalModel> physical_model_of(std::span<const BinnedFlight> flights) {
    try {
        return fit_physical_model(flights).model;
    } catch (const NoResultError&) {
        return std::nullopt;
    }
}

/// `samples` are the flights', with their scans. `excluded` are in ascending order.
Others others_of(std::span<const MeasuredFlight> flights, std::span<const FlightSamples> samples,
                 const std::vector<std::size_t>& excluded) {
    Others others;
    std::vector<BinnedFlight> motions;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        if (std::ranges::binary_search(excluded, i)) continue;
        others.samples.push_back(samples[i]);
        motions.push_back(flights[i].motion);
    }
    for (const auto phase : flight::all_phases) others.phases[phase] = samples_of_phase(others.samples, phase);
    const auto was_measured = [&](std::size_t i) { return !flights[i].motion.bins.empty(); };
    if (std::ranges::any_of(excluded, was_measured)) others.physical = physical_model_of(motions);
    return others;
}

ValidatedFlight validate_flight(const MeasuredFlight& excluded, Others& others, const ModelFitOptions& options) {
    ValidatedFlight flight{excluded.samples.flight, {}, {}, {}};
    for (const auto phase : flight::all_phases) {
        if (!excluded.samples.phases[phase] || others.phases[phase].empty()) continue;
        for (const auto& [model, estimate] : estimates_of(excluded, phase, others, options)) {
            prediction_of(flight, model).phases[phase] = estimate;
            flight.measured_wh[phase] = excluded.energy_wh[phase];
            flight.counter_wh[phase] = excluded.counter_energy_wh[phase];
        }
    }
    // A model without a prediction of the cruise (no airspeed, no variability) repeats others in the other phases.
    if (flight.measured_wh[flight::Phase::cruise])
        std::erase_if(flight.predictions,
                      [](const auto& prediction) { return !prediction.phases[flight::Phase::cruise]; });
    return flight;
}

bool was_predicted(const ValidatedFlight& flight, std::optional<flight::Phase> phase) {
    return std::ranges::any_of(flight::all_phases, [&](flight::Phase p) {
        return (!phase || p == *phase) && flight.measured_wh[p].has_value();
    });
}

}  // namespace

void require_distinct(std::span<const MeasuredFlight> flights) {
    std::set<std::string> names;
    for (const auto& flight : flights) {
        if (names.insert(flight.samples.flight).second) continue;
        throw UsageError(fmt::format("flight '{}' is given twice", flight.samples.flight));
    }
}

std::vector<ValidatedFlight> leave_one_out(std::span<const MeasuredFlight> flights, const ModelFitOptions& options,
                                           const std::function<void(std::size_t, std::size_t)>& progress,
                                           std::size_t max_folds) {
    if (flights.size() < 2) {
        throw NoResultError(fmt::format("{} flight{}: cross-validation needs 2 or more, and 3 for an interval",
                                        flights.size(), flights.size() == 1 ? "" : "s"));
    }
    require_distinct(flights);
    std::vector<FlightSamples> samples(flights.size());
    std::ranges::transform(flights, samples.begin(), &MeasuredFlight::samples);
    cache_scans(samples, options);
    const auto folds = make_folds(flights.size(), std::max<std::size_t>(2, max_folds));
    std::vector<ValidatedFlight> validated(flights.size());
    std::mutex mutex;  // guards `done`
    std::size_t done = 0;
    for_each_in_parallel(folds.size(), [&](std::size_t fold) {
        auto others = others_of(flights, samples, folds[fold]);
        for (const auto i : folds[fold]) validated[i] = validate_flight(flights[i], others, options);
        if (!progress) return;
        const std::lock_guard lock(mutex);
        progress(++done, folds.size());
    });
    return validated;
}

std::optional<PredictedEnergy> predicted_energy(const ValidatedFlight& flight, const std::string& model,
                                                std::optional<flight::Phase> phase) {
    const auto prediction = std::ranges::find(flight.predictions, model, &FlightPrediction::model);
    if (prediction == flight.predictions.end() || !was_predicted(flight, phase)) return std::nullopt;
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
        percent += units::percentage(std::abs(error_wh), energy->measured_wh);
        if (const auto interval = interval_95(energy->estimate)) {
            ++with_interval;
            if (interval->contains(energy->measured_wh)) ++covered;
        }
    }
    if (score.flights == 0) return std::nullopt;
    const auto count = static_cast<double>(score.flights);
    score.mean_absolute_error_wh /= count;
    score.bias_wh /= count;
    if (phase != flight::Phase::landing && std::isfinite(percent)) score.mean_absolute_error_percent = percent / count;
    if (with_interval > 0) score.coverage_95 = static_cast<double>(covered) / static_cast<double>(with_interval);
    return score;
}

std::vector<std::string> model_names(std::span<const ValidatedFlight> flights) {
    std::vector<std::string> names;
    for (const auto& flight : flights) {
        for (const auto& prediction : flight.predictions) {
            if (std::ranges::find(names, prediction.model) == names.end()) names.push_back(prediction.model);
        }
    }
    return names;
}

}  // namespace flightwatt::mechanical
