// flightwatt predict: the energy to the end of a flight that is in the air.

#include "base/error.h"
#include "base/units.h"
#include "battery/landing_forecast.h"
#include "cli/numeric_options.h"
#include "cli/output/flight_options.h"
#include "cli/output/json_text.h"
#include "cli/output/mission_output.h"
#include "cli/output/moment_option.h"
#include "cli/output/prediction_output.h"
#include "cli/stage.h"
#include "flight/chosen_track.h"
#include "flight/flight_series.h"
#include "mechanical/model_check.h"
#include "mechanical/prediction.h"
#include "mission/mission_file.h"
#include "mission/remaining_path.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace {

using namespace flightwatt;
using cli::BatteryPrediction;
using cli::Prediction;

/// Refuses a model whose interval would rest on nothing.
void require_spread(const mechanical::MechanicalModel& model, flight::Phase phase, const std::string& file) {
    if (model.phases[phase].level_spread) return;
    throw InputError({file}, fmt::format("[{}] has no spread: how much flights differ", to_string(phase)),
                     "fit it to two flights or more: flightwatt fit FLIGHT... -o MODEL.toml");
}

/// The model that --model names.
mechanical::MechanicalModel read_spread_model(const cli::StageCall& call) {
    const auto file = call.get<std::string>("model");
    auto model = mechanical::read_mechanical_model(file);
    for (const auto& warning : model_warnings(model)) cli::warn(call, fmt::format("{}: {}", file, warning));
    for (const auto phase : {flight::Phase::cruise, flight::Phase::landing}) require_spread(model, phase, file);
    return model;
}

/// What --level auto stands for: the level law where the model has one and the flight tells its covariate.
mechanical::LevelSource automatic_source(const cli::StageCall& call, const mechanical::PhaseModel& cruise,
                                         const mechanical::FlightProgress& flown) {
    if (!cruise.level_law) return mechanical::LevelSource::curve;
    const auto covariate = cruise.level_law->covariate;
    if (flown.covariates[covariate]) return mechanical::LevelSource::covariate;
    cli::warn(call, fmt::format("the model's level follows {}, which this flight does not tell: expected by "
                                "the curve",
                                to_string(covariate)));
    return mechanical::LevelSource::curve;
}

mechanical::LevelSource level_source(const cli::StageCall& call, const mechanical::PhaseModel& cruise,
                                     const mechanical::FlightProgress& flown) {
    const auto name = call.get<std::string>("level");
    static const std::map<std::string, mechanical::LevelSource> sources{
        {"curve", mechanical::LevelSource::curve},
        {"constant", mechanical::LevelSource::constant},
        {"airspeed", mechanical::LevelSource::airspeed},
        {"covariate", mechanical::LevelSource::covariate}};
    if (name == "auto") return automatic_source(call, cruise, flown);
    if (const auto found = sources.find(name); found != sources.end()) return found->second;
    throw UsageError(fmt::format("--level {}: expected auto, curve, constant, airspeed or covariate", name));
}

/// What a law says beyond its flights is told, not refused: the flight is as it is.
void warn_of_reach(const cli::StageCall& call, const mechanical::PhaseModel& cruise,
                   const mechanical::FlightProgress& flown) {
    const auto& law = cruise.level_law.value();
    const double value = flown.covariates[law.covariate].value();
    if (level_at(law, value).within_flights) return;
    cli::warn(call,
              fmt::format("{} = {:.4g} is beyond what the model's flights showed, {:.4g} to {:.4g}{}",
                          to_string(law.covariate), value, law.least, law.most,
                          law.covariate == mechanical::Covariate::airspeed_cubed ? "" : ": taken as the nearest"));
}

/// A flight at a moment, and what its log held by then.
struct KnownFlight {
    mechanical::FlightProgress flown;
    flight::FlightSeries series;
};

/// What was known at the moment: nothing that the log wrote later is looked at, in what is read, chosen,
/// judged or said.
KnownFlight read_progress(const cli::StageCall& call, const cli::Moment& moment) {
    auto options = cli::read_flight_options(call);
    const auto sortie = options.sortie.value_or(1) - 1;
    options.sortie.reset();
    options.flight_required = false;
    const auto& file = call.inputs.front();
    auto candidates =
        read_candidates(flight::FlightFile(file, options.most_log_bytes, options.messages), options.aircraft_id);
    const double until_s = cli::time_of(moment, candidates, sortie, options.segmentation);
    for (auto& series : candidates) series = cut_series(series, until_s);
    auto series = choose_aircraft(std::move(candidates));
    cli::refuse_unknown_flights(options, {series.flight});
    if (power_track(series).empty() && !series.clock_restart) {
        throw NoAnswerError(fmt::format("{}: no power was measured by {:.1f} s of the log", series.flight, until_s));
    }
    auto loaded = examine_flight(std::move(series), options);
    cli::warn_of(call, file, loaded);
    if (!loaded.exclusion.empty()) {
        cli::warn(call, fmt::format("{}: no prediction can be trusted: {}", file, loaded.exclusion));
    }
    auto flown = mechanical::progress_at(loaded.series, until_s, sortie, options.segmentation);
    return {std::move(flown), std::move(loaded.series)};
}

