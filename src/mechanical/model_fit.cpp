#include "mechanical/model_fit.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/statistics.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/frequency_scan.h"
#include "mechanical/fit/phase_fit.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

std::vector<std::string> names_of(std::span<const FlightSamples> flights) {
    std::vector<std::string> names;
    for (const auto& flight : flights) {
        if (std::ranges::find(names, flight.flight) != names.end()) {
            throw UsageError(fmt::format("flight '{}' is given twice", flight.flight));
        }
        names.push_back(flight.flight);
    }
    return names;
}

std::string described(const ModelFitOptions& options, std::size_t flights) {
    return fmt::format("fitted to {} flight{}: Fourier series of order {} a phase, weights: {}; flightwatt {}", flights,
                       flights == 1 ? "" : "s", options.phases.order, to_string(options.weighting), FLIGHTWATT_VERSION);
}

/// Impossibly large power overflows.
void require_finite(flight::Phase phase, const FourierModel& model) {
    if (coefficients_of(model).allFinite()) return;
    throw NoResultError(
        fmt::format("{}: the fit's coefficients are not finite: check the power of all samples", to_string(phase)));
}

}  // namespace

std::vector<PhaseSamples> samples_of_phase(std::span<const FlightSamples> flights, flight::Phase phase) {
    std::vector<PhaseSamples> samples;
    for (const auto& flight : flights) {
        if (!flight.phases[phase] || flight.phases[phase]->tau.empty()) continue;
        samples.push_back(*flight.phases[phase]);
        samples.back().flight = flight.flight;
    }
    return samples;
}

void cache_scans(std::span<FlightSamples> flights, const ModelFitOptions& options) {
    if (options.phases.order <= 0) return;
    for (const auto phase : flight::all_phases) {
        const auto samples = samples_of_phase(flights, phase);
        const auto lacks_samples = [&](const auto& own) {
            return own.tau.size() < min_samples(options.phases.order) || own.tau.size() != own.power_w.size();
        };
        if (samples.empty() || std::ranges::any_of(samples, lacks_samples)) continue;
        std::optional<FrequencyRange> range;
        try {
            range = admissible_frequencies(samples, options.phases);
        } catch (const NoResultError&) {
            continue;  // the fits report it
        }
        for_each_in_parallel(flights.size(), [&](std::size_t i) {
            auto& own = flights[i].phases[phase];
            if (!own) return;
            auto centred = *own;
            const double mean_w = mean(own->power_w);
            for (double& power_w : centred.power_w) power_w -= mean_w;
            own->scan = std::make_shared<const FrequencyScan>(scan_flight(centred, options.phases.order, *range));
        });
    }
}

FittedPhase fit_phase_model(flight::Phase phase, std::span<const PhaseSamples> flights,
                            const ModelFitOptions& options) {
    FittedPhase fitted;
    std::string reason;
    const auto needed = min_samples(options.phases.order);
    std::ranges::copy_if(flights, std::back_inserter(fitted.samples),
                         [&](const auto& samples) { return samples.tau.size() >= needed; });
    try {
        if (fitted.samples.empty() && !flights.empty())
            throw NoResultError(
                fmt::format("a Fourier series of order {} needs {} samples of a flight", options.phases.order, needed));
        fitted.fit = fit_phase(phase, fitted.samples, options.phases);
    } catch (const NoResultError& error) {
        if (flights.empty() || options.phases.order == 0) throw;
        reason = error.what();
        fitted.samples.assign(flights.begin(), flights.end());
        fitted.fit = fit_phase(phase, flights, {.order = 0});
    }
    fitted.weights = flight_weights(fitted.fit, options.weighting);
    fitted.model = average_phase(fitted.fit, fitted.weights);
    if (!reason.empty()) fitted.model.power = {PowerBasis::mean, std::move(reason)};
    for (const auto& samples : fitted.samples) fitted.model.edge_samples += samples.edge_samples;
    require_finite(phase, fitted.model.fourier);
    fitted.model.level_spread = estimate_variance_components(fitted.model, fitted.samples);
    return fitted;
}

ModelFit fit_model(std::span<const FlightSamples> flights, const ModelFitOptions& options) {
    const auto names = names_of(flights);
    ModelFit parts;
    auto& model = parts.model;
    model.name = options.name;
    model.description = described(options, flights.size());
    model.weighting = to_string(options.weighting);
    for (const auto& name : names) model.flights.push_back({name, {}});
    for (const auto& flight : flights) model.pack_voltage_v = std::max(model.pack_voltage_v, flight.pack_voltage_v);

    for (const auto phase : flight::all_phases) {
        auto fitted = fit_phase_model(phase, samples_of_phase(flights, phase), options);
        model.phases[phase] = fitted.model;
        std::size_t i = 0;
        for (auto& owner : model.flights) {
            if (i == fitted.samples.size() || fitted.samples[i].flight != owner.flight) continue;
            const auto& curve = fitted.fit.flights[i];
            owner.phases[phase] = PhaseContribution{fitted.weights[i], curve.duration_s, curve.rms_w, curve.samples,
                                                    mean_power_w(fitted.samples[i])};
            ++i;
        }
        parts.samples[phase] = std::move(fitted.samples);
        parts.fits[phase] = std::move(fitted.fit);
        parts.weights[phase] = std::move(fitted.weights);
    }
    return parts;
}

std::optional<FourierModel> fit_series(const PhaseModel& model, std::span<const double> tau,
                                       std::span<const double> power_w) {
    const auto order = static_cast<int>(model.fourier.cos_w.size());
    const double theta_rad = model.fourier.omega_rad_per_s * model.duration_s;
    const auto fit = solve_least_squares(fourier_basis(tau, order, theta_rad), as_vector(power_w));
    if (!fit) return std::nullopt;
    return series_of(fit->coefficients, model.fourier.omega_rad_per_s);
}

}  // namespace flightwatt::mechanical
