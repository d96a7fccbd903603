#include "cli/output/physical_output.h"

#include "base/statistics.h"
#include "cli/terminal.h"

#include <cmath>
#include <cstddef>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mechanical {

Fields<TermTrial> record_fields(const TermTrial*) {
    using R = TermTrial;
    return {field("term", &R::term, "term of the model", column{"tried"}),
            field("kept", &R::kept, "the term is part of the model", column{}),
            field("rms_without_w", &R::rms_before_w, "hold-out error without the term", column{"without W"}),
            field("rms_with_w", &R::rms_after_w, "hold-out error with the term", column{"with W"}),
            field("reason", &R::reason, "reason of a rejected term", column{})};
}

Fields<BestSpeed> record_fields(const BestSpeed*) {
    using R = BestSpeed;
    return {field("purpose", &R::purpose, "best endurance, best range, or least energy on a path"),
            field("airspeed_m_per_s", &R::airspeed_m_per_s, "null: beyond the speeds searched"),
            field("airspeed_low_m_per_s", &R::low_m_per_s, "low end of the 95 % interval; null: no bound"),
            field("airspeed_high_m_per_s", &R::high_m_per_s, "high end of the 95 % interval; null: no bound"),
            field("below_flown", &R::below_flown, "slower than the range flown: extrapolated"),
            field("above_flown", &R::above_flown, "faster than the range flown: extrapolated"),
            field("cost", &R::cost, "power or energy at that airspeed, in `unit`"),
            field("unit", &R::unit, "`W`, `Wh/km` or `Wh`")};
}

Fields<SpeedTest> record_fields(const SpeedTest*) {
    using R = SpeedTest;
    return {field("airspeeds_m_per_s", &R::airspeed_m_per_s, "airspeed of each level leg"),
            field("leg_s", &R::leg_s, "duration of a leg"),
            field("flights", &R::flights, "number of flights, each with all legs"),
            field("induced_half_95_now", &R::induced_now, "half the 95 % interval of the induced term, in W m/s"),
            field("induced_half_95_after", &R::induced_after, "the same, expected with these legs"),
            field("endurance_after", &R::endurance_after, "best endurance, expected with these legs")};
}

Fields<SpeedToFly> record_fields(const SpeedToFly*) {
    return {field("best", &SpeedToFly::best, "best speeds"),
            field("test", &SpeedToFly::test, "flight that would determine the induced drag; null: not necessary")};
}

}  // namespace flightwatt::mechanical

