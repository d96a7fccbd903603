// flightwatt predict: the energy to the end of a flight that is in the air.

#include "base/error.h"
#include "base/units.h"
#include "cli/numeric_options.h"
#include "cli/output/flight_options.h"
#include "cli/output/json_text.h"
#include "cli/stage.h"
#include "flight/chosen_track.h"
#include "flight/flight_series.h"
#include "mechanical/model_check.h"
#include "mechanical/prediction.h"

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

/// The moment that is asked for: since lift-off, or on the log's clock.
struct Moment {
    std::optional<double> since_lift_off_s;
    double log_time_s = 0.0;
};

Moment moment_of(const cli::StageCall& call) {
    if (call.has("until") == call.has("until-log-time")) {
        throw UsageError("expected either --until (seconds since lift-off) or --until-log-time");
    }
    return {cli::positive_option(call, "until", "s"), cli::positive_option(call, "until-log-time", "s").value_or(0.0)};
}

/// When it is: of several aircraft, when the first has flown so long.
double time_of(const Moment& moment, const std::vector<flight::FlightSeries>& candidates, std::size_t sortie,
               const flight::SegmentationOptions& options) {
    if (!moment.since_lift_off_s) return moment.log_time_s;
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

struct Prediction {
    mechanical::FlightProgress flown;
    double remaining_s = 0.0;
    mechanical::RestPrediction cruise;
    mechanical::EnergyEstimate landing;
    double landing_s = 0.0;
    mechanical::EnergyEstimate rest;
    mechanical::EnergyInterval interval;
};

/// What was known at the moment: nothing that the log wrote later is looked at, in what is read, chosen,
/// judged or said.
mechanical::FlightProgress read_progress(const cli::StageCall& call, const Moment& moment) {
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
    const auto loaded = examine_flight(std::move(series), options);
    cli::warn_of(call, file, loaded);
    if (!loaded.exclusion.empty()) {
        cli::warn(call, fmt::format("{}: no prediction can be trusted: {}", file, loaded.exclusion));
    }
    return mechanical::progress_at(loaded.series, until_s, sortie, options.segmentation);
}

Prediction predict_flight(const cli::StageCall& call) {
    Prediction prediction;
    const auto moment = moment_of(call);
    if (!call.has("remaining")) throw UsageError("no time left given: expected --remaining SECONDS");
    constexpr double longest_s = 1e6;  // no battery flies for eleven days
    prediction.remaining_s = cli::number_option(call, "remaining", 0.0, longest_s);
    const auto model = read_spread_model(call);
    prediction.flown = read_progress(call, moment);
    const auto& cruise = model.phases[flight::Phase::cruise];
    const auto source = level_source(call, cruise, prediction.flown);
    prediction.cruise = predict_rest(mechanical::forecast_of(model, flight::Phase::cruise), prediction.flown,
                                     prediction.remaining_s, source);
    if (source == mechanical::LevelSource::covariate) warn_of_reach(call, cruise, prediction.flown);
    prediction.landing_s = model.phases[flight::Phase::landing].duration_s;
    prediction.landing =
        mechanical::predict_before_flight(forecast_of(model, flight::Phase::landing), prediction.landing_s);
    prediction.rest = sum_of(prediction.cruise.energy, prediction.landing);
    prediction.interval = interval_95(prediction.rest).value();
    return prediction;
}

std::string text_of(const Prediction& prediction) {
    const auto& [flown, remaining_s, cruise, landing, landing_s, rest, interval] = prediction;
    return fmt::format(
        "flown      {:.3f} Wh from lift-off at {:.1f} s to {:.1f} s of the log ({:.1f} s)\n"
        "cruise     {:.3f} Wh in {:.0f} s more: {:.2f} W; so far {:.2f} W, expected {:.2f} W, of the "
        "difference {:.0f} % goes on\n"
        "landing    {:.3f} Wh in {:.0f} s, as in the model\n"
        "remaining  {:.3f} Wh, 95 % interval {:.3f} to {:.3f} Wh\n"
        "total      {:.3f} Wh\n",
        flown.energy_wh, flown.lift_off_s, flown.until_s, flown.until_s - flown.lift_off_s, cruise.energy.energy_wh,
        remaining_s, cruise.remaining_mean_w, cruise.flown_w, cruise.expected_w, units::percent_of(cruise.gain, 1.0),
        landing.energy_wh, landing_s, rest.energy_wh, interval.low_wh, interval.high_wh,
        flown.energy_wh + rest.energy_wh);
}

nlohmann::ordered_json json_of(const Prediction& prediction) {
    const auto& [flown, remaining_s, cruise, landing, landing_s, rest, interval] = prediction;
    return {{"flown_energy_wh", flown.energy_wh},
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
        "predict", "FLIGHT.data|SERIES.csv --model MODEL.toml --until S --remaining S",
        R"(Predicts the energy from a moment in cruise to the end of the flight. What was measured until then
moves the cruise level of the model towards this flight's own, weighted by the variances between
flights and within one. Nothing after the moment is looked at: a log that ends there gives the same.
The remaining energy is that of --remaining more seconds of cruise and of a landing as in the model
(its duration, too). The 95 % interval is that of the remaining energy; it holds the spread between
flights, the drift within one, and that the model rests on few flights.)"};
    stage.max_inputs = 1;
    auto add = stage.options.add_options();
    add("model", cli::input_file("MODEL.toml"), "from flightwatt fit, of two flights or more");
    add("until", cli::value<double>("S"),
        "the moment, in seconds since lift-off as flightwatt segment finds it in what was flown");
    add("until-log-time", cli::value<double>("S"), "the moment in the log's own seconds, instead of --until");
    add("remaining", cli::value<double>("S"), "seconds from the moment until landing begins");
    add("level", cli::value("HOW")->default_value("auto"),
        "what is expected of the cruise before its own power is looked at: the model's curve, the curve's "
        "mean (constant), the power that the airspeed measured so far stands for (airspeed), or that of the "
        "model's level law (covariate); auto is covariate for a model that was fitted with "
        "--level-covariate, and else curve");
    cli::add_flight_options(stage.options);
    return cli::run_stage(argc, argv, stage, predict);
}
