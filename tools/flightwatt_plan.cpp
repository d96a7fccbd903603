// A mission to the schedule of most utility that lands with the reserve; and what is feasible at most.

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/output/mission_output.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "mission/feasibility_limits.h"
#include "mission/mission_file.h"
#include "mission/mission_read_options.h"
#include "mission/plan.h"
#include "mission/planned_mission_toml.h"
#include "path/plan_writer.h"
#include "stages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

/// JSON of --longest-cruise and --spare-power.
struct PlanLimit {
    const mission::MissionSetup* mission = nullptr;
    std::string key;
    const mission::FeasibilityLimit* limit = nullptr;
    std::optional<double> probability;
};

Fields<PlanLimit> record_fields(const PlanLimit*) {
    using R = PlanLimit;
    using L = mission::FeasibilityLimit;
    const auto result = [](const std::string& key, const char* description) {
        const auto value = [key](const R& r) { return r.key == key ? std::optional(r.limit->value) : std::nullopt; };
        return field(key, value, description, optional_key{});
    };
    const auto margin = [](const R& r) {
        return r.probability ? std::optional(r.limit->margin_percent) : std::nullopt;
    };
    return list_fields<R>(
        field("mission", at(&R::mission, &mission::MissionSetup::name), "name of the mission"),
        result("longest_cruise_s", "longest feasible cruise"),
        result("most_circles", "with a path with circles: their largest number"),
        result("farthest_return_m", "with another path: distance along its legs, out and back"),
        result("path_times", "with an area: how often its lines are flown"),
        result("largest_payload_w", "largest constant power of a payload"),
        field("final_soc_percent", at(&R::limit, &L::final_soc_percent), "at the end"),
        field("reserve_soc_percent", at(&R::mission, &mission::MissionSetup::reserve_soc_percent), "reserve"),
        field("probability", &R::probability, "probability to keep the reserve", optional_key{}),
        field("margin_percent", margin, "above the reserve, for the probability", optional_key{}),
        embedded_if_any([](const R& r) { return r.limit->sources ? &*r.limit->sources : nullptr; }),
        field("residual_percent", at(&R::limit, &L::residual_percent), "above reserve and margin"),
        field("limited_by", at(&R::limit, &L::limited_by), "limiting factor"));
}

/// A mission file and its text: it may be read several times, and is written again with its schedule.
struct MissionFile {
    std::filesystem::path path;
    std::string text;
    mission::MissionLoader load = mission::mission_loader(text, path);

    mission::MissionVariant read(mission::MissionReadOptions reading = {}) const {
        reading.allow_unplanned = true;
        return load(reading);
    }
    mission::MissionVariant read_with_cruise(double cruise_s) const { return read({.cruise_s = cruise_s}); }
};

struct PlanArguments {
    std::optional<double> probability;
    bool longest_cruise = false;
    bool spare_power = false;
    bool packs = false;
    std::optional<path::PlanFormat> format;  ///< of the files of packs
};

std::string describe(const mission::MissionPlan& plan, const mission::MissionSetup& mission) {
    const double utility = *plan.summary.utility;
    const double gap = plan.plan.utility_bound > 0.0
                           ? units::percentage(plan.plan.utility_bound - utility, plan.plan.utility_bound)
                           : 0.0;
    const auto gap_text = gap < 1e-3 ? "below 0.001" : fmt::format("{:.3f}", gap);
    const auto bound = !plan.plan.bound_is_proven ? "no bound is known, as the battery is charged in flight"
                       : plan.sources
                           ? fmt::format("at most {:.6g} is possible without a margin", plan.plan.utility_bound)
                           : fmt::format("at most {:.6g} is possible (gap {} %)", plan.plan.utility_bound, gap_text);
    auto text = fmt::format("{}: utility {:.6g}, {}; lands with {:.2f} % of its charge, reserve {:.2f} %", mission.name,
                            utility, bound, *plan.summary.final_soc_percent, mission.reserve_soc_percent);
    if (plan.sources) text += fmt::format(" and {:.2f} points of margin", plan.margin_percent);
    if (plan.summary.lines)
        text += fmt::format("; {}, {:.3g} times seen", mission::describe(*plan.summary.lines), *plan.summary.coverage);
    if (plan.summary.by_flights) text += fmt::format(" ({})", describe(*plan.summary.by_flights));
    return text;
}

/// Notes the uncertainty that the requested probability covers.
void note_sources(const cli::StageCall& call, const PlanArguments& arguments, const mission::MissionSetup& mission,
                  const mission::UncertaintySources& sources, double standard_error = 0.0) {
    constexpr double min_shown_error = 5e-4;
    const auto exactness =
        standard_error < min_shown_error ? "" : fmt::format(" (computed to +- {:.4f})", standard_error);
    cli::note(call, fmt::format("{}: probability {}{} over flights as --samples draws them; {}", mission.name,
                                *arguments.probability, exactness,
                                call.notes ? describe(sources) : "--notes shows how flights differ"));
}