/// What the prediction rests on beside the log.
struct Basis {
    mechanical::MechanicalModel model;
    double landing_s = 0.0;
    std::optional<double> remaining_s = {};              ///< none: what is left of the path
    std::optional<mechanical::AirMotion> motion = {};    ///< of --airspeed
    std::shared_ptr<const mission::PathPlan> path = {};  ///< of --mission
    battery::LandingLimits limits = {};                  ///< of --mission
};

/// How the rest of the cruise is to be flown, where --airspeed says it.
std::optional<mechanical::AirMotion> motion_ahead(const cli::StageCall& call) {
    constexpr double fastest_m_per_s = 200.0;
    const auto airspeed = cli::positive_option(call, "airspeed", "m/s");
    if (!airspeed) {
        if (call.has("climb")) throw UsageError("--climb goes with --airspeed");
        return std::nullopt;
    }
    if (!call.options["level"].defaulted())
        throw UsageError("--airspeed and --level exclude each other: give one of them");
    mechanical::AirMotion motion{.airspeed_m_per_s = *airspeed};
    if (call.has("climb")) motion.climb_m_per_s = cli::number_option(call, "climb", -fastest_m_per_s, fastest_m_per_s);
    return motion;
}

/// Refuses a model that does not know how power follows from airspeed and climb, or how flights differ in it.
void require_physical(const mechanical::MechanicalModel& model, const std::string& file, const char* option) {
    if (model.physical && model.physical->level_sd) return;
    throw InputError(
        {file}, model.physical ? "its [physical] rests on a single flight" : "it has no [physical]",
        fmt::format("{} needs one of two flights or more: flightwatt fit --model physical FLIGHT...", option));
}

/// What --remaining gives.
std::optional<double> remaining_of(const cli::StageCall& call) {
    constexpr double longest_s = 1e6;  // no battery flies for eleven days
    if (!call.has("remaining")) return std::nullopt;
    return cli::number_option(call, "remaining", 0.0, longest_s);
}

/// Model and path of the mission that --mission names.
Basis read_mission_basis(const cli::StageCall& call) {
    if (call.has("model")) throw UsageError("--mission names its model: leave --model out");
    if (call.has("airspeed") || call.has("climb") || !call.options["level"].defaulted())
        throw UsageError("--mission says how the rest is flown: leave --airspeed, --climb and --level out");
    const auto remaining_s = remaining_of(call);
    const auto file = call.get<std::string>("mission");
    mission::MissionReading reading;
    reading.may_lack_schedule = true;
    const auto mission = mission::read_mission(file, reading);
    const auto& setup = setup_of(mission);
    if (!setup.cruise_path) {
        throw InputError({file}, "the mission has no [path]",
                         "say where it flies (docs/missions.md, path), or give --model and --remaining");
    }
    cli::warn_of_setup(call, setup);
    Basis basis{*setup.mechanical, setup.duration_s[flight::Phase::landing]};
    basis.remaining_s = remaining_s;
    basis.path = setup.cruise_path->plan;
    basis.limits = {setup.cutoff_voltage_v, setup.reserve_soc_percent};
    basis.model.physical = basis.path->power;  // where the model has but a law of airspeed, that
    require_physical(basis.model, file, "--mission");
    if (basis.landing_s > 0.0) require_spread(basis.model, flight::Phase::landing, file);
    return basis;
}

Basis read_basis(const cli::StageCall& call) {
    Basis basis;
    if (call.has("mission")) {
        basis = read_mission_basis(call);
    } else {
        if (!call.has("model"))
            throw UsageError("no model given: expected --model MODEL.toml, or --mission MISSION.toml");
        if (!call.has("remaining")) throw UsageError("no time left given: expected --remaining SECONDS");
        basis.remaining_s = remaining_of(call);
        basis.motion = motion_ahead(call);
        basis.model = read_spread_model(call);
        basis.landing_s = basis.model.phases[flight::Phase::landing].duration_s;
        if (basis.motion) require_physical(basis.model, call.get<std::string>("model"), "--airspeed");
    }
    return basis;
}

