#include "mechanical/validation.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "mechanical/fit/flight_variation.h"
#include "mechanical/physical_fit.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <mutex>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// The flights that are not left out, and the models fitted to them.
struct Others {
    std::vector<FlightSamples> samples;
    flight::PerPhase<std::vector<PhaseSamples>> phases;
    std::optional<PhysicalModel> physical;
    flight::PerPhase<std::optional<WeightedPhase>> forecasts;  ///< fitted on first use
    PhaseCorrelations correlations;
};

void forecast_of_others(Others& others, flight::Phase phase, const ModelFitOptions& options) {
    auto& forecast = others.forecasts[phase];
    if (forecast) return;
    const auto fitted = fit_phase_model(phase, others.phases[phase], options);
    forecast = {fitted.model,
                std::inner_product(fitted.weights.begin(), fitted.weights.end(), fitted.weights.begin(), 0.0)};
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
    std::vector<flight::PerPhase<std::optional<double>>> mean_powers_w(others.samples.size());
    for (const auto phase : flight::all_phases) {
        others.phases[phase] = samples_of_phase(others.samples, phase);
        for (std::size_t i = 0; i < others.samples.size(); ++i)
            if (const auto& samples_of = others.samples[i].phases[phase])
                mean_powers_w[i][phase] = mean_power_w(*samples_of);
    }
    others.correlations = correlate_phases(mean_powers_w);
    const auto was_measured = [&](std::size_t i) { return !flights[i].motion.bins.empty(); };
    if (std::ranges::any_of(excluded, was_measured)) others.physical = physical_model_of(motions);
    return others;
}

/// The seconds and the motion of a flight that are predicted: all of it, or from a moment on.
struct PredictedPart {
    flight::PerPhase<double> flown_s;
    flight::PerPhase<double> ahead_s;
    std::vector<FlightBin> bins;

    std::vector<FlightBin> bins_of(flight::Phase phase) const {
        std::vector<FlightBin> of_phase;
        std::ranges::copy_if(bins, std::back_inserter(of_phase), [&](const auto& bin) { return bin.phase == phase; });
        return of_phase;
    }
};

/// Of phases that other flights have too, fitted.
PredictedPart predicted_part(const MeasuredFlight& flight, Others& others, const ModelFitOptions& options) {
    PredictedPart part{{}, {}, flight.flown ? flight.remaining : flight.motion.bins};
    for (const auto phase : flight::all_phases) {
        if (!flight.samples.phases[phase] || others.phases[phase].empty()) continue;
        const double duration_s = flight.samples.phases[phase]->duration_s;
        if (flight.flown) part.flown_s[phase] = std::min(flight.flown->phases[phase].duration_s, duration_s);
        part.ahead_s[phase] = duration_s - part.flown_s[phase];
        if (part.ahead_s[phase] < 1e-3) part.ahead_s[phase] = 0.0;  // durations are rounded
        forecast_of_others(others, phase, options);
    }
    return part;
}

bool all_vary(const MeasuredFlight& flight, const PredictedPart& part, const Others& others) {
    return flight.flown && std::ranges::all_of(flight::all_phases, [&](auto phase) {
               return part.flown_s[phase] + part.ahead_s[phase] <= 0.0 || others.forecasts[phase]->model.level_spread;
           });
}

/// By the model of the motion, as it was flown; phases without motion by their estimates `otherwise`.
FlightPrediction predict_by_motion(const MeasuredFlight& flight, const PredictedPart& part, const PhysicalModel& model,
                                   const FlightPrediction& otherwise) {
    FlightPrediction prediction = otherwise;
    prediction.model = flight.flown ? "in_flight_physical" : "physical";
    const auto energy_ahead = [&](const TermValues& terms, double in_s, double duration_s) {
        if (!flight.flown) return energy_of(predicted_power(model, terms, duration_s), duration_s);
        auto flown = *flight.flown;
        flown.until_s += in_s;
        return predict_remaining_physical(model, flown, {terms, duration_s}).energy;
    };
    MotionAhead whole;
    bool has_all = true;
    for (const auto phase : flight::all_phases) {
        if (!(part.ahead_s[phase] > 0.0)) continue;
        // The glide of a wing that lands differs from all other motion (docs/validation.md, Airspeed and climb).
        const bool glides = flight.flown && phase == flight::Phase::landing && !flight.motion.is_rotorcraft;
        const auto bins = part.bins_of(phase);
        has_all = has_all && !bins.empty() && !glides;
        if (bins.empty() || glides) continue;
        const auto terms = mean_values(bins);
        prediction.phases[phase] = energy_ahead(terms, whole.duration_s, part.ahead_s[phase]);
        for (const auto term : all_power_terms) whole.mean_terms[term] += terms[term] * part.ahead_s[phase];
        whole.duration_s += part.ahead_s[phase];
    }
    if (whole.duration_s == 0.0) return prediction;
    for (auto& term : whole.mean_terms.values) term /= whole.duration_s;
    prediction.total = has_all ? energy_ahead(whole.mean_terms, 0.0, whole.duration_s)
                               : sum_of(prediction.phases,
                                        correlate_phases(std::span<const flight::PerPhase<std::optional<double>>>{}));
    return prediction;
}

double square_error_w2(const PhaseSamples& samples, const FourierModel& predicted) {
    double sum_w2 = 0.0;
    for (std::size_t i = 0; i < samples.tau.size(); ++i)
        sum_w2 += std::pow(samples.power_w[i] - power_w(predicted, samples.tau[i] * samples.duration_s), 2);
    return sum_w2 / static_cast<double>(samples.tau.size());
}

