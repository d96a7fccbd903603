#include "mechanical/validation.h"

#include "base/error.h"
#include "base/units.h"
#include "mechanical/fit/level_law_fit.h"
#include "mechanical/prediction.h"
#include "mechanical/validation/baselines.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// One phase of the flight left out, and the others that have this phase.
struct Fold {
    flight::Phase phase;
    const PhaseSamples& flown;
    std::vector<PhaseSamples> others;
    std::optional<std::size_t> nearest;  ///< among `others`
};

std::vector<PhaseSamples> phases_of(std::span<const FlightSamples> flights, flight::Phase phase) {
    std::vector<PhaseSamples> samples;
    for (const auto& flight : flights) {
        if (flight.phases[phase]) samples.push_back(*flight.phases[phase]);
    }
    return samples;
}

/// The nearest flight by the durations of all phases, among those that have this one.
std::optional<std::size_t> nearest_with(flight::Phase phase, std::span<const FlightSamples> flights,
                                        const FlightSamples& left_out) {
    std::vector<FlightSamples> having;
    std::copy_if(flights.begin(), flights.end(), std::back_inserter(having),
                 [&](const FlightSamples& flight) { return flight.phases[phase].has_value(); });
    flight::PerPhase<std::optional<double>> durations;
    for (const auto p : flight::all_phases) {
        if (left_out.phases[p]) durations[p] = left_out.phases[p]->duration_s;
    }
    return nearest_flight(having, durations);
}

PhaseForecast forecast_of_others(const Fold& fold, const ModelFitOptions& options) {
    const auto fitted = fit_phase_model(fold.phase, fold.others, options);
    return {fitted.model,
            std::inner_product(fitted.weights.begin(), fitted.weights.end(), fitted.weights.begin(), 0.0)};
}

using Estimates = std::vector<std::pair<std::string, EnergyEstimate>>;

/// What is known for certain, and what is predicted on top.
EnergyEstimate after(double known_wh, EnergyEstimate rest) {
    rest.energy_wh += known_wh;
    return rest;
}

std::string model_of(Covariate covariate) { return fmt::format("by_{}", to_string(covariate)); }

void add_covariates(Estimates& estimates, const Fold& fold, std::span<const Covariate> covariates) {
    const double duration_s = fold.flown.duration_s;
    for (const auto covariate : covariates) {
        const auto power = fold.phase == flight::Phase::cruise
                               ? power_by_covariate(fold.others, covariate, fold.flown.covariates[covariate])
                               : constant_mean(fold.others);
        if (power) estimates.emplace_back(model_of(covariate), energy_of(*power, duration_s));
    }
}

Estimates predict_phase(const Fold& fold, const ModelFitOptions& options) {
    const double duration_s = fold.flown.duration_s;
    const auto mean = constant_mean(fold.others);
    Estimates estimates{
        {"fourier", predict_before_flight(forecast_of_others(fold, options), duration_s)},
        {"constant_mean", energy_of(mean, duration_s)},
        {"nearest_flight", energy_of(power_of_flight(fold.others, fold.nearest.value()), duration_s)}};
    if (fold.phase != flight::Phase::cruise) {
        estimates.emplace_back("airspeed_cubed", energy_of(mean, duration_s));
    } else if (const auto power = power_by_covariate(fold.others, Covariate::airspeed_cubed,
                                                     fold.flown.airspeed_cubed_m3_per_s3)) {
        estimates.emplace_back("airspeed_cubed", energy_of(*power, duration_s));
    }
    return estimates;
}

/// The landing of a flight in the air: all models that look at the cruise say what the Fourier series says.
Estimates predict_landing_in_flight(const Fold& fold, const ModelFitOptions& options) {
    auto estimates = predict_phase(fold, options);
    std::erase_if(estimates, [](const auto& entry) { return entry.first == "airspeed_cubed"; });
    const auto fourier = estimates.front().second;
    estimates.emplace_back("in_flight", fourier);
    estimates.emplace_back("in_flight_constant", fourier);
    estimates.emplace_back("in_flight_airspeed", fourier);
    return estimates;
}

