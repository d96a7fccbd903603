// flightwatt LOG...: how long and how far an aircraft flies, from its logs, in one command.

#include "answer/answer.h"
#include "answer/flight_facts.h"
#include "answer/pack_answer.h"
#include "answer/pack_ledger.h"
#include "answer/pack_temperature.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/fingerprint.h"
#include "base/input_file.h"
#include "base/overwrite_guard.h"
#include "base/text.h"
#include "base/toml_reader.h"
#include "batch/manifest.h"
#include "battery/battery_toml.h"
#include "cli/output/aircraft_choice.h"
#include "cli/output/answer_output.h"
#include "cli/output/batch_folder.h"
#include "cli/output/battery_output.h"
#include "cli/output/flight_options.h"
#include "cli/output/pack_input.h"
#include "cli/output/requirement.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "cli/terminal.h"
#include "exchange/failsafe_parameters.h"
#include "mission/mission_file.h"
#include "mission/prepared_mission.h"
#include "mission/sampled_flights.h"
#include "report/answer_document.h"
#include "report/page.h"
#include "report/report.h"
#include "stages.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace flightwatt;

struct AnswerArguments {
    cli::BatchArguments batch;
    answer::Question question;
    std::optional<double> capacity_ah;
    std::optional<double> temperature_c;
    cli::PackArguments packs;
    std::optional<std::string> wind;
    std::optional<double> home_distance_m;
    cli::Requirement requirement;
    cli::SamplingArguments sampling;  ///< of the requirement
    std::optional<std::string> table;
    bool no_page = false;
    bool again = false;
};

/// What an answer leaves in its folder for --again, in addition to the model and the pack.
struct KeptAnswer {
    std::string key;  ///< of what it is repeated with, see key_of()
    std::string aircraft;
    std::string name;
    std::size_t logs = 0;
    std::size_t used = 0;
    std::optional<double> ground_speed_m_per_s;  ///< mean of the cruises
    double wing_share = 1.0;                     ///< see answer::wing_share()
    answer::Answered capacity_ah;
    answer::Answered resistance_ohm;
    answer::Answered resistance_at_ohm;  ///< at the temperature that was asked for
    std::optional<double> voltage_known_down_to_percent;
};

Fields<KeptAnswer> record_fields(const KeptAnswer*) {
    using R = KeptAnswer;
    return {field("key", &R::key),
            field("aircraft", &R::aircraft),
            field("name", &R::name),
            field("logs", &R::logs),
            field("used", &R::used),
            field("ground_speed_m_per_s", &R::ground_speed_m_per_s),
            field("wing_share", &R::wing_share),
            field("capacity_ah", &R::capacity_ah),
            field("resistance_ohm", &R::resistance_ohm),
            field("resistance_at_ohm", &R::resistance_at_ohm),
            field("voltage_known_down_to_percent", &R::voltage_known_down_to_percent)};
}

/// The call with the folder of one aircraft in place of its logs.
cli::StageCall folder_call(cli::StageCall call, const std::string& folder) {
    call.inputs = {folder};
    return call;
}

/// The pack of the flights in a folder, and the health of each pack that they name.
answer::FoundPack pack_of_folder(const cli::StageCall& call, const AnswerArguments& arguments,
                                 const std::vector<answer::FlightFacts>& facts, std::vector<answer::Pack>& health) {
    std::vector<answer::PackUse> uses;
    std::string no_uses_reason;
    try {
        uses = cli::read_pack_uses(call, arguments.batch.flights, arguments.packs);
    } catch (const InputError& error) {
        no_uses_reason = error.hint().empty() ? error.what() : fmt::format("{}; {}", error.what(), error.hint());
    }
    const auto capacity = choose_capacity(arguments.capacity_ah, facts);
    if (!capacity.warning.empty()) cli::warn(call, capacity.warning);
    auto pack = find_pack(records_of(call, uses), no_uses_reason, capacity, facts);
    if (pack.identified) {
        const auto ledger = make_pack_ledger(
            std::move(uses), {.capacity_ah = pack.answer.capacity_ah.value, .known = &*pack.identified});
        for (const auto& note : ledger.notes) cli::add_diagnostic(call, {Severity::note, "the pack", note});
        health = ledger.packs;
        if (pack.answer.capacity_ah.value && pack.identified->capacity.origin != battery::CapacityOrigin::given)
            pack.answer.capacity_ah.basis += capacity_doubt(health);
    }
    if (arguments.temperature_c) set_temperature(pack, *arguments.temperature_c, health);
    for (const auto& warning : pack.warnings) cli::warn(call, warning);
    if (pack.identified)
        for (const auto& remark : cli::battery_remarks(*pack.identified))
            cli::add_diagnostic(call, {Severity::note, "the pack", remark.text});
    return pack;
}