std::vector<FlightPrediction> predict_part(const MeasuredFlight& flight, const PredictedPart& part,
                                           const Others& others) {
    const auto& correlations = others.correlations;
    FlightPrediction by_curve{"fourier", {}, {}};
    FlightPrediction by_mean{"constant_mean", {}, {}};
    for (const auto phase : flight::all_phases) {
        const double ahead_s = part.ahead_s[phase];
        if (!(ahead_s > 0.0)) continue;
        const auto& forecast = *others.forecasts[phase];
        by_curve.phases[phase] = predict_remaining_before_flight(forecast, part.flown_s[phase], ahead_s);
        const auto power = constant_mean(others.phases[phase]);
        by_mean.phases[phase] = energy_of(power, ahead_s);
        if (flight.flown) continue;
        const auto& samples = *flight.samples.phases[phase];
        const auto curve = time_scaled_model(forecast.model, samples.duration_s, PhaseTimeScaling::scaled);
        by_curve.square_error_w2[phase] = square_error_w2(samples, curve);
        by_mean.square_error_w2[phase] = square_error_w2(samples, {1.0, power.mean_w, {}, {}});
    }
    for (auto* prediction : {&by_curve, &by_mean}) prediction->total = sum_of(prediction->phases, correlations);
    std::vector predictions{by_curve, by_mean};
    if (all_vary(flight, part, others)) {
        for (const auto& [name, prior] :
             {std::pair{"in_flight", CruisePrior::curve}, {"in_flight_constant", CruisePrior::constant}}) {
            auto flown = flight.flown->phases;
            for (const auto phase : flight::all_phases)
                if (!(part.flown_s[phase] > 0.0)) flown[phase] = {};
            const auto rest = predict_remaining_flight(others.forecasts, correlations, flown, part.ahead_s, prior);
            auto& prediction = predictions.emplace_back(FlightPrediction{name, {}, rest.total});
            for (const auto phase : flight::all_phases)
                if (part.ahead_s[phase] > 0.0) prediction.phases[phase] = rest.phases[phase].energy;
        }
    }
    const bool is_known =
        others.physical && !flight.motion.bins.empty() && (!flight.flown || others.physical->level_sd);
    if (is_known && (!flight.flown || predictions.size() > 2))
        predictions.push_back(
            predict_by_motion(flight, part, *others.physical, flight.flown ? predictions[2] : by_mean));
    return predictions;
}

ValidatedFlight validate_flight(const MeasuredFlight& excluded, Others& others, const ModelFitOptions& options) {
    ValidatedFlight flight{excluded.samples.flight, {}, {}, {}};
    const auto part = predicted_part(excluded, others, options);
    if (std::ranges::all_of(part.ahead_s.values, [](double ahead_s) { return ahead_s <= 0.0; })) return flight;
    flight.predictions = predict_part(excluded, part, others);
    for (const auto phase : flight::all_phases) {
        const double flown_wh = part.flown_s[phase] > 0.0 ? excluded.flown->phases[phase].energy_wh : 0.0;
        flight.flown_wh += flown_wh;
        flight.total_wh += part.ahead_s[phase] > 0.0 ? *excluded.energy_wh[phase] : flown_wh;
        if (!(part.ahead_s[phase] > 0.0)) continue;
        flight.measured_wh[phase] = excluded.energy_wh[phase];
        flight.counter_wh[phase] = excluded.counter_energy_wh[phase];
        for (auto& prediction : flight.predictions) prediction.phases[phase]->energy_wh += flown_wh;
    }
    for (auto& prediction : flight.predictions) prediction.total->energy_wh += flight.flown_wh;
    return flight;
}

bool was_predicted(const ValidatedFlight& flight, std::optional<flight::Phase> phase) {
    return std::ranges::any_of(flight::all_phases, [&](flight::Phase p) {
        return (!phase || p == *phase) && flight.measured_wh[p].has_value();
    });
}

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

void require_distinct(std::span<const MeasuredFlight> flights) {
    std::set<std::string> names;
    for (const auto& flight : flights) {
        if (names.insert(flight.samples.flight).second) continue;
        throw UsageError(fmt::format("flight '{}' is given twice", flight.samples.flight));
    }
}

std::vector<ValidatedFlight> leave_one_out(std::span<const MeasuredFlight> flights, const ModelFitOptions& options,
                                           const Progress& progress, std::size_t max_folds) {
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
    if (!phase && prediction->total) return PredictedEnergy{flight.total_wh, *prediction->total};
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
    double rest_percent = 0.0;
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
        const double rest_wh = energy->measured_wh - flight.flown_wh;
        if (!phase && rest_wh > 0.0) rest_percent += units::percentage(std::abs(error_wh), rest_wh);
        if (const auto interval = interval_95(energy->estimate)) {
            ++with_interval;
            if (interval->contains(energy->measured_wh)) ++covered;
        }
    }
    if (score.flights == 0) return std::nullopt;
    if (rest_percent > 0.0) score.mean_absolute_error_rest_percent = rest_percent / static_cast<double>(score.flights);
    const auto count = static_cast<double>(score.flights);
    score.mean_absolute_error_wh /= count;
    score.bias_wh /= count;
    if (phase != flight::Phase::landing && std::isfinite(percent)) score.mean_absolute_error_percent = percent / count;
    // The flights with an interval alone would be a choice of them: those that lack a phase, for instance.
    if (with_interval == score.flights) score.coverage_95 = static_cast<double>(covered) / count;
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
    std::erase_if(flights, [](const ValidatedFlight& flight) {
        return std::ranges::any_of(flight.measured_wh.values, [](const auto& energy_wh) { return !energy_wh; });
    });
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
                    const Progress& progress) {
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

}  // namespace flightwatt::mechanical
