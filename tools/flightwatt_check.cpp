// A flight plan: whether it fits the battery, the charge leg by leg, and what would help.

#include "answer/answer.h"
#include "answer/plan_check.h"
#include "base/csv.h"
#include "base/number.h"
#include "base/text.h"
#include "base/units.h"
#include "batch/manifest.h"
#include "battery/battery_toml.h"
#include "cli/output/answer_output.h"
#include "cli/output/mission_output.h"
#include "cli/output/stage_options.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "cli/terminal.h"
#include "stages.h"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::answer {

Fields<PlanLeg> record_fields(const PlanLeg*) {
    using R = PlanLeg;
    return {field("leg", &R::name, "leg, circles or hold of the plan", csv_column{}),
            field("start_s", &R::start_s, "since lift-off", csv_column{}),
            field("duration_s", &R::duration_s, "with its turns", csv_column{}),
            field("length_m", &R::length_m, "over ground", csv_column{}),
            field("energy_wh", &R::energy_wh, "mechanical energy", csv_column{}),
            field("soc_percent", &R::soc_percent, "at its end", csv_column{})};
}

Fields<PlanRemedy> record_fields(const PlanRemedy*) {
    using R = PlanRemedy;
    return {field("kind", &R::kind, "airspeed, heading, spacing, part (of the path), pack or payload"),
            field("value", &R::value, "m/s, degrees, m, part, Ah or kg"),
            field("text", &R::text, "the change"),
            field("final_soc_percent", &R::final_soc_percent, "at landing; null: it does not land"),
            field("probability", &R::probability, "of keeping the reserve; null: unknown"),
            field("suffices", &R::suffices, "alone")};
}

Fields<PlanCheck> record_fields(const PlanCheck*) {
    using R = PlanCheck;
    return {
        field("plan", &R::plan, "its file"),
        field("fits", &R::fit, "yes, perhaps or no"),
        field("reason", &R::reason, "why it cannot be flown, or is uncertain; empty otherwise"),
        field("probability", &R::probability, "of keeping the reserve; null: unknown"),
        field("probability_interval_95", &R::probability_95, "in new flights; null: unknown"),
        field("probability_required", &R::probability_required, "by --probability"),
        field("length_m", &R::length_m, "over ground; null, as all of flown: unknown"),
        field("fails_at", &R::fails_at, "where the charge falls below the reserve, or the battery fails; null: not"),
        field("fails_at_s", &R::fails_at_s, "since lift-off"),
        field("flown", &R::flown, "the flight as modelled"),
        field("legs", &R::legs, "in the order of the flight"),
        field("remedies", &R::remedies, "what would help; empty where it fits"),
        field("chosen", &R::chosen, "what the plan leaves open"),
        field("notes", &R::notes, "limits of the answer")};
}

}  // namespace flightwatt::answer