/// The cruise by the physical model at this flight's own level.
mechanical::RestPrediction predict_motion(const cli::StageCall& call, const mechanical::PhysicalModel& model,
                                          const mechanical::FlightProgress& flown, const mechanical::AirMotion& motion,
                                          double remaining_s) {
    cli::warn_of_motion(call, model, motion);
    return predict_rest_by_motion(model, flown, terms_of(motion), remaining_s);
}

/// Where on the path the flight is: after as long as it has cruised, or --remaining before its end.
mission::PathPlace place_on_path(const mission::FlownPath& path, const mechanical::FlightProgress& flown,
                                 const std::optional<double>& remaining_s) {
    if (remaining_s && *remaining_s > path.duration_s) {
        throw UsageError(
            fmt::format("--remaining {:g}: the mission's path takes only {:.1f} s", *remaining_s, path.duration_s));
    }
    if (!remaining_s && flown.cruise_s() > path.duration_s) {
        throw NoAnswerError(
            fmt::format("the flight has cruised for {:.1f} s and the mission's path takes {:.1f} s: say "
                        "with --remaining how much of it is left",
                        flown.cruise_s(), path.duration_s));
    }
    return place_at(path, remaining_s ? path.duration_s - *remaining_s : flown.cruise_s());
}

/// The cruise along what is left of the path.
mechanical::RestPrediction predict_along(const cli::StageCall& call, const mission::PathPlan& plan,
                                         const mechanical::FlightProgress& flown, Prediction& prediction,
                                         const std::optional<double>& remaining_s) {
    const auto path = fly_path(plan.path, plan.wind);
    const auto place = place_on_path(path, flown, remaining_s);
    auto rest = predict_rest_of_path(plan, flown, place);
    if (rest.forbidden_part > 0.0) {
        cli::warn(call, fmt::format("{:.0f} % of the winds that [wind] makes likely forbid what is left of the path: "
                                    "they are not in what follows",
                                    units::percent_of(rest.forbidden_part, 1.0)));
    }
    prediction.remaining_s = rest.duration_s;
    prediction.power_ahead = std::move(rest.power);
    return rest.cruise;
}

/// What --initial-soc gives.
std::optional<double> read_initial_soc(const cli::StageCall& call) {
    if (!call.has("initial-soc")) return std::nullopt;
    if (!call.has("battery")) throw UsageError("--initial-soc goes with --battery");
    return cli::number_option(call, "initial-soc", 0.0, units::percent_per_whole);
}

/// The battery that --battery names through the rest, from what was measured of it until now.
std::optional<BatteryPrediction> predict_battery(const cli::StageCall& call, const flight::FlightSeries& series,
                                                 const Prediction& prediction,
                                                 const std::optional<double>& initial_soc_percent,
                                                 const battery::LandingLimits& limits) {
    const auto file = call.maybe<std::string>("battery");
    if (!file) return std::nullopt;
    const auto battery = battery::read_battery(*file);
    for (const auto& warning : battery_warnings(battery)) cli::warn(call, fmt::format("{}: {}", *file, warning));
    const auto records = battery::discharge_records(series);
    for (const auto& note : records.notes) cli::note(call, note);
    const auto& record = records.records.back();
    BatteryPrediction of;
    of.limits = limits;
    of.initial_is_measured = !initial_soc_percent;
    if (initial_soc_percent) {
        of.initial_soc_percent = *initial_soc_percent;
    } else if (battery.thevenin) {
        const double rest_v = record.resting_voltage_v + battery.resistance_ohm * record.resting_current_a;
        of.initial_soc_percent = battery::resting_soc_percent(battery, rest_v);
    } else {
        throw InputError({*file}, "a battery of constant voltage does not tell its state of charge",
                         "give --initial-soc PERCENT");
    }
    land(battery, record, prediction, of);
    return of;
}

/// The cruise by the model's curve or laws.
mechanical::RestPrediction predict_level(const cli::StageCall& call, const mechanical::MechanicalModel& model,
                                         const mechanical::FlightProgress& flown, double remaining_s) {
    const auto& cruise = model.phases[flight::Phase::cruise];
    const auto source = level_source(call, cruise, flown);
    auto rest = predict_rest(mechanical::forecast_of(model, flight::Phase::cruise), flown, remaining_s, source);
    if (source == mechanical::LevelSource::covariate) warn_of_reach(call, cruise, flown);
    return rest;
}