answer::Answered prediction_error(const mechanical::MechanicalModel& model) {
    if (model.validation)
        for (const auto& score : model.validation->scores)
            if (score.model == model.validation->default_model)
                return answer::known(score.mean_absolute_error_percent,
                                     fmt::format("{} flights, each left out", score.flights));
    return answer::unknown(
        model.flights.size() == 1
            ? "a second flight would show how well the first predicts it"
            : "the flights do not predict each other; more flights with all three phases would show it");
}

/// The values of a failsafe for the mission of the question, or the reason why they are absent.
void add_failsafe(const AnswerArguments& arguments, const answer::KnownAircraft& aircraft,
                  const mission::MissionSetup& mission, cli::AircraftAnswer& answer) {
    if (const auto& missing = missing_of(aircraft.pack); !missing.empty()) {
        answer.failsafe_missing = missing;
        return;
    }
    answer::FailsafeRequest request{.model = mission.mechanical.value(), .battery = mission.battery};
    request.payload = mission.payload;
    request.reserve_percent = arguments.question.reserve_soc_percent;
    request.home_distance_m = arguments.home_distance_m;
    for (const auto& flight : aircraft.flights)
        request.flown_distance_m = std::max(request.flown_distance_m, flight.farthest_m);
    request.wind.speed_m_per_s = arguments.question.wind_m_per_s;
    request.airspeed_m_per_s = answer.endurance.return_airspeed_m_per_s.value;
    try {
        answer.failsafe = make_failsafe_card(request);
        if (const auto& cold = aircraft.pack.resistance_at_ohm; cold.value)
            answer.failsafe->grounds.push_back(
                {cold.basis.starts_with("assumed") ? answer::Ground::assumption : answer::Ground::measured,
                 fmt::format("resistance at {:g} degC: {}", *arguments.temperature_c, cold.basis)});
    } catch (const NoResultError& error) {
        answer.failsafe_missing = error.what();
    } catch (const InputError& error) {
        answer.failsafe_missing = error.what();
    }
}

/// The failsafe of each autopilot as flightwatt export writes it, or why it is absent.
std::vector<std::pair<std::string, std::string>> failsafe_texts(const std::optional<answer::FailsafeCard>& card,
                                                                const mission::MissionSetup& mission) {
    std::vector<std::pair<std::string, std::string>> texts;
    if (!card) return texts;
    const exchange::EstimatorInput aircraft{.model = mission.mechanical, .battery = mission.battery};
    const auto add = [&](const char* name, const auto& write) {
        auto& text = texts.emplace_back(fmt::format("Failsafe for {}, to paste", name), "").second;
        try {
            text = write(aircraft, *card).text;
        } catch (const InputError& error) {
            text = fmt::format("none: {}", error.what());
        }
    };
    add("ArduPilot", exchange::to_failsafe_ardupilot);
    add("PX4", exchange::to_failsafe_px4);
    add("INAV", exchange::to_failsafe_inav);
    add("Paparazzi", exchange::to_failsafe_paparazzi);
    return texts;
}

