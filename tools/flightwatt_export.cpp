// flightwatt export: flights, models and missions in the forms that other programs read.

#include "answer/failsafe.h"
#include "base/input_file.h"
#include "base/number.h"
#include "base/units.h"
#include "battery/battery_toml.h"
#include "cli/options.h"
#include "cli/output/answer_output.h"
#include "cli/output/battery_output.h"
#include "cli/output/flight_options.h"
#include "cli/output/mission_output.h"
#include "cli/output/stage_options.h"
#include "cli/stage.h"
#include "exchange/autopilot_parameters.h"
#include "exchange/failsafe_parameters.h"
#include "exchange/flown_track.h"
#include "exchange/message_table.h"
#include "exchange/model_text.h"
#include "exchange/monitor_parameters.h"
#include "exchange/px4_parameters.h"
#include "exchange/simulator_parameters.h"
#include "mission/mission_file.h"
#include "mission/prepared_mission.h"
#include "report/latex_tables.h"
#include "report/report.h"
#include "stages.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace flightwatt;

/// Kind of an input, by its content.
enum class ExportKind { flight, model, battery, mission, batch };

struct ExportInput {
    std::string file;
    ExportKind kind = ExportKind::flight;
};

struct ExportArguments {
    std::optional<std::string> format;
    std::optional<std::string> message;
    exchange::EstimatorInput estimator;
    answer::FailsafeRequest failsafe;
    std::optional<std::string> wind;
    std::optional<double> capacity_ah;
    bool with_replay = false;
    flight::LoadOptions load;
};

constexpr std::array kind_names{"log or series", "mechanical model", "battery", "mission", "folder"};

std::string name_of(ExportKind kind) { return kind_names.at(static_cast<std::size_t>(kind)); }

using WriteParameters = exchange::ParameterText (*)(const exchange::EstimatorInput&);
using WriteFailsafe = exchange::ParameterText (*)(const exchange::EstimatorInput&, const answer::FailsafeCard&);

struct Format {
    std::string name;
    std::string ending;  ///< of -o that means it; may be empty
    std::set<ExportKind> kinds;
    std::set<std::string> options;    ///< that it uses, of those that not all use
    WriteParameters write = nullptr;  ///< of parameters
    WriteFailsafe write_failsafe = nullptr;
    bool writes_parameters() const { return write != nullptr || write_failsafe != nullptr; }
};

const std::vector<Format>& formats() {
    using enum ExportKind;
    static const std::set<ExportKind> of_aircraft{model, battery, mission};
    static const std::set<std::string> of_tracks{
        "aircraft", "sortie", "recording", "exclude", "keep", "correct-idle-offset", "messages"};
    static const std::set<std::string> of_failsafes{"reserve", "home-distance", "home-course",
                                                    "wind",    "airspeed",      "probability"};
    static const std::set<std::string> of_inav{"cells", "reserve",  "home-distance", "home-course",
                                               "wind",  "airspeed", "probability"};
    static const std::vector<Format> all{
        {"geojson", ".geojson", {flight}, of_tracks},
        {"kml", ".kml", {flight}, of_tracks},
        {"gpx", ".gpx", {flight}, of_tracks},
        {"csv",
         ".csv",
         {flight},
         {"message", "aircraft", "sortie", "recording", "exclude", "keep", "correct-idle-offset", "messages"}},
        {"json", ".json", {model, battery}, {}},
        {"c", ".h", {model}, {}},
        {"px4", ".params", of_aircraft, {"cells"}, exchange::to_px4},
        {"inav", "", of_aircraft, {"cells", "idle-power"}, exchange::to_inav},
        {"paparazzi", "", of_aircraft, {"cells", "parallel"}, exchange::to_paparazzi},
        {"paparazzi-map", "", of_aircraft, {"cells", "parallel"}, exchange::to_paparazzi_map},
        {"ardupilot-sitl", ".parm", of_aircraft, {}, exchange::to_ardupilot_sitl},
        {"px4-sitl", "", of_aircraft, {"cells"}, exchange::to_px4_sitl},
        {"gazebo", ".sdf", of_aircraft, {}, exchange::to_gazebo},
        {"failsafe-ardupilot", "", of_aircraft, of_failsafes, nullptr, exchange::to_failsafe_ardupilot},
        {"failsafe-px4", "", of_aircraft, of_failsafes, nullptr, exchange::to_failsafe_px4},
        {"failsafe-inav", "", of_aircraft, of_inav, nullptr, exchange::to_failsafe_inav},
        {"failsafe-paparazzi", "", of_aircraft, of_failsafes, nullptr, exchange::to_failsafe_paparazzi},
        {"latex", ".tex", {model, battery, mission, batch}, {"replay", "capacity"}}};
    return all;
}

