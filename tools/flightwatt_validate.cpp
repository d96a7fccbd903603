// flightwatt validate: leaves each flight out, fits the others and predicts its energy.

#include "cli/output/fit_output.h"
#include "cli/output/flight_options.h"
#include "cli/output/prediction_output.h"
#include "cli/output/stage_options.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "cli/terminal.h"
#include "stages.h"

#include <algorithm>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

/// Those that are in the air at the moment, with what they had flown by then.
std::vector<mechanical::MeasuredFlight> in_the_air(const cli::StageCall& call, const flight::LoadedFlight& loaded,
                                                   mechanical::MeasuredFlights measured, double until_s) {
    std::vector<mechanical::MeasuredFlight> flights;
    for (std::size_t i = 0; i < measured.flights.size(); ++i) {
        auto& flight = measured.flights[i];
        try {
            const auto& sortie = loaded.phases.sorties[measured.sorties[i]];
            flight.flown = mechanical::progress_after_lift_off(loaded.series, sortie, until_s);
            auto spans = mechanical::phase_spans(sortie);
            for (auto& span : spans) span.start_s = std::max(span.start_s, flight.flown->until_s);
            std::erase_if(spans, [](const auto& span) { return span.duration_s() <= 0.0; });
            flight.remaining = mechanical::bin_flight(loaded.data, spans).bins;
            flights.push_back(std::move(flight));
        } catch (const NoResultError& error) {
            cli::add_diagnostic(call, {Severity::warning, "not in the air at the moment",
                                       fmt::format("it is not used: {}", error.what()), flight.samples.flight});
        }
    }
    return flights;
}

/// The flights of all inputs. In flight, those that are not in the air at the moment are excluded.
std::vector<mechanical::MeasuredFlight> read_flights(const cli::StageCall& call, const cli::FlightArguments& arguments,
                                                     const std::optional<double>& at_s) {
    if (!at_s) return cli::measured_flights(call, arguments);
    auto flights =
        cli::from_flights<mechanical::MeasuredFlight>(call, arguments, [&](const auto& file, const auto& loaded) {
            auto measured = mechanical::extract_flights(loaded);
            cli::add_exclusions(call, arguments, file, measured.exclusions);
            return in_the_air(call, loaded, std::move(measured), *at_s);
        });
    cli::exclude_hover(call, arguments, flights);
    return flights;
}

struct ValidateArguments {
    mechanical::ModelFitOptions fit;
    std::optional<double> at_s;
    std::size_t folds = mechanical::max_validation_folds;
    cli::FlightArguments flights;
};

int validate_flights(const cli::StageCall& call, const ValidateArguments& arguments) {
    const auto& [options, at_s, folds, flight_arguments] = arguments;
    const auto flights = read_flights(call, flight_arguments, at_s);
    cli::note_folds(call, flights.size(), folds);
    cli::ProgressBar fitting("fits");
    auto validated = leave_one_out(flights, options, fitting.callback(), folds);
    fitting.hide();
    if (const auto rejected = remove_rejected(validated); !rejected.empty()) cli::note(call, rejected);
    const auto screen = call.output ? cli::Screen() : screen_of(call);
    cli::write_result(call, cli::validation_text(validated, screen));
    if (call.json) cli::print_json(call, cli::ValidationOutput{validated, std::min(flights.size(), folds)});
    return cli::ok;
}

}  // namespace

int flightwatt::stages::validate_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "validate", "LOG|SERIES.csv|FOLDER...",
        R"(Leaves one flight out, fits the others, and predicts the energy of each of its phases and of the whole
from their durations alone; then compares with the integral of the power that was measured. Models:
  fourier         the Fourier series of this project
  constant_mean   the other flights' mean power in the phase
  physical        power from the airspeed and climb that were flown, as if they had been known before
                  (flightwatt fit --model-kind physical); where flights measured them
With --at S: S seconds after its lift-off a flight has measured its energy up to then; the rest is
predicted from the durations of its phases, by the models above as before the flight, and by
  in_flight           the level of each phase shrunk between model and flight (see flightwatt predict)
  in_flight_constant  the same about the model's mean power
  in_flight_physical      the physical model at this flight's own level, on the airspeed and climb of the
                      rest as they were flown, as if they had been known
Errors in percent are parts of the measured energy of phase or flight, the flown part included; none for landing,
whose power is near zero. Bias is predicted less measured. physical is rejected, and not shown,
where the mean power predicts better.)" +
            std::string(cli::several_flights_text)};
    stage.next = [](const auto&) { return "flightwatt fit {in} -o MODEL.toml"; };
    stage.json_schema = cli::document_schema<cli::ValidationOutput>;
    stage.examples = {"flightwatt validate my", "flightwatt validate my --at 120 --json"};
    stage.reads_logs = stage.uses_threads = stage.shows_table = true;
    ValidateArguments arguments;
    auto& options = stage.options;
    cli::add_fit_options(options, arguments.fit);
    options.add("at", arguments.at_s,
                {.value = "S", .min = 0.0, .above_min = true, .unit = "s since lift-off", .old_name = "until"},
                "validate the prediction in flight, S seconds after lift-off");
    cli::add_folds_option(options, arguments.folds);
    cli::add_flight_options(options, arguments.flights);
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return validate_flights(call, arguments); });
}
