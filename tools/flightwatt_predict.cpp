// flightwatt predict: the energy to the end of a flight that is in the air.

#include "base/error.h"
#include "base/number.h"
#include "base/units.h"
#include "battery/landing_forecast.h"
#include "cli/numeric_options.h"
#include "cli/output/flight_options.h"
#include "cli/output/json_text.h"
#include "cli/stage.h"
#include "flight/chosen_track.h"
#include "flight/flight_series.h"
#include "mechanical/model_check.h"
#include "mechanical/prediction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

/// The moment that is asked for: since lift-off, on the log's clock, or (none of them) the end of the log.
struct Moment {
    std::optional<double> since_lift_off_s;
    std::optional<double> log_time_s;
};

Moment moment_of(const cli::StageCall& call) {
    const auto log_time_s = cli::positive_option(call, "until-log-time", "s");
    if (log_time_s && !call.options["until"].defaulted()) {
        throw UsageError("--until and --until-log-time exclude each other: give one of them");
    }
    const auto text = call.get<std::string>("until");
    if (text == "now") return {std::nullopt, log_time_s};
    const auto since_s = parse_number(text);
    if (!since_s || !(*since_s > 0.0) || !std::isfinite(*since_s)) {
        throw UsageError(fmt::format("--until {}: expected now, or seconds since lift-off, more than 0", text));
    }
    return {since_s, std::nullopt};
}

/// When it is: of several aircraft, when the first has flown so long.
double time_of(const Moment& moment, const std::vector<flight::FlightSeries>& candidates, std::size_t sortie,
               const flight::SegmentationOptions& options) {
    if (moment.log_time_s) return *moment.log_time_s;
    if (!moment.since_lift_off_s) {
        double last_s = 0.0;
        for (const auto& series : candidates) last_s = std::max(last_s, mechanical::last_time_s(series));
        return last_s;
    }
    std::optional<double> first_s;
    std::optional<NoAnswerError> refusal;
    for (const auto& series : candidates) {
        try {
            const double time_s = mechanical::time_since_lift_off(series, *moment.since_lift_off_s, sortie, options);
            first_s = std::min(first_s.value_or(time_s), time_s);
        } catch (const NoAnswerError& error) {
            if (!refusal) refusal = error;
        }
    }
    if (!first_s) throw NoAnswerError(*refusal);
    return *first_s;
}

