#include "mechanical/model_fit.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/statistics.h"
#include "mechanical/fit/error_analysis.h"
#include "mechanical/fit/flight_variation.h"
#include "mechanical/fit/flight_weights.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/frequency_scan.h"
#include "mechanical/fit/phase_fit.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <numeric>
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
        fmt::format("{}: the fit's coefficients are not finite: check the power of all samples", phase_word(phase)));
}

/// `points` fractions of a phase, from 0 to 1.
std::vector<double> even_fractions(std::size_t points) {
    std::vector<double> fractions(points);
    for (std::size_t i = 0; i < points; ++i) fractions[i] = static_cast<double>(i) / static_cast<double>(points - 1);
    return fractions;
}

/// The interval of a power; of one that is not below 0, without what is below 0.
Interval power_interval_w(double power_w, double error_w, double degrees_of_freedom) {
    auto interval = student_t_interval(power_w, error_w, degrees_of_freedom);
    if (power_w >= 0.0 && std::isfinite(interval.low)) interval.low = std::max(interval.low, 0.0);
    return interval;
}

/// The bands of one phase at `points` fractions of it.
CurveBand band_of(const ModelFit& fit, flight::Phase phase, const ErrorAnalysis& analysis, std::size_t points) {
    const auto& model = fit.model.phases[phase];
    CurveBand band;
    for (const double tau : even_fractions(points)) {
        band.time_s.push_back(tau * model.duration_s);
        const auto [low, high] =
            power_interval_w(power_w(model.fourier, band.time_s.back()), curve_standard_error_w(analysis, tau),
                             analysis.errors.degrees_of_freedom);
        band.low_95_w.push_back(low);
        band.high_95_w.push_back(high);
    }
    if (auto spread = compute_envelope(fit.fits[phase], fit.weights[phase], points)) {
        band.flights_low_w = std::move(spread->low_w);
        band.flights_high_w = std::move(spread->high_w);
        band.flights_sd_w = std::move(spread->standard_deviation_w);
    }
    return band;
}

/// The time [s] of a metre by a regression of durations on heights with this error: at most that of the mean flight, and
/// at least that of the quickest one, unless the regression surely is less: flights have parts that do not grow with
/// the height, as the last metres of a landing.
double bounded_s_per_m(double regression, double standard_error, double degrees_of_freedom, double quickest,
                       double mean) {
    constexpr double max_part_without_height = 0.5;
    const double usual_least = std::min(quickest, mean);
    if (!(regression > 0.0) || degrees_of_freedom < 1.0) return std::clamp(regression, usual_least, mean);
    const double high = student_t_interval(regression, standard_error, degrees_of_freedom).high;
    return std::clamp(regression, std::clamp(high, max_part_without_height * usual_least, usual_least), mean);
}

/// Heights of the flights that have one. Further height takes the time that the regression of the durations on the
/// heights makes it, within bounds.
std::optional<PhaseHeights> heights_of(const FittedPhase& fitted) {
    double weights = 0.0, time_s = 0.0, covariance = 0.0, variance = 0.0, residuals = 0.0, flights = 0.0;
    PhaseHeights heights{0.0, std::numeric_limits<double>::infinity(), 0.0, 0.0};
    const auto for_each_height = [&](const auto& use) {
        for (std::size_t i = 0; i < fitted.samples.size(); ++i)
            if (const auto& flight = fitted.samples[i]; flight.height_m && fitted.weights[i] > 0.0)
                use(fitted.weights[i], *flight.height_m, flight.duration_s);
    };
    double quickest_s_per_m = std::numeric_limits<double>::infinity();
    for_each_height([&](double weight, double height_m, double duration_s) {
        weights += weight;
        flights += 1.0;
        heights.mean_m += weight * height_m;
        time_s += weight * duration_s;
        heights.low_m = std::min(heights.low_m, height_m);
        heights.high_m = std::max(heights.high_m, height_m);
        quickest_s_per_m = std::min(quickest_s_per_m, duration_s / height_m);
    });
    if (weights == 0.0) return std::nullopt;
    heights.mean_m = std::clamp(heights.mean_m / weights, heights.low_m, heights.high_m);
    time_s /= weights;
    for_each_height([&](double weight, double height_m, double duration_s) {
        covariance += weight * (height_m - heights.mean_m) * (duration_s - time_s);
        variance += weight * std::pow(height_m - heights.mean_m, 2);
    });
    const double mean_s_per_m = time_s / heights.mean_m;
    const double regression_s_per_m = variance > 0.0 ? covariance / variance : mean_s_per_m;
    for_each_height([&](double weight, double height_m, double duration_s) {
        const double expected_s = time_s + regression_s_per_m * (height_m - heights.mean_m);
        residuals += weight * std::pow(duration_s - expected_s, 2);
    });
    const double degrees_of_freedom = variance > 0.0 ? flights - 2.0 : 0.0;
    const double standard_error = std::sqrt(residuals / std::max(degrees_of_freedom, 1.0) / std::max(variance, 1e-300));
    heights.m_per_s =
        1.0 / bounded_s_per_m(regression_s_per_m, standard_error, degrees_of_freedom, quickest_s_per_m, mean_s_per_m);
    return heights;
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
    fitted.model.heights = heights_of(fitted);
    require_finite(phase, fitted.model.fourier);
    fitted.model.level_spread = estimate_variance_components(fitted.model, fitted.samples);
    return fitted;
}

