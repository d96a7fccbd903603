#include "cli/output/physical_output.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "cli/output/records.h"
#include "cli/terminal.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

std::string_view value_of(mechanical::PowerTerm term) {
    constexpr std::array<std::string_view, mechanical::power_term_count> values{"airspeed cubed",
                                                                                "1 / airspeed",
                                                                                "(load factor squared - 1) / airspeed",
                                                                                "climb rate",
                                                                                "climb rate below 0, besides",
                                                                                "1"};
    return values.at(static_cast<std::size_t>(term));
}

/// Half the 95 % interval of a term's coefficient; absent from a single flight.
std::optional<double> half_width(const mechanical::PhysicalModel& model, std::size_t term) {
    if (!model.level_sd) return std::nullopt;
    return student_t_half_width(model.degrees_of_freedom) * std::sqrt(model.covariance[term][term]);
}

Json terms_json(const mechanical::PhysicalModel& model) {
    auto terms = Json::array();
    for (std::size_t i = 0; i < model.terms.size(); ++i) {
        const auto term = model.terms[i];
        terms.push_back({{"term", to_string(term)},
                         {"coefficient", model.coefficients[term]},
                         {"half_width_95", optional_json(half_width(model, i))},
                         {"unit", unit_of(term)}});
    }
    return terms;
}

Json trial_json(const mechanical::TermTrial& trial) {
    return {{"term", to_string(trial.term)},
            {"kept", trial.kept},
            {"rms_without_w", optional_json(trial.rms_before_w)},
            {"rms_with_w", optional_json(trial.rms_after_w)},
            {"reason", trial.reason}};
}

/// How far a flight of an hour may be off at the model's own mean airspeed, level, as a part of its power.
std::string accuracy(const mechanical::PhysicalModel& model) {
    if (!model.level_sd) return "a single flight does not tell how flights differ: no interval of an unseen one\n";
    const mechanical::FlightState level{.airspeed_m_per_s = model.mean_airspeed_m_per_s};
    if (!(level.airspeed_m_per_s > 0.0)) return "";
    constexpr double hour_s = 3600.0;
    const double power = power_w(model, level);
    const auto of = prediction_uncertainty(model, term_values(level), hour_s).value();
    return fmt::format(
        "an hour of level flight at {:.1f} m/s: {:.2f} W, of an unseen flight +- {:.2f} W (95 %); flights differ by "
        "{:.1f} % (1 sd), power drifts by {:.1f} W for {:.0f} s\n",
        level.airspeed_m_per_s, power, student_t_half_width(of.degrees_of_freedom) * of.sd_w,
        units::percentage(*model.level_sd, 1.0), model.drift_sd_w, model.correlation_s);
}

}  // namespace

TextTable constants_table(const mechanical::PhysicalModel& model) {
    auto terms = terms_json(model);
    for (std::size_t i = 0; i < model.terms.size(); ++i) terms[i]["times"] = value_of(model.terms[i]);
    return table_of(terms, {"term", "times", "coefficient .4g", "half_width_95 .2g: +-", "unit"});
}

TextTable trials_table(const mechanical::PhysicalFit& fit) {
    auto trials = list_json(fit.trials, trial_json);
    for (auto& trial : trials)
        if (trial["kept"] == true) trial["reason"] = "kept";
    return table_of(trials,
                    {"term: tried", "rms_without_w .2f: without W", "rms_with_w .2f: with W", "reason: result"});
}

std::string physical_text(const mechanical::PhysicalFit& fit, const Screen& screen) {
    const auto& model = fit.model;
    return "Power from the motion through the air\n" + screen_text(constants_table(model), screen) + accuracy(model) +
           fmt::format(
               "rests on {} flight{}, {} stretches of about {:.0f} s with {} samples, {:.1f} to {:.1f} m/s, climbing "
               "{:+.1f} to {:+.1f} m/s\n\n",
               model.flights.size(), model.flights.size() == 1 ? "" : "s", model.bins, model.bin_s, model.samples,
               model.airspeed_m_per_s.low, model.airspeed_m_per_s.high, model.climb_m_per_s.low,
               model.climb_m_per_s.high) +
           fmt::format("RMS error of {} held back, {} in turn:\n",
                       fit.phases_decided ? "the mean power of phases" : "stretches",
                       fit.folds_are_flights ? "flights" : "fifths of the flight") +
           screen_text(trials_table(fit), screen);
}

Json physical_json(const mechanical::PhysicalFit& fit) {
    const auto& model = fit.model;
    return {{"terms", terms_json(model)},
            {"level_sd", optional_json(model.level_sd)},
            {"degrees_of_freedom", model.degrees_of_freedom},
            {"drift_sd_w", model.drift_sd_w},
            {"correlation_s", model.correlation_s},
            {"flights", model.flights},
            {"bins", model.bins},
            {"bin_s", model.bin_s},
            {"samples", model.samples},
            {"airspeed_m_per_s", interval_json(model.airspeed_m_per_s)},
            {"climb_m_per_s", interval_json(model.climb_m_per_s)},
            {"mean_airspeed_m_per_s", model.mean_airspeed_m_per_s},
            {"held_back", fit.phases_decided ? "mean power of phases" : "stretches"},
            {"trials", list_json(fit.trials, trial_json)}};
}

void warn_of_physical(const StageCall& call, const mechanical::PhysicalFit& fit) {
    for (const auto& [flight, reason] : fit.skipped)
        warn(call, fmt::format("{} is not in the physical model: {}", flight, reason));
    if (fit.model.level_sd) return;
    warn(call,
         "the physical model rests on a single flight: how flights differ is not known, and its predictions have "
         "no interval; give two flights or more");
}

void add_best_power(std::span<const mechanical::MeasuredFlight> measured, const mechanical::ModelFitOptions& options,
                    mechanical::MechanicalModel& model) {
    ProgressBar fitting("fits");
    mechanical::add_best_power(model, measured, options, fitting.callback());
}

mechanical::PhysicalFit fit_motion(const StageCall& call, std::span<const mechanical::MeasuredFlight> measured,
                                   mechanical::MechanicalModel& model) {
    std::vector<mechanical::BinnedFlight> motions;
    motions.reserve(measured.size());
    for (const auto& flight : measured) motions.push_back(flight.motion);
    if (call.has("weights"))
        note(call, "the weights are those of the curves over time: [physical] finds its own from how flights differ");
    auto physical = mechanical::fit_physical_model(motions);
    warn_of_physical(call, physical);
    model.physical = physical.model;
    return physical;
}

}  // namespace flightwatt::cli