[[noreturn]] void refuse_infeasible(const cli::StageCall& call, const PlanArguments& arguments, const MissionFile& file,
                                    const mission::PlanningProblem& problem, const mission::MissionPlan& plan) {
    if (plan.summary.undeliverable) throw NoResultError(describe(plan.summary));
    const auto report = infeasibility_report(
        problem, plan, [&](double cruise_s) { return file.read_with_cruise(cruise_s); }, arguments.probability);
    if (call.json) {
        cli::print_json(call, cli::PlanOutput{&plan, &problem.setup, &report});
    }
    throw NoResultError(fmt::format("{}: {}", problem.setup.name, describe(problem.setup, report)));
}

/// The format of the files of packs: as asked, or that of the mission's plan, or a .plan.
path::PlanFormat format_of_packs(const PlanArguments& arguments, const path::PlannedPath& plan) {
    if (arguments.format) return *arguments.format;
    const std::filesystem::path source = drawn_path(plan).elements.front().where.file;
    if (source.extension() == ".toml" || source.extension() == ".kml") return path::PlanFormat::qgroundcontrol;
    const auto format = path::plan_format(read_file(source));
    return format == path::PlanFormat::none ? path::PlanFormat::qgroundcontrol : format;
}

/// Writes for each pack the plan of its flight, the mission that flies it, and its results with the schedule.
void write_packs(const cli::StageCall& call, const PlanArguments& arguments, const MissionFile& file,
                 const mission::PackFlights& all) {
    const std::filesystem::path folder = *call.output;
    std::map<std::filesystem::path, std::string> files;
    std::set<std::string> notes;
    const auto format = format_of_packs(arguments, *all.setup.cruise_path->plan);
    for (const auto& flight : all.flights) {
        const auto& setup = setup_of(flight.mission);
        const auto& plan = *setup.cruise_path->plan;
        const auto name = fmt::format("pack-{}", flight.pack);
        const auto plan_name = name + path::plan_ending(format);
        auto written = write_plan({setup.name, drawn_path(plan), *plan.origin, setup.mechanical->is_rotorcraft,
                                   plan.turns.value_or(path::TurnLimits{}), plan.wind, plan.rates, plan.is_of_vtol},
                                  format);
        notes.insert(written.notes.begin(), written.notes.end());
        files[folder / plan_name] = std::move(written.text);
        mission::PlannedPack pack{flight.pack, setup.name, plan_name, {}};
        const auto& elements = drawn_path(plan).elements;
        if (format != path::PlanFormat::qgroundcontrol) pack.airspeed_m_per_s = elements.front().airspeed_m_per_s;
        if (format == path::PlanFormat::flight_plan) {
            pack.blocks = {path::written_block};
            const auto [least, most] = std::ranges::minmax(elements, {}, &path::PathElement::airspeed_m_per_s);
            if (least.airspeed_m_per_s < most.airspeed_m_per_s)
                notes.insert(
                    fmt::format("flight plans have no airspeeds: {}.toml flies at {:g} m/s all along, not at {:g} to "
                                "{:g} m/s as planned: take its energy from {}.json",
                                name, *pack.airspeed_m_per_s, least.airspeed_m_per_s, most.airspeed_m_per_s, name));
        }
        files[folder / (name + ".toml")] =
            fmt::format("# {}\n", one_line(describe(flight.flown.simulation.summary))) +
            planned_mission_toml(file.text, file.path, setup.compute, flight.flown.schedule, folder, {}, pack).text;
        files[folder / (name + ".json")] = cli::json_text(cli::json_document(call, record_json(flight)));
    }
    make_directories(folder);
    write_files_atomically(files);
    for (const auto& text : notes) cli::note(call, fmt::format("{}: {}", all.setup.name, text));
}

int plan_packs(const cli::StageCall& call, const PlanArguments& arguments, const MissionFile& file,
               const mission::MissionVariant& mission) {
    const auto& setup = setup_of(mission);
    if (arguments.packs && (!setup.cruise_path || !setup.cruise_path->plan->origin))
        throw InputError({setup.file},
                         setup.cruise_path ? "the path is in metres, and no plan: where it is on the earth is unknown"
                                           : "the mission has no [path]: there is no plan of its flights",
                         "give latitude_deg and longitude_deg, in start of [path] or of its legs; without --packs the "
                         "flights are printed");
    cli::warn_of_setup(call, setup);
    const auto all = fly_packs(mission, {}, arguments.probability);
    if (arguments.packs && all.suffice) write_packs(call, arguments, file, all);
    auto printed = call;
    if (arguments.packs) printed.output.reset();
    print_packs(printed, all, csv_of(all.flights), {all.setup.name, {"mission", "cruise_to_s", "final_soc_percent"}});
    return cli::ok;
}

