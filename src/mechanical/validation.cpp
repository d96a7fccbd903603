#include "mechanical/validation.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/statistics.h"
#include "base/units.h"
#include "mechanical/fit/flight_variation.h"
#include "mechanical/physical_fit.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <set>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// The flights without those that are left out together.
struct Others {
    std::vector<FlightSamples> samples;
    flight::PerPhase<std::vector<PhaseSamples>> phases;
    std::optional<PhysicalModel> physical;
    flight::PerPhase<std::optional<WeightedPhase>> forecasts;  ///< made where one is asked for
};

/// One phase of the excluded flight, and the others that have this phase.
struct Fold {
    flight::Phase phase;
    const PhaseSamples& flown;
    const std::vector<PhaseSamples>& others;
    std::size_t nearest;  ///< among `others`
    Others& all;
    const ModelFitOptions& options;
};

const WeightedPhase& forecast_of_others(const Fold& fold) {
    auto& forecast = fold.all.forecasts[fold.phase];
    if (!forecast) {
        const auto fitted = fit_phase_model(fold.phase, fold.others, fold.options);
        forecast = {fitted.model,
                    std::inner_product(fitted.weights.begin(), fitted.weights.end(), fitted.weights.begin(), 0.0)};
    }
    return *forecast;
}

using Estimates = std::vector<std::pair<std::string, EnergyEstimate>>;

EnergyEstimate after(double known_wh, EnergyEstimate rest) {
    rest.energy_wh += known_wh;
    return rest;
}

/// By the motion that was flown.
std::optional<EnergyEstimate> physical_estimate(const MeasuredFlight& flight, const Fold& fold) {
    if (!fold.all.physical || flight.motion.bins.empty()) return std::nullopt;
    std::vector<FlightBin> bins;
    for (const auto& bin : flight.motion.bins)
        if (bin.phase == fold.phase) bins.push_back(bin);
    if (bins.empty()) return energy_of(constant_mean(fold.others), fold.flown.duration_s);
    return predict_physical(*fold.all.physical, mean_values(bins), fold.flown.duration_s);
}

Estimates predict_phase(const Fold& fold) {
    const double duration_s = fold.flown.duration_s;
    return {{"fourier", predict_before_flight(forecast_of_others(fold), duration_s)},
            {"constant_mean", energy_of(constant_mean(fold.others), duration_s)},
            {"nearest_flight", energy_of(single_flight_power(fold.others, fold.nearest), duration_s)}};
}

/// The landing of a flight in the air: all models that look at the cruise say what the Fourier series says.
Estimates predict_landing_in_flight(const Fold& fold) {
    auto estimates = predict_phase(fold);
    const auto fourier = estimates.front().second;
    estimates.emplace_back("in_flight", fourier);
    estimates.emplace_back("in_flight_constant", fourier);
    estimates.emplace_back("in_flight_physical", fourier);
    return estimates;
}

Estimates predict_cruise_in_flight(const Fold& fold, const MeasuredFlight& excluded, double remaining_s) {
    const auto& flown = *excluded.flown;
    const auto& ahead = excluded.remaining_cruise;
    const auto& forecast = forecast_of_others(fold);
    const double known_wh = flown.cruise_energy_wh;
    Estimates estimates{
        {"fourier", after(known_wh, predict_remaining_before_flight(forecast, flown.cruise_s(), remaining_s))},
        {"constant_mean", after(known_wh, energy_of(constant_mean(fold.others), remaining_s))},
        {"nearest_flight", after(known_wh, energy_of(single_flight_power(fold.others, fold.nearest), remaining_s))}};
    if (!forecast.model.level_spread) return estimates;
    const auto update = [&](const char* name, CruisePrior source) {
        estimates.emplace_back(name,
                               after(known_wh, predict_remaining_cruise(forecast, flown, remaining_s, source).energy));
    };
    update("in_flight", CruisePrior::curve);
    update("in_flight_constant", CruisePrior::constant);
    if (fold.all.physical && fold.all.physical->level_sd && !ahead.empty()) {
        const auto rest = predict_remaining_physical(*fold.all.physical, flown, {mean_values(ahead), remaining_s});
        estimates.emplace_back("in_flight_physical", after(known_wh, rest.energy));
    }
    return estimates;
}

Estimates estimates_of(const MeasuredFlight& excluded, const Fold& fold) {
    if (!excluded.flown) {
        auto estimates = predict_phase(fold);
        if (const auto physical = physical_estimate(excluded, fold)) estimates.emplace_back("physical", *physical);
        return estimates;
    }
    if (fold.phase == flight::Phase::takeoff) return {};
    if (fold.phase == flight::Phase::landing) return predict_landing_in_flight(fold);
    const double remaining_s = fold.flown.duration_s - excluded.flown->cruise_s();
    if (remaining_s <= 0.0) return {};
    return predict_cruise_in_flight(fold, excluded, remaining_s);
}

FlightPrediction& prediction_of(ValidatedFlight& flight, const std::string& model) {
    const auto found = std::ranges::find(flight.predictions, model, &FlightPrediction::model);
    if (found != flight.predictions.end()) return *found;
    return flight.predictions.emplace_back(FlightPrediction{model, {}});
}

/// std::nullopt where the flights' motion does not tell their power.
std::optional<PhysicalModel> physical_model_of(std::span<const BinnedFlight> flights) {
    try {
        return fit_physical_model(flights).model;
    } catch (const NoResultError&) {
        return std::nullopt;
    }
}

/// `samples` are the flights', with their scans. `excluded` rise.
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
        if (!excluded.samples.phases[phase]) continue;
        const auto nearest = nearest_flight(others.samples, phase, excluded.samples);
        if (!nearest) continue;
        const Fold fold{phase, *excluded.samples.phases[phase], others.phases[phase], *nearest, others, options};
        for (const auto& [model, estimate] : estimates_of(excluded, fold)) {
            prediction_of(flight, model).phases[phase] = estimate;
            flight.measured_wh[phase] = excluded.energy_wh[phase];
            flight.counter_wh[phase] = excluded.counter_energy_wh[phase];
        }
    }
    // A model that cannot tell the cruise (no airspeed, no spread) only repeats others in the other phases.
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
        throw UsageError(fmt::format("flight '{}' is given twice: it would predict itself", flight.samples.flight));
    }
}

std::vector<ValidatedFlight> leave_one_out(std::span<const MeasuredFlight> flights, const ModelFitOptions& options,
                                           const std::function<void(std::size_t, std::size_t)>& progress,
                                           std::size_t max_folds) {
    if (flights.size() < 2) {
        throw NoResultError(fmt::format("{} flight{}: leaving one out needs 2 or more, and 3 for an interval",
                                        flights.size(), flights.size() == 1 ? "" : "s"));
    }
    require_distinct(flights);
    std::vector<FlightSamples> samples(flights.size());
    std::ranges::transform(flights, samples.begin(), &MeasuredFlight::samples);
    cache_scans(samples, options);
    const auto folds = make_folds(flights.size(), std::max<std::size_t>(2, max_folds));
    std::vector<ValidatedFlight> validated(flights.size());
    std::mutex mutex;  // guards what follows
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