Estimates predict_cruise_in_flight(const Fold& fold, const FlightProgress& flown, double remaining_s,
                                   const ModelFitOptions& options) {
    const auto forecast = forecast_of_others(fold, options);
    const double known_wh = flown.cruise_energy_wh;
    Estimates estimates{
        {"fourier", after(known_wh, predict_rest_before_flight(forecast, flown.cruise_s(), remaining_s))},
        {"constant_mean", after(known_wh, energy_of(constant_mean(fold.others), remaining_s))},
        {"nearest_flight",
         after(known_wh, energy_of(power_of_flight(fold.others, fold.nearest.value()), remaining_s))}};
    if (!forecast.model.level_spread) return estimates;
    const auto update = [&](const char* name, LevelSource source) {
        estimates.emplace_back(name,
                               after(known_wh, predict_rest(forecast, flown, remaining_s, source).energy));
    };
    update("in_flight", LevelSource::curve);
    update("in_flight_constant", LevelSource::constant);
    if (forecast.model.airspeed_law && flown.airspeed_cubed_m3_per_s3) {
        update("in_flight_airspeed", LevelSource::airspeed);
    }
    return estimates;
}

Estimates estimates_of(const MeasuredFlight& left_out, const Fold& fold, const ModelFitOptions& options,
                       std::span<const Covariate> covariates) {
    if (!left_out.flown) {
        auto estimates = predict_phase(fold, options);
        add_covariates(estimates, fold, covariates);
        return estimates;
    }
    if (fold.phase == flight::Phase::takeoff) return {};
    if (fold.phase == flight::Phase::landing) return predict_landing_in_flight(fold, options);
    const double remaining_s = fold.flown.duration_s - left_out.flown->cruise_s();
    if (remaining_s <= 0.0) return {};
    return predict_cruise_in_flight(fold, *left_out.flown, remaining_s, options);
}

FlightPrediction& prediction_of(ValidatedFlight& flight, const std::string& model) {
    const auto found = std::find_if(flight.predictions.begin(), flight.predictions.end(),
                                    [&](const auto& prediction) { return prediction.model == model; });
    if (found != flight.predictions.end()) return *found;
    return flight.predictions.emplace_back(FlightPrediction{model, {}});
}

ValidatedFlight validate_flight(const MeasuredFlight& left_out, std::span<const FlightSamples> others,
                                const ModelFitOptions& options, std::span<const Covariate> covariates) {
    ValidatedFlight flight{left_out.samples.flight, {}, {}, {}};
    for (const auto phase : flight::all_phases) {
        if (!left_out.samples.phases[phase]) continue;
        const Fold fold{phase, *left_out.samples.phases[phase], phases_of(others, phase),
                        nearest_with(phase, others, left_out.samples)};
        if (fold.others.empty()) continue;
        for (const auto& [model, estimate] : estimates_of(left_out, fold, options, covariates)) {
            prediction_of(flight, model).phases[phase] = estimate;
            flight.measured_wh[phase] = left_out.energy_wh[phase];
            flight.counter_wh[phase] = left_out.counter_energy_wh[phase];
        }
    }
    // A model that cannot tell the cruise (no airspeed, no spread) only repeats others in the other phases.
    if (flight.measured_wh[flight::Phase::cruise]) {
        std::erase_if(flight.predictions,
                      [](const auto& prediction) { return !prediction.phases[flight::Phase::cruise]; });
    }
    return flight;
}

}  // namespace

std::vector<ValidatedFlight> leave_one_out(std::span<const MeasuredFlight> flights,
                                           const ModelFitOptions& options,
                                           std::span<const Covariate> covariates) {
    if (flights.size() < 2) {
        throw NoAnswerError(fmt::format("{} flight{}: leaving one out needs 2 or more, and 3 for an interval",
                                        flights.size(), flights.size() == 1 ? "" : "s"));
    }
    for (std::size_t i = 0; i < flights.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (flights[i].samples.flight != flights[j].samples.flight) continue;
            throw UsageError(fmt::format("flight '{}' is given twice: it would predict itself",
                                         flights[i].samples.flight));
        }
    }
    std::vector<ValidatedFlight> validated;
    for (std::size_t left_out = 0; left_out < flights.size(); ++left_out) {
        std::vector<FlightSamples> others;
        for (std::size_t i = 0; i < flights.size(); ++i) {
            if (i != left_out) others.push_back(flights[i].samples);
        }
        validated.push_back(validate_flight(flights[left_out], others, options, covariates));
    }
    return validated;
}

}  // namespace flightwatt::mechanical