/// The names of those for which that holds.
template <typename Holds>
std::string names_of_formats(const Holds& holds) {
    std::vector<std::string> names;
    for (const auto& format : formats())
        if (holds(format)) names.push_back(format.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

ExportKind kind_of(const std::string& file) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) return ExportKind::batch;
    if (std::filesystem::path(file).extension() != ".toml") return ExportKind::flight;
    const auto kind = kind_of_text(read_file(file));
    if (kind == FileKind::mission) return ExportKind::mission;
    return kind == FileKind::battery ? ExportKind::battery : ExportKind::model;
}

const Format& format_of(const cli::StageCall& call, const std::optional<std::string>& name) {
    const auto ending = call.output ? std::filesystem::path(*call.output).extension().string() : "";
    for (const auto& format : formats())
        if (name ? format.name == *name : !ending.empty() && format.ending == ending) return format;
    const auto names = names_of_formats([](const Format&) { return true; });
    if (name) {
        const auto near = std::ranges::find_if(
            formats(), [&](const Format& format) { return std::string_view(format.name).ends_with("-" + *name); });
        throw UsageError(fmt::format("--format {}: expected one of {}{}", *name, names,
                                     near == formats().end() ? "" : fmt::format("; did you mean '{}'?", near->name)));
    }
    throw UsageError(
        fmt::format("expected -o FILE that ends in .geojson, .kml, .gpx, .csv, .json, .h, .params, .parm, .sdf or "
                    ".tex, or --format NAME, one of {}",
                    names));
}

void require_matching_lengths(const ExportInput& input, const Format& format) {
    if (format.kinds.contains(input.kind)) return;
    auto hint = fmt::format("a {} becomes {}", name_of(input.kind),
                            names_of_formats([&](const Format& other) { return other.kinds.contains(input.kind); }));
    if (input.kind == ExportKind::mission && format.name == "csv")
        hint = fmt::format("its state of charge over time is: flightwatt simulate {} -o FILE.csv",
                           cli::shell_quoted(input.file));
    if (input.kind == ExportKind::batch)
        hint = "one of flightwatt batch becomes latex, and its model is model.toml in it";
    throw InputError({input.file}, fmt::format("is a {}, of which no {} is made", name_of(input.kind), format.name),
                     hint);
}

/// Refuses options that the format does not use.
void refuse_idle_options(const cli::StageCall& call, const Format& format) {
    for (const auto& other : formats()) {
        for (const auto& option : other.options) {
            if (!call.has(option) || format.options.contains(option)) continue;
            const auto uses = [&](const Format& user) { return user.options.contains(option); };
            throw UsageError(
                fmt::format("--{} is of no use to {}: it is for {}", option, format.name, names_of_formats(uses)));
        }
    }
}

/// One input, but for tables of several missions with or without a batch, and parameters from a model and a battery.
void require_few(const std::vector<ExportInput>& inputs, const Format& format) {
    using enum ExportKind;
    const auto of_kind = [&](ExportKind kind) {
        return static_cast<std::size_t>(std::ranges::count(inputs, kind, &ExportInput::kind));
    };
    const bool is_latex = format.name == "latex";
    const bool is_of_both = format.writes_parameters() && format.kinds.contains(model);
    const bool are_tables = is_latex && of_kind(batch) <= 1 && of_kind(batch) + of_kind(mission) == inputs.size();
    const bool are_both = is_of_both && inputs.size() == 2 && of_kind(model) == 1 && of_kind(battery) == 1;
    if (inputs.size() == 1 || are_tables || are_both) return;
    throw UsageError(fmt::format("{} is made of one input{}", format.name,
                                 is_latex     ? ", or of missions and one folder of flightwatt batch"
                                 : is_of_both ? ": a mission, or a model and a battery"
                                              : ""));
}

/// The result, and its JSON.
struct Exported {
    std::string text;
    std::vector<std::string> notes = {};
    std::vector<std::string> inputs = {};
    std::string format = {};
    std::optional<answer::FailsafeCard> failsafe = {};
};