namespace {

using namespace flightwatt;
using answer::PlanCheck;
using answer::PlanFit;

/// JSON of the stage.
struct CheckOutput {
    std::vector<PlanCheck> plans;
};

Fields<CheckOutput> record_fields(const CheckOutput*) {
    return {field("plans", &CheckOutput::plans, "the answer for each plan")};
}

struct CheckArguments {
    std::optional<std::string> model;
    std::optional<std::string> battery;
    std::optional<std::string> from;
    std::optional<std::string> wind;
    std::optional<std::string> home;
    answer::PlanQuestion question;
};

/// "43.4622,1.2729".
path::GeodeticPosition parse_home(const std::string& text) {
    const auto comma = text.find(',');
    const auto latitude = parse_number(std::string_view(text).substr(0, comma));
    const auto longitude =
        comma == std::string::npos ? std::nullopt : parse_number(std::string_view(text).substr(comma + 1));
    constexpr double max_latitude = 90.0, max_longitude = 180.0;
    if (!latitude || !longitude || std::abs(*latitude) > max_latitude || std::abs(*longitude) > max_longitude)
        throw UsageError(fmt::format("--home {}: expected LAT,LON in degrees, as 43.4622,1.2729", one_line(text)));
    return {*latitude, *longitude};
}

/// Model and pack as the options name them, or of the folder of an answer.
void read_aircraft(const cli::StageCall& call, const CheckArguments& arguments, mission::NewMission& aircraft) {
    aircraft.mechanical = arguments.model.value_or("");
    aircraft.battery = arguments.battery.value_or("");
    if (!arguments.model || !arguments.battery) {
        const std::filesystem::path folder = arguments.from.value_or(answer::default_folder);
        std::error_code none;
        for (auto [file, name] :
             {std::pair{&aircraft.mechanical, batch::model_name}, {&aircraft.battery, answer::pack_name}}) {
            if (!file->empty()) continue;
            *file = (folder / name).string();
            if (!std::filesystem::exists(*file, none))
                throw UsageError(
                    fmt::format("there is no {}: give --model MODEL.toml and --battery PACK.toml, or --from "
                                "FOLDER, the folder of `flightwatt LOG...`",
                                *file));
        }
        if (!arguments.from) cli::note(call, fmt::format("with {} and {}", aircraft.mechanical, aircraft.battery));
    }
    aircraft.model = mechanical::read_mechanical_model(aircraft.mechanical);
    aircraft.pack = battery::read_battery(aircraft.battery);
}

std::string percent_text(double part) { return fmt::format("{:.1f}", units::percentage(part, 1.0)); }

std::string answer_line(const PlanCheck& check) {
    const auto start = fmt::format("{}: {}", check.plan, to_string(check.fit));
    if (!check.flown) return fmt::format("{}: {}", start, check.reason);
    const auto reserve = fmt::format("{:g} %", check.flown->reserve_soc_percent);
    if (!check.probability)
        return fmt::format("{}, {} the reserve of {} as modelled; {}", start,
                           check.flown->keeps_reserve ? "keeps" : "misses", reserve, check.reason);
    return fmt::format("{}, keeps the reserve of {} in {} of 100 flights (of new flights {} to {}; {:g} required){}",
                       start, reserve, percent_text(*check.probability), percent_text(check.probability_95->low),
                       percent_text(check.probability_95->high), units::percentage(check.probability_required, 1.0),
                       check.reason.empty() ? "" : "; but " + check.reason);
}

std::string remedy_text(const answer::PlanRemedy& remedy) {
    auto text =
        remedy.text + (remedy.final_soc_percent ? fmt::format(": lands with {:.1f} %", *remedy.final_soc_percent)
                                                : std::string(": does not land"));
    if (remedy.probability) text += fmt::format(", in {} of 100 flights", percent_text(*remedy.probability));
    return text + (remedy.suffices ? "; enough" : "; not enough alone");
}

constexpr std::size_t shown_legs = 24;

std::string check_text(const cli::StageCall& call, const PlanCheck& check) {
    const auto columns = cli::terminal_columns(stdout);
    auto text = cli::wrapped(answer_line(check), columns) + "\n";
    std::vector<cli::AnswerLine> lines;
    const auto& flown = check.flown;
    if (flown)
        lines.push_back({"Flight",
                         fmt::format("{}, {:.2f} km, {:.3g} Wh; {}", duration_text(std::round(flown->duration_s)),
                                     *check.length_m / units::metre_per_kilometre, flown->energy_wh,
                                     flown->feasible ? fmt::format("lands with {:.1f} %", *flown->final_soc_percent)
                                                     : std::string("the battery does not last")),
                         ""});
    if (check.fails_at)
        lines.push_back(
            {"Fails",
             fmt::format("at {}, {} after lift-off", *check.fails_at, duration_text(std::round(*check.fails_at_s))),
             ""});
    for (const auto& remedy : check.remedies)
        lines.push_back({&remedy == &check.remedies.front() ? "Helps" : "", remedy_text(remedy), ""});
    const bool is_missed = check.probability < check.probability_required || !flown || !flown->keeps_reserve;
    if (is_missed && check.remedies.empty() && check.probability)
        lines.push_back({"Helps", "nothing that was tried: another airspeed, a part of the path, a larger pack", ""});
    if (!check.chosen.empty()) lines.push_back({"Chosen", fmt::format("{}", fmt::join(check.chosen, "; ")), ""});
    text += lines_text(lines, columns);
    if (check.legs.empty()) return text;
    return text + "\n" +
           screen_text(cli::readable_table(csv_of<answer::PlanLeg>(check.legs)), screen_of(call), {"", {}, shown_legs});
}

int check_plans(const cli::StageCall& call, const CheckArguments& arguments) {
    auto question = arguments.question;
    read_aircraft(call, arguments, question.aircraft);
    if (arguments.wind) question.aircraft.wind = cli::parse_wind(*arguments.wind, true);
    if (arguments.home) question.plan.home = parse_home(*arguments.home);
    question.plan.terrain_name = question.plan.terrain.value_or("");
    CheckOutput output;
    for (const auto& input : call.inputs) {
        question.plan.file = question.plan.name = input;
        question.aircraft.name = question.plan.file.stem().string();
        try {
            output.plans.push_back(check_plan(question));
        } catch (const InputError& error) {
            if (call.inputs.size() == 1) throw;
            skip_input(call, input, error);
            continue;
        }
        const auto& check = output.plans.back();
        for (const auto& note : check.notes) cli::add_diagnostic(call, {Severity::warning, input, note});
    }
    CsvWriter csv({"plan", "leg", "start_s", "duration_s", "length_m", "energy_wh", "soc_percent"});
    std::string text;
    bool all_fit = true;
    for (const auto& check : output.plans) {
        for (const auto& leg : check.legs)
            csv.add(check.plan, leg.name, leg.start_s, leg.duration_s, leg.length_m, leg.energy_wh, leg.soc_percent);
        text += (text.empty() ? "" : "\n") + check_text(call, check);
        all_fit = all_fit && check.fit == PlanFit::yes;
    }
    if (call.output) cli::write_result(call, csv.text());
    if (call.json)
        cli::print_json(call, output);
    else
        cli::print(text);
    return all_fit ? cli::ok : cli::requirement_missed;
}

}  // namespace