/// The model that --model names. Its spread is what the interval rests on.
mechanical::MechanicalModel read_spread_model(const cli::StageCall& call) {
    if (!call.has("model")) throw UsageError("no model given: expected --model MODEL.toml");
    const auto file = call.get<std::string>("model");
    auto model = mechanical::read_mechanical_model(file);
    for (const auto& warning : model_warnings(model)) cli::warn(call, fmt::format("{}: {}", file, warning));
    for (const auto phase : {flight::Phase::cruise, flight::Phase::landing}) {
        if (model.phases[phase].level_spread) continue;
        throw InputError({file}, fmt::format("[{}] has no spread: how much flights differ", to_string(phase)),
                         "fit it to two flights or more: flightwatt fit FLIGHT... -o MODEL.toml");
    }
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

/// The battery's part of it.
struct BatteryPrediction {
    battery::LandingForecast expected;
    battery::LandingForecast worst;  ///< where the energy is that at the high end of its interval
    double initial_soc_percent = 0.0;
    bool initial_is_measured = false;  ///< by the resting voltage
};

struct Prediction {
    mechanical::FlightProgress flown;
    double remaining_s = 0.0;
    mechanical::RestPrediction cruise;
    mechanical::EnergyEstimate landing;
    double landing_s = 0.0;
    mechanical::EnergyEstimate rest;
    mechanical::EnergyInterval interval;
    std::optional<double> initial_soc_percent = {};  ///< as it was given
    std::optional<BatteryPrediction> battery = {};
};

/// A flight at a moment, and what its log held by then.
struct KnownFlight {
    mechanical::FlightProgress flown;
    flight::FlightSeries series;
};

/// What was known at the moment: nothing that the log wrote later is looked at, in what is read, chosen,
/// judged or said.
KnownFlight read_progress(const cli::StageCall& call, const Moment& moment) {
    auto options = cli::read_flight_options(call);
    const auto sortie = options.sortie.value_or(1) - 1;
    options.sortie.reset();
    options.flight_required = false;
    const auto& file = call.inputs.front();
    auto candidates = read_candidates(flight::FlightFile(file, options.most_log_bytes), options.aircraft_id);
    const double until_s = time_of(moment, candidates, sortie, options.segmentation);
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

/// The cruise by the physical model at this flight's own level.
mechanical::RestPrediction predict_motion(const cli::StageCall& call, const mechanical::MechanicalModel& model,
                                          const mechanical::FlightProgress& flown, const mechanical::AirMotion& motion,
                                          double remaining_s) {
    const auto file = call.get<std::string>("model");
    if (!model.physical || !model.physical->level_sd) {
        throw InputError({file}, model.physical ? "its [physical] rests on a single flight" : "it has no [physical]",
                         "--airspeed needs one of two flights or more: flightwatt fit --model physical FLIGHT...");
    }
    if (!flown.motion.lacks.empty())
        cli::warn(call, fmt::format("this flight's own level is not known: {}", flown.motion.lacks));
    const auto& speeds = model.physical->airspeed_m_per_s;
    if (!was_flown(*model.physical, motion)) {
        cli::warn(call,
                  fmt::format("{:.1f} m/s at {:+.1f} m/s of climb is beyond what the model's flights flew: {:.1f} to "
                              "{:.1f} m/s, {:+.1f} to {:+.1f} m/s of climb",
                              motion.airspeed_m_per_s, motion.climb_m_per_s, speeds.low, speeds.high,
                              model.physical->climb_m_per_s.low, model.physical->climb_m_per_s.high));
    }
    return predict_rest_by_motion(*model.physical, flown, terms_of(motion), remaining_s);
}

/// What --initial-soc gives.
std::optional<double> read_initial_soc(const cli::StageCall& call) {
    if (!call.has("initial-soc")) return std::nullopt;
    if (!call.has("battery")) throw UsageError("--initial-soc goes with --battery");
    return cli::number_option(call, "initial-soc", 0.0, units::percent_per_whole);
}

/// The battery that --battery names through the rest, from what was measured of it until now.
std::optional<BatteryPrediction> predict_battery(const cli::StageCall& call, const flight::FlightSeries& series,
                                                 const Prediction& prediction) {
    const auto file = call.maybe<std::string>("battery");
    if (!file) return std::nullopt;
    const auto battery = battery::read_battery(*file);
    for (const auto& warning : battery_warnings(battery)) cli::warn(call, fmt::format("{}: {}", *file, warning));
    const auto records = battery::discharge_records(series);
    for (const auto& note : records.notes) cli::note(call, note);
    const auto& record = records.records.back();
    BatteryPrediction of;
    of.initial_is_measured = !prediction.initial_soc_percent;
    if (prediction.initial_soc_percent) {
        of.initial_soc_percent = *prediction.initial_soc_percent;
    } else if (battery.thevenin) {
        const double rest_v = record.resting_voltage_v + battery.resistance_ohm * record.resting_current_a;
        of.initial_soc_percent = battery::resting_soc_percent(battery, rest_v);
    } else {
        throw InputError({*file}, "a battery of constant voltage does not tell its state of charge",
                         "give --initial-soc PERCENT");
    }
    const auto now = battery::state_after(battery, record, of.initial_soc_percent);
    const auto forecast = [&](double part) {
        const std::array<battery::PowerStretch, 2> ahead{
            {{prediction.cruise.remaining_mean_w * part, prediction.remaining_s},
             {units::joule_from_wh(prediction.landing.energy_wh) / prediction.landing_s * part, prediction.landing_s}}};
        return battery::forecast_landing(battery, now, ahead);
    };
    of.expected = forecast(1.0);
    of.worst =
        forecast(prediction.rest.energy_wh > 0.0 ? prediction.interval.high_wh / prediction.rest.energy_wh : 1.0);
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

Prediction predict_flight(const cli::StageCall& call) {
    Prediction prediction;
    const auto moment = moment_of(call);
    if (!call.has("remaining")) throw UsageError("no time left given: expected --remaining SECONDS");
    constexpr double longest_s = 1e6;  // no battery flies for eleven days
    prediction.remaining_s = cli::number_option(call, "remaining", 0.0, longest_s);
    const auto motion = motion_ahead(call);
    prediction.initial_soc_percent = read_initial_soc(call);
    const auto model = read_spread_model(call);
    auto known = read_progress(call, moment);
    prediction.flown = std::move(known.flown);
    prediction.cruise = motion ? predict_motion(call, model, prediction.flown, *motion, prediction.remaining_s)
                               : predict_level(call, model, prediction.flown, prediction.remaining_s);
    prediction.landing_s = model.phases[flight::Phase::landing].duration_s;
    prediction.landing =
        mechanical::predict_before_flight(forecast_of(model, flight::Phase::landing), prediction.landing_s);
    prediction.rest = sum_of(prediction.cruise.energy, prediction.landing);
    prediction.interval = interval_95(prediction.rest).value();
    prediction.battery = predict_battery(call, known.series, prediction);
    return prediction;
}

std::string landing_text(const battery::LandingForecast& forecast) {
    if (forecast.fails_after_s) return fmt::format("the battery fails in {:.1f} min", *forecast.fails_after_s / 60.0);
    return fmt::format("{:.1f} % and {:.2f} V at landing, {:.1f} min of cruise left", forecast.soc_percent,
                       forecast.voltage_v, forecast.seconds_left / 60.0);
}

std::string battery_text(const std::optional<BatteryPrediction>& battery) {
    if (!battery) return "";
    return fmt::format(
        "battery    {:.1f} % now, from {:.1f} % {}; {}\n"
        "           at the high end of the interval {}\n",
        battery->expected.soc_now_percent, battery->initial_soc_percent,
        battery->initial_is_measured ? "by its voltage at rest" : "as given", landing_text(battery->expected),
        landing_text(battery->worst));
}

std::string text_of(const Prediction& prediction) {
    const auto& [flown, remaining_s, cruise, landing, landing_s, rest, interval, initial_soc, battery] = prediction;
    return fmt::format(
               "flown      {:.3f} Wh from lift-off at {:.1f} s to {:.1f} s of the log ({:.1f} s)\n"
               "cruise     {:.3f} Wh in {:.0f} s more: {:.2f} W; so far {:.2f} W, expected {:.2f} W, of the "
               "difference {:.0f} % goes on\n"
               "landing    {:.3f} Wh in {:.0f} s, as in the model\n"
               "remaining  {:.3f} Wh, 95 % interval {:.3f} to {:.3f} Wh\n"
               "total      {:.3f} Wh\n",
               flown.energy_wh, flown.lift_off_s, flown.until_s, flown.until_s - flown.lift_off_s,
               cruise.energy.energy_wh, remaining_s, cruise.remaining_mean_w, cruise.flown_w, cruise.expected_w,
               units::percent_of(cruise.gain, 1.0), landing.energy_wh, landing_s, rest.energy_wh, interval.low_wh,
               interval.high_wh, flown.energy_wh + rest.energy_wh) +
           battery_text(battery);
}

nlohmann::ordered_json json_of(const battery::LandingForecast& forecast) {
    return {{"soc_percent", forecast.soc_percent},
            {"voltage_v", forecast.voltage_v},
            {"seconds_left", forecast.seconds_left},
            {"fails_after_s", cli::optional_json(forecast.fails_after_s)}};
}

nlohmann::ordered_json json_of(const Prediction& prediction) {
    const auto& [flown, remaining_s, cruise, landing, landing_s, rest, interval, initial_soc, battery] = prediction;
    nlohmann::ordered_json json{{"flown_energy_wh", flown.energy_wh},
                                {"remaining_energy_wh", rest.energy_wh},
                                {"interval_95_wh", {interval.low_wh, interval.high_wh}},
                                {"total_energy_wh", flown.energy_wh + rest.energy_wh},
                                {"lift_off_s", flown.lift_off_s},
                                {"until_s", flown.until_s},
                                {"cruise",
                                 {{"remaining_s", remaining_s},
                                  {"energy_wh", cruise.energy.energy_wh},
                                  {"flown_mean_w", cruise.flown_w},
                                  {"expected_mean_w", cruise.expected_w},
                                  {"remaining_mean_w", cruise.remaining_mean_w},
                                  {"gain", cruise.gain}}},
                                {"landing", {{"duration_s", landing_s}, {"energy_wh", landing.energy_wh}}}};
    if (battery) {
        json["battery"] = {{"initial_soc_percent", battery->initial_soc_percent},
                           {"soc_now_percent", battery->expected.soc_now_percent},
                           {"at_landing", json_of(battery->expected)},
                           {"at_landing_high_energy", json_of(battery->worst)}};
    }
    return json;
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
        "predict", "FLIGHT.data|SERIES.csv --model MODEL.toml --remaining S",
        R"(Predicts the energy from a moment in cruise to the end of the flight. What was measured until then
moves the cruise level of the model towards this flight's own, weighted by the variances between
flights and within one. Nothing after the moment is looked at: a log that ends there gives the same.
The remaining energy is that of --remaining more seconds of cruise and of a landing as in the model
(its duration, too); with --airspeed the cruise is what the physical model says of it. The 95 %
interval is that of the remaining energy; it holds the spread between flights, the drift within one,
and that the model rests on few flights.)"};
    stage.max_inputs = 1;
    auto add = stage.options.add_options();
    add("model", cli::input_file("MODEL.toml"), "from flightwatt fit, of two flights or more");
    add("until", cli::value("S|now")->default_value("now"),
        "the moment, in seconds since lift-off as flightwatt segment finds it in what was flown; now: the end of the "
        "log, which may still grow");
    add("until-log-time", cli::value<double>("S"), "the moment in the log's own seconds, instead of --until");
    add("remaining", cli::value<double>("S"), "seconds from the moment until landing begins");
    add("level", cli::value("HOW")->default_value("auto"),
        "what is expected of the cruise before its own power is looked at: the model's curve, the curve's "
        "mean (constant), the power that the airspeed so far and the other flights' later one stand for (airspeed), or "
        "that of the "
        "model's level law (covariate); auto is covariate for a model that was fitted with "
        "--level-covariate, and else curve");
    add("airspeed", cli::value<double>("M_PER_S"),
        "how fast the rest of the cruise is flown: predicts it by the model's [physical] at this flight's own level");
    add("climb", cli::value<double>("M_PER_S"), "and how fast it climbs (0; below 0 it descends)");
    add("battery", cli::input_file("BATTERY.toml"),
        "also tell state of charge and voltage at landing, and how long the cruise could go on from there");
    add("initial-soc", cli::value<double>("PERCENT"),
        "the battery's state of charge when the log begins; else by its voltage at rest");
    cli::add_flight_options(stage.options);
    return cli::run_stage(argc, argv, stage, predict);
}
