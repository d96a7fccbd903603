#include "cli/output/physical_output.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "cli/terminal.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt::mechanical {

Fields<TermTrial> record_fields(const TermTrial*) {
    using R = TermTrial;
    return {field("term", &R::term, "term of the model", column{"tried"}),
            field("kept", &R::kept, "the term is part of the model"),
            field("rms_without_w", &R::rms_before_w, "hold-out error without the term", column{"without W"}),
            field("rms_with_w", &R::rms_after_w, "hold-out error with the term", column{"with W"}),
            field(
                "result", [](const R& trial) { return trial.kept ? "kept" : trial.reason; }, "result", column{"result"},
                not_in_json{}),
            field("reason", &R::reason, "reason of a rejected term")};
}

}  // namespace flightwatt::mechanical

namespace flightwatt::cli {
namespace {

std::string_view value_of(mechanical::PowerTerm term) {
    constexpr std::array<std::string_view, mechanical::power_term_count> values{"airspeed cubed",
                                                                                "1 / airspeed",
                                                                                "(load factor squared - 1) / airspeed",
                                                                                "climb rate",
                                                                                "climb rate below 0, in addition",
                                                                                "1"};
    return values.at(static_cast<std::size_t>(term));
}

/// Half the 95 % interval of a term's coefficient; absent from a single flight.
std::optional<double> half_width(const mechanical::PhysicalModel& model, std::size_t term) {
    if (!model.level_sd) return std::nullopt;
    return student_t_half_width(model.degrees_of_freedom) * std::sqrt(model.covariance[term][term]);
}

/// A term of a physical model.
struct TermOutput {
    mechanical::PowerTerm term;
    double coefficient = 0.0;
    std::optional<double> half_width;

    std::optional<Interval> interval() const {
        return half_width ? std::optional(Interval{coefficient - *half_width, coefficient + *half_width})
                          : std::nullopt;
    }
};

Fields<TermOutput> record_fields(const TermOutput*) {
    using R = TermOutput;
    const auto times = [](const R& r) { return std::string(value_of(r.term)); };
    const auto unit = [](const R& r) { return std::string(unit_of(r.term)); };
    return {field("term", &R::term, "term of the model", column{}),
            field("times", times, "value of the term", column{}, not_in_json{}),
            field("coefficient", &R::coefficient, "in `unit`", column{"", ".4g"}),
            field(
                "coefficient_interval_95", [](const R& r) { return r.interval(); }, "null: a single flight"),
            field("half_width_95", &R::half_width, "of the interval", column{"+-", ".2g"}, not_in_json{}),
            field("unit", unit, "unit of the coefficient", column{})};
}

std::vector<TermOutput> term_outputs(const mechanical::PhysicalModel& model) {
    std::vector<TermOutput> terms;
    for (std::size_t i = 0; i < model.terms.size(); ++i)
        terms.push_back({model.terms[i], model.coefficients[model.terms[i]], half_width(model, i)});
    return terms;
}

std::string_view error_basis(const mechanical::PhysicalFit& fit) {
    return fit.phases_decided ? "mean power of phases" : "bins";
}

/// Prediction interval of an hour of level flight at the model's mean airspeed.
std::string accuracy(const mechanical::PhysicalModel& model) {
    if (!model.level_sd) return "one flight: between-flight variance unknown, no prediction interval\n";
    const mechanical::FlightState level{.airspeed_m_per_s = model.mean_airspeed_m_per_s};
    if (!(level.airspeed_m_per_s > 0.0)) return "";
    constexpr double hour_s = 3600.0;
    const auto power = predicted_power(model, term_values(level), hour_s);
    return fmt::format(
        "an hour of level flight at {:.1f} m/s: {:.2f} W, of an unseen flight +- {:.2f} W (95 %); flights differ by "
        "{:.1f} % (1 sd), power drifts by {:.1f} W for {:.0f} s\n",
        level.airspeed_m_per_s, power.mean_w, student_t_half_width(power.degrees_of_freedom) * power.sd_w.value(),
        units::percentage(*model.level_sd, 1.0), model.drift_sd_w, model.correlation_s);
}

}  // namespace

TextTable constants_table(const mechanical::PhysicalModel& model) { return flightwatt::table_of(term_outputs(model)); }

TextTable trials_table(const mechanical::PhysicalFit& fit) { return flightwatt::table_of(fit.trials); }

std::string physical_text(const mechanical::PhysicalFit& fit, const Screen& screen) {
    const auto& model = fit.model;
    return "Power from the motion through the air\n" + screen_text(constants_table(model), screen) + accuracy(model) +
           fmt::format(
               "{} flight{}, {} bins of about {:.0f} s with {} samples, {:.1f} to {:.1f} m/s, climbing {:+.1f} to "
               "{:+.1f} m/s\n\n",
               model.flights.size(), model.flights.size() == 1 ? "" : "s", model.bins, model.bin_s, model.samples,
               model.airspeed_m_per_s.low, model.airspeed_m_per_s.high, model.climb_m_per_s.low,
               model.climb_m_per_s.high) +
           fmt::format("RMS hold-out error of the {}, cross-validated by {}:\n", error_basis(fit),
                       fit.folds_are_flights ? "flight" : "fifths of the flight") +
           screen_text(trials_table(fit), screen);
}

void warn_of_physical(const StageCall& call, const mechanical::PhysicalFit& fit) {
    for (const auto& [flight, reason] : fit.skipped)
        warn(call, fmt::format("{} is not in the physical model: {}", flight, reason));
    if (fit.model.level_sd) return;
    warn(call, "the physical model is of a single flight: its predictions have no interval; give two flights or more");
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
        note(call, "--weights applies to the curves over time; [physical] estimates its own weights");
    auto physical = mechanical::fit_physical_model(motions);
    warn_of_physical(call, physical);
    model.physical = physical.model;
    return physical;
}

}  // namespace flightwatt::cli

namespace flightwatt::mechanical {

Fields<PhysicalFit> record_fields(const PhysicalFit*) {
    using R = PhysicalFit;
    using M = PhysicalModel;
    const auto range = [](const FlownRange& of) { return Interval{of.low, of.high}; };
    return {field("terms", at(&R::model, cli::term_outputs), "terms of the model"),
            field("level_sd", at(&R::model, &M::level_sd), "relative sd between flights; null: a single flight"),
            field("degrees_of_freedom", at(&R::model, &M::degrees_of_freedom), "of the intervals"),
            field("drift_sd_w", at(&R::model, &M::drift_sd_w), "standard deviation of the drift within a flight"),
            field("correlation_s", at(&R::model, &M::correlation_s), "correlation time of the drift"),
            field("flights", at(&R::model, &M::flights), "flights of the fit"),
            field("bins", at(&R::model, &M::bins), "number of bins"),
            field("bin_s", at(&R::model, &M::bin_s), "mean duration of a bin"),
            field("samples", at(&R::model, &M::samples), "power samples"),
            field("airspeed_m_per_s", at(&R::model, &M::airspeed_m_per_s, range), "range of the airspeed"),
            field("climb_m_per_s", at(&R::model, &M::climb_m_per_s, range), "range of the climb rate"),
            field("mean_airspeed_m_per_s", at(&R::model, &M::mean_airspeed_m_per_s), "mean airspeed"),
            field(
                "hold_out", [](const R& fit) { return std::string(cli::error_basis(fit)); },
                "`mean power of phases`, or `bins` of a single flight"),
            field("trials", &R::trials, "terms that were tried")};
}

}  // namespace flightwatt::mechanical
