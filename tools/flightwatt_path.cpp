// The path of a mission as it is flown, leg by leg; the blocks of a plan; or the path that was flown in a log, as
// waypoints for a mission.

#include "base/csv.h"
#include "base/input_file.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/output/flight_options.h"
#include "cli/output/mission_output.h"
#include "cli/output/physical_output.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "flight/flown_path.h"
#include "mission/mission_file.h"
#include "mission/prepared_mission.h"
#include "path/cruise_path.h"
#include "path/path_entries.h"
#include "path/plan_blocks.h"
#include "path/plan_files.h"
#include "stages.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace flightwatt;

/// JSON of the blocks of a plan.
struct PlanFileOutput {
    std::string plan;
    std::vector<path::PlanBlock> blocks;
};

}  // namespace

namespace flightwatt::path {

Fields<PlanBlock> record_fields(const PlanBlock*) {
    using R = PlanBlock;
    return {field("block", &R::name, "name of the block; `mission` of a plan that has none"),
            field("line", &R::line, "of the file; 0: unknown"),
            field("flown", &R::flown, "number of legs, circles and holds; empty: nothing"),
            field("length_m", &R::length_m, "of legs and circles over ground"),
            field("not_flown", &R::not_flown, "what is not flown, and why")};
}

}  // namespace flightwatt::path

