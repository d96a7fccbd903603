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

std::string described(const ModelFitOptions& options, std::size_t flights) {
    return fmt::format(
        "fitted to {} flight{}: Fourier series of order {} a phase, weights: {}; flightwatt {}", flights,
        flights == 1 ? "" : "s", options.phases.order, to_string(options.weights.weighting),
        FLIGHTWATT_VERSION);
}

}  // namespace

MechanicalModel fit_mechanical_model(std::span<const FlightSamples> flights, const ModelFitOptions& options) {
    const auto names = names_of(flights);
    check_weights(options.weights, names);
    MechanicalModel model;
    model.name = options.name;
    model.description = described(options, flights.size());
    model.weighting = to_string(options.weights.weighting);
    for (const auto& name : names) model.flights.push_back({name, {}});

    for (const auto phase : all_phases) {
        std::vector<PhaseSamples> samples;
        std::vector<std::size_t> owners;
        for (std::size_t i = 0; i < flights.size(); ++i) {
            if (!flights[i].phases[phase]) continue;
            samples.push_back(*flights[i].phases[phase]);
            samples.back().flight = names[i];
            owners.push_back(i);
        }
        const auto fit = fit_phase(phase, samples, options.phases);
        const auto weights = flight_weights(fit, phase, options.weights);
        model.phases[phase] = average_phase(fit, weights);
        for (std::size_t i = 0; i < owners.size(); ++i) {
            const auto& curve = fit.flights[i];
            model.flights[owners[i]].phases[phase] =
                PhaseContribution{weights[i], curve.duration_s, curve.rms_w, curve.samples};
        }
    }
    return model;
}

}  // namespace flightwatt
