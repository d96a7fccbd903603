#include "mechanical/model_fit.h"

#include "base/error.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace flightwatt {
namespace {

std::vector<std::string> names_of(std::span<const FlightSamples> flights) {
    std::vector<std::string> names;
    for (const auto& flight : flights) {
        if (std::find(names.begin(), names.end(), flight.flight) != names.end()) {
            throw UsageError(fmt::format("flight '{}' is given twice", flight.flight));
        }
        names.push_back(flight.flight);
    }
    return names;
}

std::string orders_of(const ModelFitOptions& options) {
    const int takeoff = options.order(Phase::takeoff);
    const int cruise = options.order(Phase::cruise);
    const int landing = options.order(Phase::landing);
    if (takeoff == cruise && cruise == landing) return fmt::format("of order {} a phase", takeoff);
    return fmt::format("of orders {} (take-off), {} (cruise), {} (landing)", takeoff, cruise, landing);
}

std::string described(const ModelFitOptions& options, std::size_t flights) {
    const auto loss = options.phases.loss;
    return fmt::format("fitted to {} flight{}: Fourier series {}, {}weights: {}; flightwatt {}", flights,
                       flights == 1 ? "" : "s", orders_of(options),
                       loss == Loss::none ? "" : fmt::format("loss: {}, ", to_string(loss)),
                       to_string(options.weights.weighting), FLIGHTWATT_VERSION);
}

}  // namespace

std::vector<PhaseSamples> samples_of_phase(std::span<const FlightSamples> flights, Phase phase) {
    std::vector<PhaseSamples> samples;
    for (const auto& flight : flights) {
        if (!flight.phases[phase]) continue;
        samples.push_back(*flight.phases[phase]);
        samples.back().flight = flight.flight;
    }
    return samples;
}

MechanicalModel fit_mechanical_model(std::span<const FlightSamples> flights, const ModelFitOptions& options) {
    return fit_model(flights, options).model;
}

ModelFit fit_model(std::span<const FlightSamples> flights, const ModelFitOptions& options) {
    const auto names = names_of(flights);
    check_weights(options.weights, names);
    ModelFit parts;
    auto& model = parts.model;
    model.name = options.name;
    model.description = described(options, flights.size());
    model.weighting = to_string(options.weights.weighting);
    for (const auto& name : names) model.flights.push_back({name, {}});

    for (const auto phase : all_phases) {
        auto& fit = parts.fits[phase];
        auto& weights = parts.weights[phase];
        parts.samples[phase] = samples_of_phase(flights, phase);
        auto phase_options = options.phases;
        phase_options.order = options.order(phase);
        fit = fit_phase(phase, parts.samples[phase], phase_options);
        weights = flight_weights(fit, phase, options.weights);
        model.phases[phase] = average_phase(fit, weights);
        std::size_t i = 0;
        for (std::size_t owner = 0; owner < flights.size(); ++owner) {
            if (!flights[owner].phases[phase]) continue;
            const auto& curve = fit.flights[i];
            model.flights[owner].phases[phase] =
                PhaseContribution{weights[i], curve.duration_s, curve.rms_w, curve.samples};
            ++i;
        }
    }
    return parts;
}

}  // namespace flightwatt
