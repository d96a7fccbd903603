// flightwatt predict: the energy to the end of a flight that is in the air.

#include "cli/output/flight_options.h"
#include "cli/output/live_options.h"
#include "cli/output/prediction_output.h"
#include "cli/stage.h"
#include "flight/flight_series.h"
#include "flight/select.h"
#include "live/prediction.h"
#include "mechanical/prediction.h"
#include "stages.h"

#include <fmt/format.h>

namespace {

using namespace flightwatt;
using cli::Prediction;

struct PredictArguments {
    cli::BasisArguments basis;
    cli::RequestedTime time;
    flight::LoadOptions load;
};

/// A flight at a time, and its log up to then.
struct KnownFlight {
    mechanical::FlightProgress flown;
    flight::FlightData data;
};

/// The state at the requested time. No later part of the log is used, for any choice, check or message.
KnownFlight read_progress(const cli::StageCall& call, const cli::RequestedTime& time, flight::LoadOptions options) {
    const auto sortie = options.sortie.value_or(1) - 1;
    options.sortie.reset();
    options.flight_required = false;
    options.bridges_link_gaps = true;
    const auto& file = call.inputs.front();
    auto candidates = cli::read_recording(call, file, options);
    const double until_s = cli::resolve_log_time(time, candidates, sortie, options.segmentation);
    for (auto& series : candidates) series = truncate_series(series, until_s);
    auto series = choose_aircraft(std::move(candidates));
    cli::refuse_unknown_flights(options, {series.flight});
    if (select_tracks(series).power_w.empty() && !series.clock_restart) {
        throw NoResultError(fmt::format("{}: no power was measured by {:.1f} s of the log", series.flight, until_s));
    }
    auto loaded = segment_and_check(std::move(series), options);
    cli::add_diagnostics(call, file, loaded);
    if (!loaded.exclusion.empty()) {
        cli::warn(call, fmt::format("{}: no prediction can be trusted: {}", file, loaded.exclusion));
    }
    const auto& sorties = loaded.phases.sorties;
    const auto* flying = sortie < sorties.size() ? &sorties[sortie] : nullptr;
    auto flown = mechanical::progress_of(loaded.data, flying, until_s, options.segmentation);
    return {std::move(flown), std::move(loaded.data)};
}

Prediction predict_flight(const cli::StageCall& call, const PredictArguments& arguments) {
    const auto basis = cli::read_basis(call, arguments.basis);
    const auto known = read_progress(call, arguments.time, arguments.load);
    live::Remarks remarks;
    try {
        auto prediction = live::predict_flight(basis, known.flown, known.data, remarks);
        if (const auto deviation = live::model_deviation(prediction, basis); deviation.fraction > 1.0)
            remarks.warnings.push_back(deviation.text + ": is it the model of this aircraft, as it flies today?");
        cli::warn_of(call, remarks);
        return prediction;
    } catch (...) {
        cli::warn_of(call, remarks);
        throw;
    }
}

int predict(const cli::StageCall& call, const PredictArguments& arguments) {
    const auto prediction = predict_flight(call, arguments);
    cli::write_result(call, cli::text_of(prediction));
    if (call.json) cli::print_json(call, prediction);
    return cli::ok;
}

}  // namespace

int flightwatt::stages::predict_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "predict", "LOG|SERIES.csv --model MODEL.toml --remaining S | --mission MISSION.toml",
        R"(Predicts the energy from a moment after lift-off to the end of the flight. What was measured until then
moves the cruise level of the model towards this flight's own, weighted by the variances between
flights and within one. No later part of the log is used: a log that ends there gives the same result.
The remaining energy is that of --remaining more seconds of cruise and of a landing as in the model
(its duration, too); with --airspeed the cruise has the power of the physical model, with --mission
that of the remaining path in its wind. The 95 % interval of the remaining energy includes the
variability between flights, the drift within one, that of the wind, and the uncertainty of a model
from few flights.)"};
    stage.json_schema = cli::document_schema<cli::Prediction>;
    stage.max_inputs = 1;
    stage.examples = {"flightwatt predict flight.data --model model.toml --remaining 600",
                      "flightwatt predict flight.data --mission mission.toml --at 300 --battery pack.toml"};
    stage.reads_logs = true;
    PredictArguments arguments;
    cli::add_basis_options(stage.options, arguments.basis);
    cli::add_time_options(stage.options, arguments.time);
    cli::add_flight_options(stage.options, arguments.load);
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return predict(call, arguments); });
}
