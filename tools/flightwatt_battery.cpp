// flightwatt battery: flights to the battery that they were flown on.

#include "battery/battery_toml.h"
#include "battery/identification.h"
#include "cli/output/battery_output.h"
#include "cli/output/flight_options.h"
#include "cli/output/pack_input.h"
#include "cli/output/pack_output.h"
#include "cli/output/stage_options.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "cli/terminal.h"
#include "stages.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

struct BatteryArguments {
    battery::IdentificationOptions identification;
    cli::FlightArguments flights;
    std::optional<std::string> name;
    std::optional<std::size_t> circuit;
    cli::PackArguments packs;
    std::size_t folds = battery::max_battery_folds;
};

battery::IdentificationOptions identification_options(const cli::StageCall& call, const BatteryArguments& arguments) {
    auto options = arguments.identification;
    options.name =
        arguments.name.value_or(call.output ? std::filesystem::path(*call.output).stem().string() : "identified");
    return options;
}

int identify(const cli::StageCall& call, const BatteryArguments& arguments) {
    const auto options = identification_options(call, arguments);
    const auto folds = arguments.folds;
    const auto records =
        records_of(call, cli::read_pack_uses(call, arguments.flights, arguments.packs, arguments.circuit));
    cli::note_folds(call, records.size(), folds);
    cli::ProgressBar identifying("identifications");
    const auto identified = identify_battery(records, options);
    const auto show = [&](std::size_t done, std::size_t all) { identifying.show(done + 1, all + 1); };
    const auto left_out = leave_one_out(records, options, show, folds);
    identifying.hide();
    for (const auto& [text, is_warning] : cli::battery_remarks(identified))
        is_warning ? cli::warn(call, text) : cli::note(call, text);
    if (left_out.empty()) cli::note(call, "a single flight: there is no other one to check the battery with");
    cli::write_result(call, cli::provenance(identified) + to_toml(identified.battery));
    if (call.json) {
        const auto groups = left_out.empty() ? std::nullopt : std::optional(std::min(records.size(), folds));
        cli::print_json(call, cli::BatteryOutput{&identified, &left_out, groups});
    } else if (call.output) {
        const auto screen = screen_of(call);
        const cli::ScreenTable flights{
            fmt::format("{} flight{}", records.size(), records.size() == 1 ? "" : "s"),
            {"flight", "own ohm", "drawn Ah", "missing Ah", "leave-one-out mV", "at rest V"}};
        cli::print(screen_text(cli::pack_table(identified.battery), screen, {identified.battery.name, {}}) + "\n" +
                   screen_text(cli::flights_table(identified, left_out), screen, flights));
    }
    return cli::ok;
}

}  // namespace

int flightwatt::stages::battery_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "battery", "LOG|SERIES.csv|FOLDER...",
        R"(Identifies the battery from the flights' own voltage, current and charge: open-circuit voltage over
state of charge, series resistance and one RC pair, with 95 % intervals, for missions (model =
"thevenin"). The battery goes to the standard output as TOML; with -o it goes to the file, and its
parameters and flights are shown: how well each flight's voltage is met, and how well the others
predict it. What was missing from the pack when a flight began is estimated with it. Each flight's own
resistance shows the pack's state of health. Flights whose current was computed from throttle are refused.)" +
            std::string(cli::several_flights_text)};
    stage.next = [](const auto&) { return "flightwatt new-mission --model MODEL.toml --battery {} -o mission.toml"; };
    stage.json_schema = cli::document_schema<cli::BatteryOutput>;
    stage.examples = {"flightwatt battery my --capacity 2.2 -o pack.toml",
                      "flightwatt battery my/flights/*.csv --cells 3"};
    stage.reads_logs = stage.uses_threads = stage.shows_table = true;
    BatteryArguments arguments;
    auto& options = stage.options;
    cli::add_capacity_option(
        options, arguments.identification.capacity_ah,
        "the pack's capacity, compared with the flights' estimate; default: the charge that a flight drew from full to "
        "empty, or else an estimate from the usual charts of lithium cells");
    options.add(
        "cells", arguments.identification.cells, {.value = "N", .min = 1, .max = 24},
        "cells in series, checked against the voltage at rest; default: as the logs state, or by the highest resting "
        "voltage");
    options.add("circuit", arguments.circuit, {.value = "N", .min = 1, .max = 16},
                "of a vehicle with circuits of different voltages, as segment lists them; default: the one with the "
                "most energy");
    cli::add_pack_options(options, arguments.packs);
    cli::add_folds_option(options, arguments.folds);
    options.add("name", arguments.name, {.value = "NAME"}, "the battery's name; default: FILE's");
    cli::add_flight_options(options, arguments.flights);
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return identify(call, arguments); });
}