int make_plan(const cli::StageCall& call, const PlanArguments& arguments, const MissionFile& file) {
    const auto mission = file.read({.counts_written_heights = arguments.packs});
    if (setup_of(mission).packs) return plan_packs(call, arguments, file, mission);
    if (arguments.packs)
        throw InputError({setup_of(mission).file}, "the mission has no [packs]",
                         "add [packs] with count, change_s and home");
    const auto* problem = std::get_if<mission::PlanningProblem>(&mission);
    if (problem == nullptr) {
        if (setup_of(mission).compute.components.empty())
            throw InputError({setup_of(mission).file}, "the mission has no software whose schedule could be planned",
                             "--longest-cruise gives the longest flight");
        throw InputError({setup_of(mission).file}, "the mission has a schedule already: there is nothing to plan",
                         "add [plan]: entries of [[schedule]] are then fixed, and the other slots planned");
    }
    if (!problem->survey) cli::warn_of_setup(call, problem->setup);
    auto plan = plan_mission(*problem, arguments.probability);
    const auto& setup = plan.mission.setup;
    if (problem->survey) cli::warn_of_setup(call, setup);  // of the lines that were chosen
    plan.summary.by_flights = landing_by_flights(setup, plan.mission.schedule);
    if (!plan.plan.feasible) {
        const auto& stated = *problem;
        refuse_infeasible(call, arguments, file,
                          stated.survey ? stated.survey->mission_with(*layout_of(setup)) : stated, plan);
    }
    const auto text = describe(plan, setup);
    // The files that the result names are found from where it will stand.
    const auto folder = std::filesystem::absolute(call.output.value_or("result")).parent_path();
    const auto planned =
        planned_mission_toml(file.text, file.path, setup.compute, plan.mission.schedule, folder, layout_of(setup));
    cli::write_result(call, fmt::format("# {}\n", one_line(text)) + planned.text);
    cli::warn_of_lost_comments(call, planned);
    if (call.json) {
        cli::print_json(call, cli::PlanOutput{&plan, &setup});
    } else {
        cli::note(call, text);
        cli::note_power_model(call, setup);
        if (plan.sources) note_sources(call, arguments, setup, *plan.sources, plan.probability_standard_error);
    }
    return cli::ok;
}

/// Failure of the battery beyond a limit; empty if charge or the path is the limit.
std::string_view beyond(mission::LimitingFactor bound) {
    constexpr std::array<std::string_view, 4> texts{"", "; beyond, the battery cannot deliver the power",
                                                    "; beyond, the battery is cut off", ""};
    return texts.at(static_cast<std::size_t>(bound));
}

int print_limit(const cli::StageCall& call, const PlanArguments& arguments, const mission::MissionSetup& mission,
                const std::string& question, const std::string& unit, const mission::FeasibilityLimit& most) {
    cli::warn_of_setup(call, mission);
    const bool in_minutes = unit == "s" && !call.output && screen_of(call).is_terminal;
    const double feasible = std::floor(most.value * 1e6) / 1e6;  // must land as printed
    const auto value = fmt::format("{:.6f} {}\n", feasible, unit);
    cli::write_result(call, in_minutes ? duration_text(most.value) + "\n" : value);
    if (call.json) {
        cli::print_json(call, PlanLimit{&mission, question, &most, arguments.probability});
    } else {
        const auto kept = arguments.probability ? fmt::format("reserve {:.2f} % and {:.2f} points of margin",
                                                              mission.reserve_soc_percent, most.margin_percent)
                                                : fmt::format("reserve {:.2f} %", mission.reserve_soc_percent);
        cli::note(call, fmt::format("{}: it then lands with {:.2f} % of its charge, {}{}", mission.name,
                                    most.final_soc_percent, kept, beyond(most.limited_by)));
        cli::note_power_model(call, mission);
        if (most.sources) note_sources(call, arguments, mission, *most.sources);
    }
    return cli::ok;
}