mechanical::RestPrediction predict_cruise(const cli::StageCall& call, const Basis& basis,
                                          const mechanical::FlightProgress& flown, Prediction& prediction) {
    prediction.by_motion = basis.path || basis.motion;
    if (prediction.by_motion && !flown.motion.lacks.empty())
        cli::warn(call, fmt::format("this flight's own level is not known: {}", flown.motion.lacks));
    if (basis.path) return predict_along(call, *basis.path, flown, prediction, basis.remaining_s);
    prediction.remaining_s = basis.remaining_s.value();
    if (basis.motion)
        return predict_motion(call, basis.model.physical.value(), flown, *basis.motion, prediction.remaining_s);
    return predict_level(call, basis.model, flown, prediction.remaining_s);
}

Prediction predict_flight(const cli::StageCall& call) {
    Prediction prediction;
    const auto moment = cli::moment_of(call);
    const auto initial_soc_percent = read_initial_soc(call);
    const auto basis = read_basis(call);
    auto known = read_progress(call, moment);
    prediction.flown = std::move(known.flown);
    prediction.cruise = predict_cruise(call, basis, prediction.flown, prediction);
    if (prediction.by_motion) cli::warn_of_level(call, basis.model.physical.value(), prediction.cruise.gain);
    prediction.landing_s = basis.landing_s;
    if (basis.landing_s > 0.0) {
        prediction.landing =
            mechanical::predict_before_flight(forecast_of(basis.model, flight::Phase::landing), basis.landing_s);
    }
    prediction.rest = sum_of(prediction.cruise.energy, prediction.landing);
    prediction.interval = interval_95(prediction.rest).value();
    prediction.battery = predict_battery(call, known.series, prediction, initial_soc_percent, basis.limits);
    return prediction;
}

int predict(const cli::StageCall& call) {
    const auto prediction = predict_flight(call);
    cli::write_result(call, text_of(prediction));
    if (call.json) cli::print(cli::json_text(json_of(prediction)));
    return cli::ok;
}

}  // namespace

int main(int argc, char** argv) {
    cli::StageDefinition stage{
        "predict", "FLIGHT.data|SERIES.csv --model MODEL.toml --remaining S | --mission MISSION.toml",
        R"(Predicts the energy from a moment in cruise to the end of the flight. What was measured until then
moves the cruise level of the model towards this flight's own, weighted by the variances between
flights and within one. Nothing after the moment is looked at: a log that ends there gives the same.
The remaining energy is that of --remaining more seconds of cruise and of a landing as in the model
(its duration, too); with --airspeed the cruise is what the physical model says of it, with --mission
what it says of the rest of the mission's path in its wind. The 95 % interval is that of the
remaining energy; it holds the spread between flights, the drift within one, that of the wind, and
that the model rests on few flights.)"};
    stage.max_inputs = 1;
    auto add = stage.options.add_options();
    add("model", cli::input_file("MODEL.toml"), "from flightwatt fit, of two flights or more");
    add("until", cli::value("S|now")->default_value("now"),
        "the moment, in seconds since lift-off as flightwatt segment finds it in what was flown; now: the end of the "
        "log, which may still grow");
    add("until-log-time", cli::value<double>("S"), "the moment in the log's own seconds, instead of --until");
    add("remaining", cli::value<double>("S"),
        "seconds from the moment until landing begins; with --mission only where the flight is not as far along the "
        "path as the time since its cruise began");
    add("level", cli::value("HOW")->default_value("auto"),
        "what is expected of the cruise before its own power is looked at: the model's curve, the curve's mean "
        "(constant), the power that the airspeed so far and the other flights' later one stand for (airspeed), or that "
        "of the model's level law (covariate); auto is covariate for a model that was fitted with --level-covariate, "
        "and else curve");
    add("airspeed", cli::value<double>("M_PER_S"),
        "how fast the rest of the cruise is flown: predicts it by the model's [physical] at this flight's own level");
    add("climb", cli::value<double>("M_PER_S"), "and how fast it climbs (0; below 0 it descends)");
    add("mission", cli::input_file("MISSION.toml"),
        "a mission with a [path], instead of --model: the rest of its path is flown, with its model, its wind and "
        "its landing");
    add("battery", cli::input_file("BATTERY.toml"),
        "also tell state of charge and voltage at landing, and how long the cruise could go on from there");
    add("initial-soc", cli::value<double>("PERCENT"),
        "the battery's state of charge when the log begins; else by its voltage at rest");
    cli::add_flight_options(stage.options);
    return cli::run_stage(argc, argv, stage, predict);
}