/// Why the flight of the question, as long as those of the logs, misses what is required; empty where it does not.
std::string missed_requirement(const AnswerArguments& arguments, const answer::KnownAircraft& aircraft,
                               const std::filesystem::path& file) {
    if (!arguments.requirement.text) return "";
    if (const auto& missing = missing_of(aircraft.pack); !missing.empty()) return missing;
    const auto prepared = prepare_mission(mission::parse_mission(mission_toml(aircraft, arguments.question), file));
    auto summary = simulate_prepared(prepared, {}, {}).simulation.summary;
    if (arguments.requirement.probability && !summary.undeliverable)
        summary.samples = sample_flights(prepared, {}, *sampling_options(arguments.sampling, false));
    return reason_missed(arguments.requirement, summary).value_or("");
}

/// The command that gives the same, with names of files without their folders: the page goes to others.
std::string command_of(const cli::StageCall& call, const AnswerArguments& arguments) {
    constexpr std::size_t max_names = 6;
    std::string command = "flightwatt";
    for (std::size_t i = 0; i < std::min(call.inputs.size(), max_names); ++i)
        command += " " + std::filesystem::absolute(call.inputs[i]).lexically_normal().filename().string();
    if (call.inputs.size() > max_names) command += " ...";
    const auto add = [&](const char* option, const std::optional<double>& value) {
        if (value) command += fmt::format(" --{} {:g}", option, *value);
    };
    const auto& question = arguments.question;
    add("capacity", arguments.capacity_ah);
    if (call.has("reserve")) add("reserve", question.reserve_soc_percent);
    add("payload", question.payload_kg);
    add("mass", question.takeoff_mass_kg);
    add("airspeed", question.airspeed_m_per_s);
    if (arguments.wind) command += " --wind " + *arguments.wind;
    add("temperature", arguments.temperature_c);
    add("home-distance", arguments.home_distance_m);
    return valid_utf8(command);
}

/// Writes the page of an answer, with the report of its folder and mission; returns its name. `logs` is the call with
/// the logs.
std::string write_page(const cli::StageCall& logs, const AnswerArguments& arguments, const cli::AircraftAnswer& answer,
                       const mission::MissionVariant& mission) {
    const auto file = std::filesystem::path(answer.folder) / "answer.html";
    report::ReportInput input;
    input.out = answer.folder;
    // Of an unknown capacity no charge at landing would be true.
    if (answer.endurance.cruise_s) input.missions = {mission};
    input.are_longest = answer.endurance.cruise_s.has_value();
    input.answer = report::answer_json(answer, failsafe_texts(answer.failsafe, setup_of(mission)));
    input.command = command_of(logs, arguments);
    const report::ReportLog log{[&](const std::string& text) {
        cli::add_diagnostic(logs, {Severity::note, "the page", text});
    }};
    try {
        const auto front_end = report::read_front_end(report::web_folder());
        write_file_atomically(file, page_html(make_report(input, log).document, front_end));
        return file.string();
    } catch (const InputError& error) {
        cli::warn(logs, fmt::format("no page is written: {}; {}", error.what(), error.hint()));
        return "";
    }
}

/// Returns the fingerprint of the logs' names, the pack that is asked for, and the model and the pack in the folder.
std::string key_of(const cli::StageCall& call, const AnswerArguments& arguments, const std::filesystem::path& folder) {
    Fingerprint fingerprint;
    for (const auto& input : call.inputs) fingerprint.add(input + "\n");
    for (const auto& asked : {arguments.capacity_ah, arguments.temperature_c})
        fingerprint.add(asked ? fmt::format("{}\n", *asked) : "as flown\n");
    for (const auto* name : {batch::model_name, answer::pack_name}) fingerprint.add(read_file(folder / name));
    return fingerprint.hex();
}