int flightwatt::stages::check_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "check", "PLAN... --model MODEL.toml --battery PACK.toml",
        R"(Answers whether an aircraft flies a plan on its pack: yes, perhaps or no, with the probability of keeping the
reserve, as drawn flights show it; how long, how far, with what energy; the charge leg by leg, with the way from home and
back; where it fails; and what would help, each simulated: another airspeed, other or fewer lines over an area, a part
of the path, a larger pack, less payload. With a movement of the plan that is not flown it is perhaps at most. Plans are
.plan, .waypoints, flight plans of Paparazzi (--block), KML, GeoJSON and CSV, as of new-mission --plan. Without --model
and --battery it takes those of an answer, in flightwatt-out.

Exit code 0: every plan fits; 5: one does not, or perhaps; 3: one cannot be read.)"};
    stage.examples = {"flightwatt check survey.plan --model model.toml --battery pack.toml --wind 6@250",
                      "flightwatt check *.waypoints --from flightwatt-out --payload 0.5 --reserve 25"};
    stage.json_schema = cli::document_schema<CheckOutput>;
    stage.uses_threads = true;
    stage.output_help = "write the legs of all plans to FILE (CSV)";
    CheckArguments arguments;
    auto& options = stage.options;
    auto& [aircraft, plan, probability, samples, seed] = arguments.question;
    options.add("model", arguments.model, cli::input_file("MODEL.toml"),
                "the aircraft's power, from flightwatt batch or fit");
    options.add("battery", arguments.battery, cli::input_file("PACK.toml"), "its pack, from flightwatt battery");
    options.add("from", arguments.from, cli::input_file("FOLDER"),
                "model and pack of an answer of `flightwatt LOG...`; default: flightwatt-out");
    options.add("wind", arguments.wind, {.value = "SPEED@DEG"}, "wind along the plan: 6@250 is 6 m/s from 250 degrees");
    options.add("home", arguments.home, {.value = "LAT,LON"},
                "where it takes off and lands; default: the plan's home, or its first place");
    cli::add_plan_options(options, plan, {});
    options.add("payload", aircraft.payload_kg, {.value = "KG", .min = 0.0, .max = 1000.0, .unit = "kg"},
                "what the aircraft carries beyond its own mass");
    options.add("mass", aircraft.takeoff_mass_kg,
                {.value = "KG", .min = 0.0, .above_min = true, .unit = "kg", .needs = {"payload"}},
                "mass of the aircraft as it flew, where its flights do not show the effect of payload");
    options.add("reserve", aircraft.reserve_soc_percent, {.value = "PERCENT", .min = 0.0, .max = 99.0},
                "charge to land with");
    options.add("probability", probability,
                {.value = "P", .min = 0.5, .max = 1.0, .below_max = true, .hint = "95 % is 0.95"},
                "of keeping the reserve, for a yes");
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return check_plans(call, arguments); });
}