Fields<Exported> record_fields(const Exported*) {
    using R = Exported;
    return {field("inputs", &R::inputs, "files"), field("export_format", &R::format, "format, as of `--format`"),
            field("notes", &R::notes, "what is missing or assumed"),
            field("failsafe", &R::failsafe, "card of the formats failsafe-...", optional_key{})};
}

Exported export_track(const cli::StageCall& call, const ExportArguments& arguments, const std::string& file,
                      const std::string& format) {
    const auto loaded = cli::load_flight(call, file, arguments.load);
    const auto track = exchange::flown_track(loaded.data, loaded.phases);
    Exported result;
    result.text = format == "geojson" ? to_geojson(track) : format == "kml" ? to_kml(track) : to_gpx(track);
    if (track.clock == exchange::TrackClock::name)
        cli::warn(call, file +
                            ": no .log contains the date: that of its name, a local time, is used as UTC: times may be "
                            "wrong by hours");
    if (track.clock == exchange::TrackClock::none)
        result.notes.push_back(file + ": neither a .log nor its name contains the date: points have no time");
    if (!track.points.front().altitude_m) result.notes.push_back(file + ": has no altitude: the track has none");
    if (track.level == exchange::AltitudeLevel::takeoff)
        cli::warn(call, file + ": it has no altitude above the sea: those of the track are above the take-off");
    return result;
}

Exported export_columns(const cli::StageCall& call, const ExportArguments& arguments, const std::string& file) {
    const auto& options = arguments.load;
    Exported result;
    if (const auto& message = arguments.message) {
        auto table = exchange::message_table(flight::FlightFile(file, options), *message, options.aircraft,
                                             options.recording.value_or(1));
        if (table.recordings > 1 && !options.recording)
            result.notes.push_back(fmt::format(
                "{}: its rows are those of recording 1 of {}; --recording N selects another", file, table.recordings));
        if (!table.left_out.empty())
            result.notes.push_back(
                fmt::format("{}: {} holds no numbers in {}", file, *message, short_list(table.left_out)));
        result.text = std::move(table.csv);
        return result;
    }
    result.text = exchange::series_table(cli::load_flight(call, file, options).series);
    return result;
}

/// The mean power of the mission's computer, flown as it is stated or planned.
double compute_w(const mission::MissionVariant& mission) {
    const auto summary = simulate_prepared(prepare_mission(mission)).simulation.summary;
    return summary.duration_s > 0.0 ? units::joule_from_wh(summary.compute_energy_wh) / summary.duration_s : 0.0;
}

/// An aircraft, and what its mission states for a failsafe.
struct AircraftInput {
    exchange::EstimatorInput estimator;
    std::optional<path::Wind> wind = {};  ///< of a mission with a path; absent where it is calm
    std::optional<mission::PayloadBasis> payload = {};
};

AircraftInput aircraft_input(const cli::StageCall& call, const exchange::EstimatorInput& arguments,
                             const std::vector<ExportInput>& inputs) {
    AircraftInput aircraft{arguments};
    auto& result = aircraft.estimator;
    for (const auto& [file, kind] : inputs) {
        if (kind == ExportKind::model) result.model = mechanical::read_predicting_model(file);
        if (kind == ExportKind::battery) {
            result.battery = battery::read_battery(file);
            for (const auto& warning : battery_warnings(*result.battery))
                cli::warn(call, fmt::format("{}: {}", file, warning));
        }
        if (kind != ExportKind::mission) continue;
        const auto mission = mission::read_mission(file, {true, std::nullopt});
        const auto& setup = setup_of(mission);
        cli::warn_of_setup(call, setup);
        result.model = setup.mechanical;
        result.battery = setup.battery;
        result.compute_w = compute_w(mission);
        if (setup.reserve_soc_percent > 0.0) result.reserve_percent = setup.reserve_soc_percent;
        aircraft.payload = setup.payload;
        if (!setup.cruise_path) continue;
        const auto& wind = setup.cruise_path->plan->wind;
        if (wind.speed_m_per_s > 0.0 || wind.speed_sd_m_per_s > 0.0) aircraft.wind = wind;
    }
    return aircraft;
}

constexpr double max_wind_m_per_s = 100.0;
constexpr double degree_per_turn = 360.0;