namespace flightwatt::cli {
namespace {

/// A term of a physical model.
struct TermOutput {
    mechanical::PowerTerm term;
    double coefficient = 0.0;
    std::optional<Interval> interval;  ///< absent from a single flight
};

Fields<TermOutput> record_fields(const TermOutput*) {
    using R = TermOutput;
    const auto unit = [](const R& r) { return std::string(unit_of(r.term)); };
    return {field("term", &R::term, "term of the model", column{}),
            field("coefficient", &R::coefficient, "in `unit`", column{"", ".4g"}),
            field("coefficient_interval_95", &R::interval, "null: a single flight", column{"low|high", ".4g"}),
            field("unit", unit, "unit of the coefficient", column{})};
}

std::vector<TermOutput> term_outputs(const mechanical::PhysicalModel& model) {
    std::vector<TermOutput> terms;
    for (std::size_t i = 0; i < model.terms.size(); ++i) {
        auto& term = terms.emplace_back(TermOutput{model.terms[i], model.coefficients[model.terms[i]], {}});
        if (!model.level_sd) continue;
        const auto half = student_t_half_width(model.degrees_of_freedom) * std::sqrt(model.covariance[i][i]);
        term.interval = Interval{term.coefficient - half, term.coefficient + half};
    }
    return terms;
}

std::string error_basis(const mechanical::PhysicalFit& fit) {
    return fit.phases_decided ? "mean power of phases" : "bins";
}

}  // namespace

TextTable constants_table(const mechanical::PhysicalModel& model) { return flightwatt::table_of(term_outputs(model)); }

TextTable trials_table(const mechanical::PhysicalFit& fit) { return flightwatt::table_of(fit.trials); }

std::vector<std::string> speed_lines(const mechanical::SpeedToFly& speeds) {
    const auto& flown = speeds.model.airspeed_m_per_s;
    std::vector<std::string> lines;
    for (const auto& best : speeds.best) lines.push_back(fmt::format("{}: {}", best.purpose, describe(best, flown)));
    lines.push_back(fmt::format("flown: {:.1f} to {:.1f} m/s; * is extrapolated", flown.low, flown.high));
    if (speeds.test) lines.push_back(describe(*speeds.test));
    return lines;
}

std::string physical_text(const mechanical::PhysicalFit& fit, const Screen& screen) {
    auto values = record_json(fit);
    values.erase("speed_to_fly");
    auto text = "Power from the motion through the air\n" + screen_text(constants_table(fit.model), screen) +
                values_text(values) + "\nRMS hold-out error by term\n" + screen_text(trials_table(fit), screen);
    if (!fit.speeds) return text;
    return text + fmt::format("\nSpeed to fly\n{}\n", fmt::join(speed_lines(*fit.speeds), "\n"));
}

void add_best_power(std::span<const mechanical::MeasuredFlight> measured, const mechanical::ModelFitOptions& options,
                    mechanical::MechanicalModel& model) {
    ProgressBar fitting("fits");
    mechanical::add_best_power(model, measured, options, fitting.callback());
}

mechanical::PhysicalFit fit_motion(const StageCall& call, std::span<const mechanical::MeasuredFlight> measured,
                                   mechanical::MechanicalModel& model, double headwind_m_per_s) {
    std::vector<mechanical::BinnedFlight> motions;
    motions.reserve(measured.size());
    for (const auto& flight : measured) motions.push_back(flight.motion);
    if (call.has("weights"))
        note(call, "--weights applies to the curves over time; [physical] estimates its own weights");
    auto physical = mechanical::fit_physical_model(motions);
    if (headwind_m_per_s != 0.0) physical.speeds = speed_to_fly(physical.model, headwind_m_per_s);
    for (const auto& [flight, reason] : physical.skipped)
        warn(call, fmt::format("{} is not in the physical model: {}", flight, reason));
    if (!physical.model.level_sd)
        warn(call,
             "the physical model is of a single flight: its predictions have no interval; give two flights or more");
    model.physical = physical.model;
    return physical;
}

}  // namespace flightwatt::cli

namespace flightwatt::mechanical {

Fields<PhysicalFit> record_fields(const PhysicalFit*) {
    using R = PhysicalFit;
    using M = PhysicalModel;
    return {field("terms", at(&R::model, cli::term_outputs), "terms of the model"),
            field("level_sd", at(&R::model, &M::level_sd), "relative sd between flights; null: a single flight"),
            field("degrees_of_freedom", at(&R::model, &M::degrees_of_freedom), "of the intervals"),
            field("drift_sd_w", at(&R::model, &M::drift_sd_w), "standard deviation of the drift within a flight"),
            field("correlation_s", at(&R::model, &M::correlation_s), "correlation time of the drift"),
            field("flights", at(&R::model, &M::flights), "flights of the fit"),
            field("bins", at(&R::model, &M::bins), "number of bins"),
            field("bin_s", at(&R::model, &M::bin_s), "mean duration of a bin"),
            field("samples", at(&R::model, &M::samples), "power samples"),
            field("airspeed_m_per_s", at(&R::model, &M::airspeed_m_per_s), "range of the airspeed"),
            field("airspeed_sd_m_per_s", at(&R::model, &M::airspeed_sd_m_per_s),
                  "error of an estimated airspeed; null: measured"),
            field("climb_m_per_s", at(&R::model, &M::climb_m_per_s), "range of the climb rate"),
            field("mean_airspeed_m_per_s", at(&R::model, &M::mean_airspeed_m_per_s), "mean airspeed"),
            field("hold_out", cli::error_basis, "`mean power of phases`, or `bins` of a single flight"),
            field("trials", &R::trials, "terms that were tried"),
            field("speed_to_fly", &R::speeds, "null: the flights do not determine drag and induced drag")};
}

}  // namespace flightwatt::mechanical