/// --longest-cruise.
int print_reach(const cli::StageCall& call, const PlanArguments& arguments, const MissionFile& file) {
    const auto load = [&](const mission::MissionReadOptions& reading) { return file.read(reading); };
    const auto reach = mission::find_reach(load, arguments.probability);
    const auto mission = file.read();
    const auto& setup = setup_of(mission);
    constexpr std::array<std::pair<const char*, const char*>, 4> questions{
        {{"longest_cruise_s", "s"}, {"most_circles", "circles"}, {"farthest_return_m", "m"}, {"path_times", "times"}}};
    const auto& [question, unit] = questions.at(static_cast<std::size_t>(reach.unit));
    const int code = print_limit(call, arguments, setup, question, unit, reach.limit);
    if (call.json) return code;
    const auto note = [&](std::string_view text) { cli::note(call, fmt::format("{}: {}", setup.name, text)); };
    if (reach.unit == mission::ReachUnit::path_times) note(describe_path_times(setup, reach.limit.value));
    if (reach.unit != mission::ReachUnit::return_m) return code;
    if (reach.limit.value >= length_of_legs_m(drawn_path(*setup.cruise_path->plan)))
        note("the whole path and the way back fit: that is the path's length, and no limit");
    try {
        const auto times = mission::find_reach(load, arguments.probability, mission::ReachUnit::path_times);
        note("without turning back " + describe_path_times(setup, times.limit.value));
    } catch (const NoResultError& error) {
        note(error.what());
    }
    return code;
}

int plan_file(const cli::StageCall& call, const PlanArguments& arguments) {
    const MissionFile file{call.inputs.front(), read_file(call.inputs.front())};
    if (arguments.longest_cruise || arguments.spare_power) require_single_flight(setup_of(file.read()));
    if (arguments.longest_cruise) return print_reach(call, arguments, file);
    if (arguments.spare_power) {
        const auto mission = file.read();
        return print_limit(call, arguments, setup_of(mission), "largest_payload_w", "W",
                           largest_payload(mission, arguments.probability));
    }
    return make_plan(call, arguments, file);
}

}  // namespace

int flightwatt::stages::plan_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "plan", "MISSION.toml",
        R"(Computes the schedule of maximum utility that lands with the reserve, with a proven bound on the utility
of any other. The result is the mission with that schedule, for simulate and compare. Entries of
[[schedule]] next to [plan] are fixed. --longest-cruise and --spare-power take the mission's own schedule, or the
one that demands least energy. On a battery whose voltage falls with its charge (model = "thevenin"), or with a
cut-off voltage, the battery is simulated for each candidate schedule. A mission with [packs] is divided into flights,
and the result is a table of them (CSV); their schedules are in --json. With --packs -o FOLDER each flight has its own
files there: pack-1.plan for the ground station, pack-1.toml (the mission that flies it, with its schedule, for
simulate) and pack-1.json (its results and its schedule).)"};
    stage.max_inputs = 1;
    stage.next = [](const auto& call) {
        const bool is_table = std::filesystem::path(*call.output).extension() == ".csv";  // of a mission with [packs]
        if (call.has("packs")) return "flightwatt simulate {}/pack-1.toml";
        return is_table || call.has("longest-cruise") || call.has("spare-power") ? "" : "flightwatt simulate {}";
    };
    stage.json_schema = cli::document_schema<cli::PlanOutput, PlanLimit, mission::PackFlights>;
    stage.examples = {"flightwatt plan mission.toml -o planned.toml",
                      "flightwatt plan mission.toml --longest-cruise --probability 0.95",
                      "flightwatt plan mission.toml --packs --probability 0.95 -o flights"};
    stage.uses_threads = true;
    PlanArguments arguments;
    auto& options = stage.options;
    options.add("probability", arguments.probability,
                {.value = "P", .min = 0.5, .max = 1.0, .below_max = true, .hint = "95 % is 0.95"},
                "keep the reserve with this probability, 0.5 or more, as flights differ; default: as modelled");
    options.add(
        "longest-cruise", arguments.longest_cruise,
        "instead: the longest cruise that lands with the reserve [s]; of a [path] the maximum number of circles, "
        "without any the maximum distance from where the mission returns [m], and over an area how often it is flown",
        {.excludes = {"spare-power"}});
    options.add("spare-power", arguments.spare_power,
                "instead: the largest constant power that may be drawn in addition, as by a camera [W]",
                {.old_name = "largest-payload"});
    options.add("packs", arguments.packs, "write the files of each flight of a mission with [packs] to the folder -o",
                {.needs = {"output"}, .excludes = {"longest-cruise", "spare-power"}});
    options.add_choice<std::optional<path::PlanFormat>>(
        "format", arguments.format,
        {{"plan", path::PlanFormat::qgroundcontrol},
         {"waypoints", path::PlanFormat::ardupilot},
         {"blocks", path::PlanFormat::flight_plan}},
        {.needs = {"packs"}},
        "of these: .plan of QGroundControl, .waypoints of ArduPilot, or a flight plan of Paparazzi with a block; "
        "default: that of the mission's plan, else plan");
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return plan_file(call, arguments); });
}