ModelFit fit_model(std::span<const FlightSamples> flights, const ModelFitOptions& options) {
    if (flights.empty())
        throw NoResultError(
            "no flight is left to fit: the messages state why each is left out; those with power faults are used by "
            "--keep NAME, those of a simulator by --simulated; else add a log of a whole flight, from take-off to landing");
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

std::optional<FlightEnvelope> compute_envelope(const PhaseFit& fit, std::span<const double> weights,
                                               std::size_t points) {
    const double squares = std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0);
    if (weights.size() < 2) return std::nullopt;
    FlightEnvelope spread;
    spread.effective_flights = 1.0 / squares;
    for (const double tau : even_fractions(points)) {
        std::vector<double> powers;
        for (const auto& flight : fit.flights) powers.push_back(power_w(flight.fourier, tau * flight.duration_s));
        const double mean = std::inner_product(weights.begin(), weights.end(), powers.begin(), 0.0);
        double square_sum = 0.0;
        for (std::size_t k = 0; k < powers.size(); ++k) square_sum += weights[k] * std::pow(powers[k] - mean, 2);
        const auto [low, high] = std::ranges::minmax(powers);
        spread.low_w.push_back(low);
        spread.high_w.push_back(high);
        spread.standard_deviation_w.push_back(std::sqrt(square_sum / (1.0 - squares)));
    }
    return spread;
}

flight::PerPhase<ErrorAnalysis> analyse_model(ModelFit& fit) {
    flight::PerPhase<ErrorAnalysis> analyses;
    for (const auto phase : flight::all_phases) {
        analyses[phase] = analyse_errors(fit.samples[phase], fit.fits[phase], fit.weights[phase]);
        const auto& [theta_rad, range, flights, rms_w, samples, r, freedom, rivals, clamped] = fit.fits[phase];
        const auto size = coefficient_count(static_cast<int>(flights.front().fourier.cos_w.size()));
        if (samples > flights.size() * static_cast<std::size_t>(size))  // else they determine no residual
            fit.model.phases[phase].errors = analyses[phase].errors;
        fit.model.phases[phase].spread = compute_envelope(fit.fits[phase], fit.weights[phase]);
    }
    return analyses;
}

flight::PerPhase<CurveBand> curve_bands(const ModelFit& fit, const flight::PerPhase<ErrorAnalysis>& analyses) {
    constexpr std::size_t points = 101;
    flight::PerPhase<CurveBand> bands;
    for (const auto phase : flight::all_phases) bands[phase] = band_of(fit, phase, analyses[phase], points);
    return bands;
}

std::string curves_csv(const ModelFit& fit, const flight::PerPhase<ErrorAnalysis>& analyses) {
    constexpr int digits = 6;
    CsvWriter csv({"phase", "tau", "time_s", "power_w", "standard_error_w", "low_95_w", "high_95_w", "flights_low_w",
                   "flights_high_w", "flights_sd_w", "population_low_95_w", "population_high_95_w"},
                  digits);
    for (const auto phase : flight::all_phases) {
        const auto& model = fit.model.phases[phase];
        const auto band =
            band_of(fit, phase, analyses[phase], curve_point_count(model.fourier, model.duration_s) / 5 + 1);
        const double half_width = student_t_half_width(analyses[phase].errors.degrees_of_freedom);
        const auto& weights = fit.weights[phase];
        const double flights = 1.0 / std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0);
        for (std::size_t i = 0; i < band.time_s.size(); ++i) {
            const double power = power_w(model.fourier, band.time_s[i]);
            const auto of_flights = [&](const std::vector<double>& values) {
                return values.empty() ? std::nullopt : std::optional(values[i]);
            };
            std::optional<Interval> population;  // the mean of all flights like these, of which these are a sample
            if (const auto sd_w = of_flights(band.flights_sd_w))
                population = power_interval_w(power, *sd_w / std::sqrt(flights), flights - 1.0);
            csv.add(to_string(phase), band.time_s[i] / model.duration_s, band.time_s[i], power,
                    (band.high_95_w[i] - power) / half_width, band.low_95_w[i], band.high_95_w[i],
                    of_flights(band.flights_low_w), of_flights(band.flights_high_w), of_flights(band.flights_sd_w),
                    population ? std::optional(population->low) : std::nullopt,
                    population ? std::optional(population->high) : std::nullopt);
        }
    }
    return csv.text();
}

}  // namespace flightwatt::mechanical