/// Keeps what answer_again() needs.
void keep_answer(const cli::StageCall& call, const AnswerArguments& arguments, const answer::KnownAircraft& aircraft,
                 const cli::AircraftAnswer& answer) {
    const OverwriteExemption own_files;
    const std::filesystem::path folder = answer.folder;
    const KeptAnswer kept{key_of(call, arguments, folder),
                          answer.aircraft,
                          answer.name,
                          answer.logs,
                          answer.used,
                          mean_ground_speed_m_per_s(aircraft.flights),
                          wing_share(aircraft.flights),
                          answer.pack.capacity_ah,
                          answer.pack.resistance_ohm,
                          answer.pack.resistance_at_ohm,
                          answer.pack.known_down_to_percent};
    Json json;
    json["format"] = format_version;
    json.update(record_json(kept));
    write_file_atomically(folder / answer::kept_name, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

/// Answers as modelled, with the model and the pack that the last answer left in the folder; no log is read and no
/// flight is drawn. Throws InputError where that answer is of other logs or another pack.
cli::AircraftAnswer answer_again(const cli::StageCall& call, const AnswerArguments& arguments,
                                 const std::filesystem::path& folder) {
    const OverwriteExemption own_files;
    const std::string hint = "answer without --again first";
    const auto file = folder / answer::kept_name;
    if (!std::filesystem::exists(file)) throw InputError({file.string()}, "does not exist: nothing to repeat", hint);
    KeptAnswer kept;
    batch::read_batch_json(file, read_file(file), "not an answer of this version", hint,
                           [&](const Json& json) { read_record(json, kept); });
    if (kept.key != key_of(call, arguments, folder))
        throw InputError({file.string()}, "is of other logs, another capacity or temperature, or another model", hint);
    cli::AircraftAnswer answer;
    answer.aircraft = kept.aircraft;
    answer.name = kept.name;
    answer.folder = folder.string();
    answer.logs = kept.logs;
    answer.used = kept.used;
    answer.question = arguments.question;
    answer.question.draws_flights = false;
    answer.pack.capacity_ah = kept.capacity_ah;
    answer.pack.resistance_ohm = kept.resistance_ohm;
    answer.pack.resistance_at_ohm = kept.resistance_at_ohm;
    answer.pack.asked_temperature_c = arguments.temperature_c;
    answer.pack.known_down_to_percent = kept.voltage_known_down_to_percent;
    answer::KnownAircraft aircraft{mechanical::read_mechanical_model(folder / batch::model_name),
                                   folder / batch::model_name,
                                   folder / answer::pack_name,
                                   {},
                                   answer.pack};
    answer::FlightFacts flown;
    flown.cruise_s = 1.0;
    flown.ground_speed_m_per_s = kept.ground_speed_m_per_s;
    flown.wing_s = kept.wing_share;
    aircraft.flights = {flown};
    answer.endurance = answer_endurance(aircraft, answer.question);
    answer.failsafe_missing = "--again leaves it out";
    answer.prediction_error_percent = prediction_error(aircraft.model);
    write_file_atomically(folder / answer::mission_name,
                          mission_toml(aircraft, answer.question, answer.endurance.cruise_s));
    return answer;
}

/// The flights of one aircraft in a folder of their own, listed.
struct AircraftFlights {
    std::string aircraft;
    batch::BatchOptions options;
    batch::BatchFlights flights;
    cli::ListedFlights listed;
};

/// Answers for flights of one aircraft.
void answer_flights(const cli::StageCall& call, const AnswerArguments& arguments, const AircraftFlights& of,
                    cli::AircraftAnswer& answer) {
    const auto& folder = of.options.out;
    for (const auto& flight : of.flights)
        if (!flight.selection.flights.empty()) add_diagnostics(call, flight);
    if (totals_of(of.flights).accepted == 0)
        throw NoResultError(of.flights.size() == 1 ? reason_without_log(of.flights.front().record)
                                                   : fmt::format("none of {} logs can be used", of.flights.size()));
    const auto fitted = fit_folder(call, arguments.batch, of.flights, of.options, of.listed);
    if (!fitted) {
        remove_model(call, folder);
        throw NoResultError("no flight has measured power; a log of a battery monitor with a current sensor has it");
    }
    const auto& model = fitted->fit.model;
    answer.used = model.flights.size();
    const auto inner = folder_call(call, folder.string());
    const auto facts = cli::from_flights<answer::FlightFacts>(
        inner, arguments.batch.flights, [](const auto&, const auto& loaded) { return answer::flight_facts(loaded); });
    const auto pack = pack_of_folder(inner, arguments, facts, answer.packs);
    const answer::KnownAircraft aircraft{model, folder / batch::model_name, folder / answer::pack_name,
                                         fitted_facts(facts, arguments.batch.flights.load.keep), pack.answer};
    auto comment = pack.identified ? cli::provenance(*pack.identified) : std::string();
    if (const auto& cold = pack.answer.resistance_at_ohm; cold.value)
        comment += fmt::format("# resistance at {:g} degC: {}\n", *arguments.temperature_c, cold.basis);
    write_file_atomically(aircraft.battery_file, comment + to_toml(pack.battery));
    answer.pack = pack.answer;
    answer.endurance = answer_endurance(aircraft, arguments.question);
    answer.prediction_error_percent = prediction_error(model);
    const auto mission_file = folder / answer::mission_name;
    write_file_atomically(mission_file, mission_toml(aircraft, arguments.question, answer.endurance.cruise_s));
    keep_answer(call, arguments, aircraft, answer);
    if (!answer.endurance.power_w.value) {
        answer.failsafe_missing = answer.endurance.power_w.unknown;
        if (arguments.requirement.text) answer.requirement_missed = answer.failsafe_missing;
        return;
    }
    const auto mission = mission::read_mission(mission_file);
    add_failsafe(arguments, aircraft, setup_of(mission), answer);
    answer.requirement_missed = missed_requirement(arguments, aircraft, mission_file);
    if (!arguments.no_page) answer.page = write_page(call, arguments, answer, mission);
}

/// The same; an obstacle is the answer.
cli::AircraftAnswer answer_aircraft(const cli::StageCall& call, const AnswerArguments& arguments,
                                    const AircraftFlights& of) {
    cli::AircraftAnswer answer;
    answer.aircraft = of.aircraft;
    answer.folder = of.options.out.string();
    answer.logs = of.flights.size();
    answer.question = arguments.question;
    for (const auto& flight : of.flights)
        if (answer.name.empty()) answer.name = flight.record.aircraft_name;
    try {
        answer_flights(call, arguments, of, answer);
    } catch (const NoResultError& error) {
        answer.no_answer = error.what();
    } catch (const InputError& error) {
        answer.no_answer = error.hint().empty() ? error.what() : fmt::format("{}; {}", error.what(), error.hint());
    }
    if (arguments.requirement.text && !answer.no_answer.empty()) answer.requirement_missed = answer.no_answer;
    return answer;
}

/// The aircraft to answer for: the one that is named, each, or the one with the most flights.
std::vector<batch::AircraftGroup> chosen_groups(const cli::StageCall& call, const AnswerArguments& arguments,
                                                const cli::ChosenAircraft& flown,
                                                const std::optional<std::string>& named) {
    if (named) return {find_aircraft(*named, flown.groups, flown.flights)};
    auto groups = cli::certain_aircraft(call, flown.groups, flown.flights);
    if (arguments.batch.flights.each || groups.size() < 2) return groups;
    const auto most = std::ranges::max_element(groups, {}, [](const auto& group) { return group.flights.size(); });
    std::vector<std::string> others;
    for (const auto& group : groups)
        if (&group != &*most) others.push_back(group.selector);
    cli::warn(call, fmt::format("{} other aircraft: {}; --each answers for each, --aircraft NAME for one",
                                others.size(), fmt::join(others, ", ")));
    return {*most};
}

/// The arguments with those names of --exclude and --keep that are of these flights.
AnswerArguments with_names_of(const batch::BatchFlights& flights, AnswerArguments arguments) {
    const auto is_of_others = [&](const std::string& name) {
        return std::ranges::none_of(flights, [&](const auto& flight) { return flight.record.flight == name; });
    };
    std::erase_if(arguments.batch.flights.load.excluded, is_of_others);
    std::erase_if(arguments.batch.flights.load.keep, is_of_others);
    return arguments;
}

/// Answers for the chosen aircraft; where there are several, each has a folder of its own.
std::vector<cli::AircraftAnswer> answer_all(const cli::StageCall& call, AnswerArguments arguments,
                                            batch::BatchFlights flights, batch::BatchOptions options) {
    const auto named = std::exchange(arguments.batch.flights.load.aircraft, std::nullopt);
    options.load.aircraft.reset();
    auto listed = list_flights(call, flights, options);
    for (const auto& flight : flights)
        if (flight.selection.flights.empty()) add_diagnostics(call, flight);
    const auto& groups = listed.flown.groups;
    if (groups.size() < 2 || arguments.batch.flights.mix_aircraft) {
        if (named && !groups.empty()) find_aircraft(*named, groups, listed.flown.flights);
        const auto name = groups.empty() ? flights.front().record.flight : groups.front().selector;
        return {answer_aircraft(call, arguments, {name, options, std::move(flights), std::move(listed)})};
    }
    remove_model(call, options.out);
    std::vector<cli::AircraftAnswer> answers;
    for (const auto& group : chosen_groups(call, arguments, listed.flown, named)) {
        AircraftFlights of{group.selector, options, {}, {}};
        of.flights = separate_aircraft(group, listed.flown, of.options);
        of.listed = list_flights(call, of.flights, of.options);
        answers.push_back(answer_aircraft(call, with_names_of(of.flights, arguments), of));
    }
    return answers;
}

/// JSON of the stage.
struct AnswerOutput {
    std::vector<cli::AircraftAnswer> aircraft;
};

Fields<AnswerOutput> record_fields(const AnswerOutput*) {
    return {field("aircraft", &AnswerOutput::aircraft, "answers for each aircraft")};
}

void print_output(const cli::StageCall& call, const AnswerOutput& output) {
    if (call.json) {
        cli::print_json(call, output);
        return;
    }
    std::string text;
    for (const auto& one : output.aircraft)
        text += (text.empty() ? "" : "\n") + answer_text(one, cli::terminal_columns(stdout));
    cli::print(text);
}

int answer_logs(const cli::StageCall& call, const AnswerArguments& arguments) {
    const auto out = call.output.value_or(answer::default_folder);
    cli::refuse_folder_of_logs(call, out);
    const auto options = cli::batch_options(arguments.batch, out);
    const cli::BatchFolder folder(options.out);
    if (arguments.again) {
        print_output(call, {{answer_again(call, arguments, options.out)}});
        return cli::ok;
    }
    cli::ProgressBar bar("logs");
    auto flights = read_logs(call, arguments.batch, options,
                             [&](std::size_t done, std::size_t all, const auto&) { bar.show(done, all); });
    bar.hide();
    const auto totals = totals_of(flights);
    const AnswerOutput output{answer_all(call, arguments, std::move(flights), options)};
    if (arguments.table) write_file_atomically(*arguments.table, csv_of<cli::AircraftAnswer>(output.aircraft));
    print_output(call, output);
    const bool is_answered =
        std::ranges::any_of(output.aircraft, [](const auto& one) { return one.no_answer.empty(); });
    if (!is_answered && totals.accepted > 0) return cli::no_answer;
    auto code = totals.rejected_of_this_run > 0 ? cli::input_rejected : cli::ok;
    for (const auto& one : output.aircraft)
        if (!one.requirement_missed.empty())
            code = cli::report_missed(call, fmt::format("{}: {}", one.aircraft, one.requirement_missed));
    return code;
}

}  // namespace

int flightwatt::stages::answer_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "answer", "LOG|FOLDER... [--capacity AH]",
        R"(Answers from logs, in one command: how long and how far the aircraft flies on a full pack, in what power,
the state of its pack, how well new flights are predicted, and a page with all of it. Each answer states what it rests
on; where something is unknown, it states which flight would show it. `flightwatt LOG...` is the same.

Logs are ArduPilot's (.bin, .log), PX4's (.ulg), MAVLink (.tlog), Paparazzi's (.data with its .log) and CSV. Results are in the
folder of --output (flightwatt-out), and logs that have not changed are not read again. Of several aircraft it answers for the
one with the most flights; --each answers for each of them. --require tests a flight as long as those of the logs, with
the payload, wind and airspeed that are asked for.)"};
    stage.examples = {"flightwatt flight.bin --capacity 5.2", "flightwatt logs --payload 0.5 --wind 6",
                      "flightwatt logs --each --table fleet.csv"};
    stage.json_schema = cli::document_schema<AnswerOutput>;
    stage.uses_threads = true;
    stage.output_value = "DIR";
    stage.output_help = "the folder of the results; default: flightwatt-out";
    AnswerArguments arguments;
    arguments.batch.prune = true;
    arguments.batch.note_changes = false;
    auto& options = stage.options;
    auto& question = arguments.question;
    cli::add_capacity_option(
        options, arguments.capacity_ah,
        "the value on the pack's label; default: that of the logs' parameters, or else an estimate "
        "from the flights");
    options.add("reserve", question.reserve_soc_percent, {.value = "PERCENT", .min = 0.0, .max = 99.0},
                "charge to land with");
    options.add("payload", question.payload_kg, {.value = "KG", .min = 0.0, .max = 1000.0},
                "payload beyond the aircraft's own mass; default: as flown");
    options.add("mass", question.takeoff_mass_kg, {.value = "KG", .min = 0.0, .max = 10000.0, .needs = {"payload"}},
                "mass of the aircraft as it flew, where the logs do not state it");
    options.add("airspeed", question.airspeed_m_per_s, {.value = "M_PER_S", .min = 0.0, .max = 100.0},
                "airspeed of the cruise; default: as flown");
    options.add(
        "wind", arguments.wind, {.value = "SPEED@DEG"},
        "steady wind in m/s, and the degrees that it comes from: distances are out and back along it and across it, "
        "the way home is against it, and a rotorcraft holds its place in it");
    options.add("temperature", arguments.temperature_c, {.value = "C", .min = -60.0, .max = 80.0},
                "of the pack at take-off, in degrees Celsius: what a cold pack changes; default: as flown");
    options.add("home-distance", arguments.home_distance_m,
                {.value = "M", .min = 0.0, .max = 1e6, .above_min = true, .unit = "m"},
                "the farthest place from which the failsafe is to return; default: the farthest of the flights");
    add_require_option(options, arguments.requirement, arguments.sampling);
    options.add("table", arguments.table, cli::output_file("FILE.csv"), "write one row an aircraft to FILE");
    options.add("no-page", arguments.no_page, "write no page");
    options.add(
        "again", arguments.again,
        "as modelled, with the model and the pack of the last answer in the folder of --output, which has to be "
        "of these logs, capacity and temperature: no log is read and no flight is drawn, and chances, failsafe, "
        "packs and page are left out",
        {.excludes = {"home-distance", "require", "table", "each", "packs-file", "pack", "since", "until",
                      "mix-aircraft", "aircraft", "sortie", "recording", "exclude", "keep", "messages", "simulated"}});
    cli::add_each_option(options, arguments.batch.flights, "answers for each aircraft, in a folder of its own");
    cli::add_pack_options(options, arguments.packs);
    cli::add_filter_options(options, arguments.batch.filter);
    cli::add_flight_options(options, arguments.batch.flights);
    return cli::run_stage(argc, argv, stage, [&](const auto& call) {
        if (arguments.wind) {
            const auto wind = cli::parse_wind(*arguments.wind, false);
            question.wind_m_per_s = wind.speed_m_per_s;
            if (arguments.wind->find('@') != std::string::npos) question.wind_from_deg = wind.from_deg;
        }
        return answer_logs(call, arguments);
    });
}