namespace {

Fields<PlanFileOutput> record_fields(const PlanFileOutput*) {
    using R = PlanFileOutput;
    return {field("plan", &R::plan, "its file"), field("blocks", &R::blocks, "in the order of the file")};
}

/// JSON of a mission's path.
struct PathOutput {
    std::string mission;
    double length_m = 0.0;
    double duration_s = 0.0;
    double mechanical_energy_wh = 0.0;
    double mechanical_w = 0.0;
    std::optional<path::PathSpeed> speed;
    std::optional<mission::FlownTrack> track;
};

Fields<PathOutput> record_fields(const PathOutput*) {
    using R = PathOutput;
    return {field("mission", &R::mission, "name of the mission"),
            field("length_m", &R::length_m, "of legs and circles over ground"),
            field("duration_s", &R::duration_s, "duration of the cruise"),
            field("mechanical_energy_wh", &R::mechanical_energy_wh, "energy of the cruise"),
            field("mechanical_w", &R::mechanical_w, "mean power of the cruise"),
            field("best_speed", at(&R::speed, &path::PathSpeed::best),
                  "one airspeed with the least energy; null: the model has no induced drag"),
            field("planned_energy_wh", at(&R::speed, &path::PathSpeed::planned_wh), "as planned, by the same model"),
            field("track", &R::track,
                  "as it is flown, with its turns and the charge along it; null: a mission with [packs], whose flights "
                  "have their own in plan and simulate")};
}

/// JSON of --path-from.
struct FlightPathOutput {
    std::string flight;
    std::size_t waypoints = 0;
    double duration_s = 0.0;
    std::optional<double> ground_altitude_m;
};

Fields<FlightPathOutput> record_fields(const FlightPathOutput*) {
    using R = FlightPathOutput;
    return {
        field("flight", &R::flight, "name of the flight"), field("waypoints", &R::waypoints, "number of the waypoints"),
        field("duration_s", &R::duration_s, "duration of the cruise"),
        field("ground_altitude_m", &R::ground_altitude_m,
              "the log's altitude of the ground, above which those of the waypoints are; null: unknown, they are as "
              "in the log")};
}

constexpr int digits = 10;

int list_plan(const cli::StageCall& call, std::string_view text, std::optional<double> radius_m) {
    const auto& file = call.inputs.front();
    const PlanFileOutput plan{file, path::parse_plan(text, file, {radius_m})};
    CsvWriter csv({"block", "line", "flown", "length_m", "not_flown"}, digits);
    std::size_t flown = 0;
    for (const auto& block : plan.blocks) {
        csv.add(block.name, block.line, block.flown, block.length_m,
                fmt::format("{}", fmt::join(block.not_flown, "; ")));
        if (!block.flown.empty()) ++flown;
    }
    write_csv_result(call, csv.text(), {file, {"block", "flown", "length_m", "not_flown"}});
    if (call.json) cli::print_json(call, plan);
    cli::note(call, fmt::format("{}: {} of {} blocks are flown by a mission that names them", file, flown,
                                plan.blocks.size()));
    return cli::ok;
}

/// The track with the charge; without it where the schedule cannot be planned.
std::optional<mission::FlownTrack> track_of(const mission::MissionVariant& mission) {
    const auto& setup = setup_of(mission);
    if (setup.packs) return std::nullopt;
    mission::Simulation simulation;
    try {
        simulation = simulate_prepared(prepare_mission(mission)).simulation;
    } catch (const InputError&) {  // it has no utilities, or charges its battery
    }
    return flown_track(setup, simulation);
}

int show_path(const cli::StageCall& call) {
    const auto mission = mission::read_mission(call.inputs.front(), {.allow_unplanned = true});
    const auto& setup = setup_of(mission);
    if (!setup.cruise_path) {
        throw InputError({call.inputs.front()}, "the mission has no [path]",
                         "add one (docs/missions.md, path); --path-from makes one from a log");
    }
    cli::warn_of_setup(call, setup);
    const auto& plan = *setup.cruise_path->plan;
    CsvWriter csv({"leg", "kind", "start_s", "duration_s", "length_m", "course_deg", "airspeed_m_per_s",
                   "climb_m_per_s", "load_factor", "mechanical_w", plan.origin ? "end_latitude_deg" : "end_east_m",
                   plan.origin ? "end_longitude_deg" : "end_north_m"},
                  digits);
    double length_m = 0.0;
    path::LocalPosition end;
    auto element = plan.path.elements.begin();
    for (const auto& leg : path_element_results(plan)) {
        end = end + path::local_position_at({{*element++}}, {1, 0.0});
        constexpr double scale = 1e4;
        const auto rounded = [](double metres) { return std::round(metres * scale) / scale + 0.0; };  // no -0
        auto place = std::pair(rounded(end.east_m), rounded(end.north_m));
        if (plan.origin) {
            const auto where = to_geodetic(plan.origin->start + end, plan.origin->place);
            place = {where.latitude_deg, where.longitude_deg};
        }
        csv.add(leg.name, leg.kind, leg.start_s, leg.duration_s, leg.length_m, leg.course_deg, leg.airspeed_m_per_s,
                leg.climb_m_per_s, leg.load_factor, leg.mechanical_w, place.first, place.second);
        length_m += leg.length_m.value_or(0.0);
    }
    write_csv_result(call, csv.text(), {setup.name, {"leg", "start_s", "duration_s", "length_m", "mechanical_w"}});
    const double duration_s = path::duration_s(*setup.cruise_path);
    const double energy_wh = units::wh_from_joule(energy_j(*setup.cruise_path));
    const double mean_w = mean_power_w(*setup.cruise_path);
    const auto speed = best_path_speed(plan);
    if (call.json) {
        cli::print_json(call,
                        PathOutput{setup.name, length_m, duration_s, energy_wh, mean_w, speed, track_of(mission)});
    } else {
        cli::note(call, fmt::format("{}: {:.2f} km over ground in {}; {:.3f} Wh, {:.2f} W on average", setup.name,
                                    length_m / 1000.0, duration_text(duration_s), energy_wh, mean_w));
        if (speed)
            cli::note(call, fmt::format("{}: {}; {:.4g} Wh as planned", speed->best.purpose,
                                        describe(speed->best, plan.power.airspeed_m_per_s), speed->planned_wh));
    }
    return cli::ok;
}

const flight::Sortie& only_sortie(const flight::LoadedFlight& flight, const std::string& file) {
    const auto& sorties = flight.phases.sorties;
    if (sorties.size() != 1)
        throw InputError({file}, fmt::format("has {} flights", sorties.size()), "choose one: --sortie N");
    return sorties.front();
}

/// The log's altitude of the ground, unless the log begins and ends in the air.
std::optional<double> ground_altitude_m(const flight::Sortie& sortie) {
    const auto is_from_ground = [](const flight::PhaseSpan& phase) {
        return phase.phase != flight::Phase::cruise && phase.complete;
    };
    return std::ranges::any_of(sortie.phases, is_from_ground) ? std::optional(sortie.ground_altitude_m) : std::nullopt;
}

int take_path(const cli::StageCall& call, flight::LoadOptions options, const std::string& file) {
    options.power_required = false;
    const auto loaded = cli::load_flight(call, file, options);
    if (!loaded.exclusion.empty()) throw InputError({file}, "is not used: " + loaded.exclusion);
    const auto& sortie = only_sortie(loaded, file);
    const auto cruise = std::ranges::find(sortie.phases, flight::Phase::cruise, &flight::PhaseSpan::phase);
    if (cruise == sortie.phases.end()) throw InputError({file}, "has no cruise");
    const auto path = flown_path(loaded.data, *cruise);
    const auto ground_m = ground_altitude_m(sortie);
    CsvWriter csv({path.is_geographic ? "latitude_deg" : "east_m", path.is_geographic ? "longitude_deg" : "north_m",
                   "altitude_m", "airspeed_m_per_s", "duration_s"},
                  digits);
    double duration_s = 0.0;
    for (const auto& place : path.waypoints) {
        const bool is_first = place.duration_s == 0.0;
        csv.add(place.east_m, place.north_m, place.altitude_m - ground_m.value_or(0.0),
                is_first || place.airspeed_m_per_s == 0.0 ? std::nullopt : std::optional(place.airspeed_m_per_s),
                is_first ? std::nullopt : std::optional(place.duration_s));
        duration_s += place.duration_s;
    }
    write_csv_result(call, csv.text(), {loaded.data.flight + ": where it flew", {}});
    if (call.json) {
        cli::print_json(call, FlightPathOutput{loaded.data.flight, path.waypoints.size(), duration_s, ground_m});
    } else {
        cli::note(call, fmt::format("{}: {} waypoints of a cruise of {}, each with how long the way there took: a "
                                    "mission that is to fly them in another wind leaves duration_s out",
                                    loaded.data.flight, path.waypoints.size(), duration_text(duration_s)));
    }
    if (!ground_m)
        cli::warn(call, fmt::format("{}: neither take-off nor landing is complete: its altitudes are as in the log, "
                                    "perhaps above the sea: ground_altitude_m in [path] states that of the ground",
                                    loaded.data.flight));
    else if (!call.json)
        cli::note(call, fmt::format("{}: its altitudes are above the ground, at {:.0f} m in the log: with them belongs "
                                    "ground_altitude_m = 0 in [path]",
                                    loaded.data.flight, *ground_m));
    return cli::ok;
}

struct PathArguments {
    std::optional<std::string> log;
    std::optional<double> radius_m;
    flight::LoadOptions load;
};

int show_or_take_path(const cli::StageCall& call, const PathArguments& arguments) {
    if (arguments.log.has_value() == !call.inputs.empty())
        throw UsageError("give a mission or a plan, or a log with --path-from");
    if (arguments.log) return take_path(call, arguments.load, *arguments.log);
    const auto text = read_file(call.inputs.front());
    if (path::plan_format(text) != path::PlanFormat::none) return list_plan(call, text, arguments.radius_m);
    if (arguments.radius_m) throw UsageError("--radius belongs to a plan: a mission has radius_m in [path]");
    return show_path(call);
}

}  // namespace