Exported export_failsafe(const ExportArguments& arguments, const AircraftInput& aircraft, const Format& to) {
    const auto& input = aircraft.estimator;
    if (!input.model || !input.battery)
        throw UsageError(fmt::format("{} is made of a model and a battery, or of a mission", to.name));
    auto request = arguments.failsafe;
    request.model = *input.model;
    request.battery = *input.battery;
    request.payload = aircraft.payload;
    request.compute_w = input.compute_w;
    if (!request.reserve_percent) request.reserve_percent = input.reserve_percent;
    request.wind_is_of_mission = !arguments.wind && aircraft.wind;
    if (arguments.wind)
        request.wind = cli::parse_wind(*arguments.wind, request.home_course_deg.has_value());
    else if (aircraft.wind)
        request.wind = *aircraft.wind;
    const auto card = make_failsafe_card(request);
    auto parameters = to.write_failsafe(input, card);
    Exported result{std::move(parameters.text), std::move(parameters.notes)};
    result.failsafe = card;
    return result;
}

Exported export_latex(const cli::StageCall& call, const ExportArguments& arguments,
                      const std::vector<ExportInput>& inputs) {
    const auto& [file, kind] = inputs.front();
    if (kind == ExportKind::model) return {report::model_latex(mechanical::read_mechanical_model(file))};
    if (kind == ExportKind::battery) {
        const auto pack = battery::read_battery(file);
        return {to_latex(cli::pack_table(pack), fmt::format("Battery {}", pack.name), "tab:battery")};
    }
    report::ReportInput request;
    request.capacity_ah = arguments.capacity_ah;
    request.with_replay = arguments.with_replay;
    for (const auto& input : inputs) {
        if (input.kind == ExportKind::batch)
            request.out = input.file;
        else
            request.missions.push_back(mission::read_mission(input.file, {true, std::nullopt}));
    }
    if (request.with_replay && (request.out.empty() || request.missions.empty()))
        throw UsageError("--replay needs a folder of flightwatt batch and missions");
    if (arguments.capacity_ah && request.out.empty())
        throw UsageError("--capacity is that of the flights' battery: add a folder of flightwatt batch");
    const auto content = make_report(request, {[&](const std::string& text) { cli::warn(call, text); }});
    Exported result;
    result.text = content.latex.text;
    for (const auto& note : content.summary.at("notes")) result.notes.push_back(note.get<std::string>());
    return result;
}

Exported exported(const cli::StageCall& call, const ExportArguments& arguments, const std::vector<ExportInput>& inputs,
                  const Format& to) {
    const auto& format = to.name;
    const auto& file = inputs.front().file;
    if (to.write_failsafe) return export_failsafe(arguments, aircraft_input(call, arguments.estimator, inputs), to);
    if (to.write) {
        auto parameters = to.write(aircraft_input(call, arguments.estimator, inputs).estimator);
        return {std::move(parameters.text), std::move(parameters.notes)};
    }
    if (format == "geojson" || format == "kml" || format == "gpx") return export_track(call, arguments, file, format);
    if (format == "csv") return export_columns(call, arguments, file);
    if (format == "latex") return export_latex(call, arguments, inputs);
    if (format == "c") return {exchange::to_c_header(mechanical::read_predicting_model(file))};
    return {inputs.front().kind == ExportKind::battery
                ? exchange::to_json_text(battery::read_battery(file))
                : exchange::to_json_text(mechanical::read_mechanical_model(file))};
}

int export_inputs(const cli::StageCall& call, const ExportArguments& arguments) {
    const auto& format = format_of(call, arguments.format);
    refuse_idle_options(call, format);
    std::vector<ExportInput> inputs;
    for (const auto& file : call.inputs) inputs.push_back({file, kind_of(file)});
    for (const auto& input : inputs) require_matching_lengths(input, format);
    require_few(inputs, format);
    auto result = exported(call, arguments, inputs, format);
    cli::write_result(call, result.text);
    for (const auto& note : result.notes) cli::note(call, note);
    if (!call.json) return cli::ok;
    result.inputs = call.inputs;
    result.format = format.name;
    cli::print_json(call, result);
    return cli::ok;
}

}  // namespace

int flightwatt::stages::export_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "export", "FLIGHT|MODEL.toml|PACK.toml|MISSION.toml|OUT...",
        R"(Writes the formats of other programs. Of a log or series: its track (geojson, kml, gpx), or columns over time
