// flightwatt battery: flights to the battery that they were flown on.

#include "base/error.h"
#include "battery/identification.h"
#include "cli/output/battery_output.h"
#include "cli/output/flight_options.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "cli/terminal.h"
#include "stages.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

battery::IdentificationOptions identification_options(const cli::StageCall& call) {
    battery::IdentificationOptions options;
    options.capacity_ah = cli::capacity_option(call);
    if (call.has("cells")) options.cells = static_cast<int>(cli::count_option(call, "cells", 1, 24));
    options.link_packs = !call.has("no-chain");
    options.name = call.get_optional<std::string>("name").value_or(
        call.output ? std::filesystem::path(*call.output).stem().string() : "identified");
    return options;
}

/// The records that can be used; each flight that cannot is named, with the reason.
std::vector<battery::DischargeRecord> read_records(const cli::StageCall& call) {
    auto options = cli::read_flight_options(call);
    options.flight_required = false;  // without altitude there is no telling power faults, but a battery
    std::optional<InputError> last_refusal;
    const auto read = [&](const std::string& file, const flight::LoadedFlight& loaded) {
        try {
            if (!loaded.exclusion.empty()) {
                throw InputError({file}, fmt::format("{}: {}", loaded.series.flight, loaded.exclusion));
            }
            auto found = battery::discharge_records(loaded.series);
            for (const auto& text : found.notes) cli::warn(call, fmt::format("{}: {}", file, text));
            return std::move(found.records);
        } catch (const InputError& error) {
            if (call.inputs.size() == 1) throw;
            cli::warn(call, fmt::format("excluded: {}", error.what()));
            last_refusal = error;
            return std::vector<battery::DischargeRecord>{};
        }
    };
    auto records = cli::from_flights<battery::DischargeRecord>(call, options, read);
    if (records.empty() && last_refusal) throw InputError(*last_refusal);
    return records;
}

/// How the capacity that was given agrees with the one that the flights indicate.
void compare_capacity(const cli::StageCall& call, const battery::Battery& pack) {
    if (const auto warning = capacity_warning(pack); !warning.empty())
        cli::warn(call, warning);
    else
        cli::note(call, cli::describe_given_capacity(pack));
}

void note_what_it_rests_on(const cli::StageCall& call, const battery::BatteryIdentification& identified) {
    if (const auto warning = cli::cells_warning(identified); !warning.empty()) cli::warn(call, warning);
    for (const auto& limit : cli::curve_limits(identified)) cli::note(call, limit);
    for (const auto& flight : identified.flights) {
        if (flight.link)
            cli::note(call, cli::describe_link(flight) + "; --no-chain takes no flight for another's pack");
    }
    if (!identified.battery.intervals.resistance_scatter)
        cli::note(
            call,
            "how the series resistance differs between flights is not known, as fewer than two flights have one of "
            "their own: missions draw it by its interval alone");
    if (identified.trend) cli::note(call, cli::describe(*identified.trend));
    if (identified.capacity.origin == battery::CapacityOrigin::given) compare_capacity(call, identified.battery);
    if (identified.capacity.origin == battery::CapacityOrigin::chart) {
        cli::warn(call, fmt::format("the flights do not tell the capacity, as none runs empty: {}; give what "
                                    "the pack says with --capacity",
                                    cli::describe(identified.capacity)));
    }
    if (identified.fit.rc_resistance_ohm == 0.0) {
        cli::warn(call, "no RC pair explains anything: the battery has none");
    } else if (identified.errors.rc_resistance_ohm.low == 0.0) {
        cli::warn(call, "the RC pair may be none: its resistance's interval reaches down to 0");
    }
}

/// On all records, and on all but each in turn: that is long work.
std::pair<battery::BatteryIdentification, std::vector<battery::LeaveOneOutCheck>> identify_and_check(
    const std::vector<battery::DischargeRecord>& records, const battery::IdentificationOptions& options,
    std::size_t folds) {
    cli::ProgressBar identifying("identifications");
    auto identified = identify_battery(records, options);
    const auto show = [&](std::size_t done, std::size_t all) { identifying.show(done + 1, all + 1); };
    return {std::move(identified), leave_one_out(records, options, show, folds)};
}

int identify(const cli::StageCall& call) {
    const auto options = identification_options(call);
    const auto folds = cli::count_option(call, "folds", 2);
    const auto records = read_records(call);
    cli::note_folds(call, records.size(), folds);
    const auto [identified, left_out] = identify_and_check(records, options, folds);
    note_what_it_rests_on(call, identified);
    if (left_out.empty()) cli::note(call, "a single flight: there is no other one to check the battery with");
    cli::write_result(call, cli::provenance(identified) + to_toml(identified.battery));
    if (call.json) {
        auto json = cli::to_json(identified, left_out);
        if (!left_out.empty()) json["folds"] = std::min(records.size(), folds);
        cli::print(cli::json_text(json));
    } else if (call.output) {
        const auto screen = screen_of(call);
        const cli::ScreenTable flights{
            fmt::format("{} flights", records.size()),
            {"flight", "own ohm", "drawn Ah", "missing Ah", "leave-one-out mV", "at rest V"}};
        cli::print(screen_text(cli::pack_table(identified.battery), screen, {identified.battery.name, {}}) + "\n" +
                   screen_text(cli::flights_table(identified, left_out), screen, flights));
    }
    return cli::ok;
}

}  // namespace

int flightwatt::stages::battery_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "battery", "FLIGHT.data|SERIES.csv|FOLDER...",
        R"(Identifies the battery from the flights' own voltage, current and charge: open-circuit voltage over
state of charge, series resistance and one RC pair, with 95 % intervals, for missions (model =
"thevenin"). The battery goes to the standard output as TOML; with -o it goes to the file, and its
parameters and flights are shown: how well each flight's voltage is met, and how well the others
predict it. What was missing from the pack when a flight began is estimated with it, and a flight that
follows another on what looks like the same pack is chained to it. Each flight's own resistance tells
the pack's state of health. Flights whose current was computed from throttle are refused.)" +
            std::string(cli::several_flights_text)};
    stage.shows_table = true;
    auto add = stage.options.add_options();
    add("capacity", cli::value<double>("AH"),
        "the pack's capacity, compared with what the flights indicate; without it, what a flight drew from full to "
        "empty, or else a guess after the usual charts of lithium cells");
    add("cells", cli::value("N"),
        "cells in series, checked against the voltage at rest; default: by the highest resting voltage");
    cli::add_folds_option(stage.options, battery::max_battery_folds);
    add("no-chain", "take no flight for one on the pack of the flight before it");
    add("name", cli::value("NAME"), "the battery's name; default: FILE's");
    cli::add_mix_option(stage.options);
    cli::add_flight_options(stage.options);
    return cli::run_stage(argc, argv, stage, identify);
}