int flightwatt::stages::path_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "path", "[MISSION.toml|PLAN]",
        R"(Shows how the cruise of a mission with a [path] is flown, an element a row: leg, kind, start_s, duration_s,
length_m, course_deg, airspeed_m_per_s, climb_m_per_s, load_factor, mechanical_w, and where it ends:
end_latitude_deg and end_longitude_deg, or end_east_m and end_north_m from the start of a path in metres.
Of a plan (flight plan of Paparazzi, .plan of QGroundControl, .waypoints of ArduPilot) the blocks: what of each
a mission flies (flight_plan and blocks, or waypoints, in [path]), its length, and what is not flown.
With --path-from the path of a log's cruise instead, as waypoints for a mission (waypoints = "FILE" in
[path]): a place about every 30 s, and between them as many as keep lines within 3 m of the track, with the
airspeed on the way there, of rotorcraft the speed over ground, and how long it took. Altitudes are above the
ground, if the log shows where that is.)"};
    stage.next = [](const auto& call) {
        if (call.inputs.empty()) return "waypoints = \"{}\" in the [path] of a mission";
        if (!call.inputs.front().ends_with(".toml"))
            return "flightwatt new-mission --model MODEL.toml --battery PACK.toml --plan {in} -o mission.toml";
        const auto mission = mission::read_mission(call.inputs.front(), {.allow_unplanned = true});
        const auto* problem = std::get_if<mission::PlanningProblem>(&mission);
        const bool is_planned_first = problem != nullptr && !problem->adaptive && !problem->setup.packs;
        return is_planned_first ? "flightwatt plan {in} -o planned.toml" : "flightwatt simulate {in}";
    };
    stage.json_schema = cli::document_schema<PathOutput, PlanFileOutput, FlightPathOutput>;
    stage.min_inputs = 0;
    stage.max_inputs = 1;
    stage.examples = {"flightwatt path mission.toml", "flightwatt path flight_plan.xml --radius 80",
                      "flightwatt path --path-from flight.data -o waypoints.csv"};
    stage.shows_table = true;
    PathArguments arguments;
    stage.options.add("path-from", arguments.log, cli::input_file("LOG"),
                      "write the path that was flown in LOG as waypoints");
    stage.options.add("radius", arguments.radius_m,
                      {.value = "M", .min = path::min_radius_m, .max = path::max_radius_m, .excludes = {"path-from"}},
                      "of circles for which a plan states none [m]");
    cli::add_flight_options(stage.options, arguments.load, {"path-from"});
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return show_or_take_path(call, arguments); });
}