(csv, for PlotJuggler). Of models: json, a header for C99 (c), and, from a model and a battery or from a mission, the
parameters of autopilots' estimators (px4, inav, paparazzi, paparazzi-map) and of simulated batteries (ardupilot-sitl,
px4-sitl, gazebo), and their battery failsafes, from the charge that the way home needs (failsafe-ardupilot,
failsafe-px4, failsafe-inav, failsafe-paparazzi). Of models, missions and the folder OUT of flightwatt batch: tables
(latex). The form is that of FILE's ending (.geojson, .kml, .gpx, .csv, .json, .h, .params: px4, .parm: ardupilot-sitl,
.sdf: gazebo, .tex) or of --format.)"};
    stage.next = [](const auto& call) {
        const auto ending = std::filesystem::path(*call.output).extension();
        if (ending == ".sdf") return "paste it into the <model> of the aircraft";
        if (ending == ".kml" || ending == ".gpx" || ending == ".geojson") return "open it in QGIS or Google Earth";
        return ending == ".csv" ? "plotjuggler -d {}" : "";
    };
    stage.json_schema = cli::document_schema<Exported>;
    stage.examples = {
        "flightwatt export flight.data -o flight.kml", "flightwatt export model.toml pack.toml --format px4",
        "flightwatt export model.toml pack.toml --format failsafe-ardupilot --home-distance 1500 --wind 6"};
    stage.reads_logs = stage.uses_threads = true;
    ExportArguments arguments;
    arguments.load.flight_required = arguments.load.power_required = false;
    constexpr double max_cells = 100;
    constexpr double max_idle_w = 1e5;
    auto& options = stage.options;
    options.add("format", arguments.format, {.value = "NAME"},
                "the format, if the ending of FILE does not determine it");
    options.add("message", arguments.message, {.value = "NAME"},
                "of csv: all fields of one message, ENERGY ..., instead of the series' tracks");
    options.add("cells", arguments.estimator.cells_in_series, {.value = "N", .min = 1, .max = max_cells},
                "in series, of the battery; default: its own, or else as few as 4.25 V a cell allow");
    options.add("parallel", arguments.estimator.cells_in_parallel, {.value = "N", .min = 1, .max = max_cells},
                "cells in parallel, of the battery");
    options.add("idle-power", arguments.estimator.idle_w, {.value = "W", .min = 0.0, .max = max_idle_w, .unit = "W"},
                "of inav: with the motor stopped; default: the mission's computer");
    cli::add_capacity_option(options, arguments.capacity_ah,
                             "of latex: of the flights' battery; default: the estimate of flightwatt battery");
    options.add("replay", arguments.with_replay,
                "of latex: also fly the missions on the flights of OUT (flightwatt replay)");
    constexpr double max_percent = 100.0;
    constexpr double max_distance_m = 1e6;
    constexpr double min_probability = 0.5;
    auto& card = arguments.failsafe;
    options.begin_group("Battery failsafes (failsafe-...)");
    options.add("reserve", card.reserve_percent,
                {.value = "PERCENT", .min = 0.0, .max = max_percent, .below_max = true, .unit = "%"},
                "charge to be left at landing; default: the mission's, else 20 %");
    options.add("home-distance", card.home_distance_m,
                {.value = "M", .min = 0.0, .max = max_distance_m, .above_min = true, .unit = "m"},
                "the farthest place from which to return; without it there is no value to return by");
    options.add(
        "wind", arguments.wind, {.value = "SPEED@DEG"},
        "in m/s, and degrees from which: 6@250; it blows from home, unless --home-course is given; default: the "
        "mission's, else calm");
    options.add("home-course", card.home_course_deg,
                {.value = "DEG", .min = -degree_per_turn, .max = degree_per_turn, .unit = "degrees"},
                "the course home, if there is only one");
    options.add("airspeed", card.airspeed_m_per_s,
                {.value = "M_PER_S", .min = 0.0, .max = max_wind_m_per_s, .above_min = true, .unit = "m/s"},
                "on the way home; default: the mean cruise of a physical model");
    options.add("probability", card.probability, {.value = "P", .min = min_probability, .max = 1.0, .below_max = true},
                "with which an action is early enough");
    cli::add_flight_options(options, arguments.load);
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return export_inputs(call, arguments); });
}
