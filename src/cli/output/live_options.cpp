#include "cli/output/live_options.h"

#include "base/error.h"
#include "base/number.h"
#include "base/units.h"
#include "battery/battery_toml.h"
#include "cli/output/mission_output.h"
#include "live/followed_files.h"
#include "live/received_links.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/prediction.h"
#include "mechanical/speed_to_fly.h"
#include "mission/mission_file.h"
#include "mission/new_mission_plan.h"
#include "telemetry/autopilot_log.h"
#include "telemetry/binary_log.h"
#include "telemetry/data_file.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <boost/algorithm/string/predicate.hpp>
#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

using live::PredictionInput;

PredictionInput read_mission_basis(const StageCall& call, const BasisArguments& arguments,
                                   std::optional<mission::MissionVariant>* kept) {
    const auto& file = *arguments.mission;
    auto mission = mission::read_mission(file, {.allow_unplanned = true});
    const auto& setup = setup_of(mission);
    if (!setup.mechanical)
        throw InputError({file}, "the mission has no mechanical model", "name one: mechanical = FILE");
    warn_of_setup(call, setup);
    auto basis = arguments.uses_missions_battery ? live::input_from_mission(setup, file)
                                                 : live::energy_input_from_mission(setup, file);
    basis.remaining_s = arguments.remaining_s;
    if (kept != nullptr) *kept = std::move(mission);
    return basis;
}

PredictionInput read_model_basis(const StageCall& call, const BasisArguments& arguments) {
    if (!arguments.model) throw UsageError("no model given: expected --mission MISSION.toml, or --model MODEL.toml");
    if (!arguments.remaining_s)
        throw UsageError(
            "no time left given: expected --remaining SECONDS, or --mission MISSION.toml, which states it");
    const auto& file = *arguments.model;
    auto model = mechanical::read_predicting_model(file);
    for (const auto& warning : model_warnings(model)) warn(call, fmt::format("{}: {}", file, warning));
    auto basis = live::input_from_model(std::move(model), file, *arguments.remaining_s);
    if (!arguments.airspeed_m_per_s) return basis;
    basis.motion = mechanical::FlightState{.airspeed_m_per_s = *arguments.airspeed_m_per_s};
    if (arguments.climb_m_per_s) basis.motion->climb_m_per_s = *arguments.climb_m_per_s;
    if (auto& physical = basis.model.physical) physical = mechanical::with_cost_of_airspeed(*std::move(physical));
    live::require_physical(basis.model, file, "--airspeed");
    return basis;
}

/// Throws InputError where the beginning of a text has complete lines, and none of them is a message of Paparazzi.
void require_messages(const std::filesystem::path& path, const std::string& bytes) {
    const auto is_message = [](const std::string& line) { return live::parse_message_line(line).has_value(); };
    std::vector<std::string> lines;
    for (std::size_t begin = 0, end = 0; (end = bytes.find('\n', begin)) != std::string::npos; begin = end + 1)
        lines.push_back(bytes.substr(begin, end - begin));
    if (lines.empty() || std::ranges::any_of(lines, is_message)) return;
    throw InputError({path.string()}, "has no line of a Paparazzi log",
                     "watch follows Paparazzi's and a ground station's .tlog; flightwatt predict takes other logs, "
                     "with --at");
}

/// Whether the file that is to be followed is a .tlog: by its content, and while it has none by its name.
bool is_tlog(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return false;  // rejected when it is followed
    const auto bytes = telemetry::beginning_of_file(path);
    if (bytes.empty()) return boost::iequals(path.extension().string(), ".tlog");
    return telemetry::detect_autopilot_format(bytes) == telemetry::AutopilotFormat::tlog;
}

/// Whether the file that is to be followed is binary: by its content, and while it has none by its name.
bool is_binary_log(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return false;  // rejected when it is followed
    const auto bytes = telemetry::beginning_of_file(path);
    if (telemetry::detect_autopilot_format(bytes))
        throw InputError({path.string()}, "is a log of another autopilot, which is not followed",
                         "watch follows Paparazzi's and a ground station's .tlog; flightwatt predict takes this one, "
                         "with --at");
    if (telemetry::detect_binary_framing(bytes)) return true;
    require_messages(path, bytes);
    if (!bytes.empty()) return false;
    const auto ending = path.extension().string();
    return ending == ".LOG" || ending == ".tlm" || ending == ".TLM" || ending == ".bin";
}

telemetry::MessageDictionary read_definitions(const SourceArguments& arguments, const std::string& what) {
    if (const auto file = definitions_of_source(arguments)) return telemetry::read_message_dictionary(*file);
    throw InputError(
        {what}, "Paparazzi's frames need the definitions of their messages",
        "give --log FILE.log of the aircraft, or --messages messages.xml; of MAVLink: --mavlink udp:14550");
}

std::unique_ptr<live::MessageSource> follow(const SourceArguments& arguments, const std::string& file) {
    if (is_tlog(file)) return live::follow_tlog(file);
    if (!is_binary_log(file)) return live::follow_data_file(file);
    return live::follow_binary_log(file, read_definitions(arguments, file));
}

/// The input of predictions of a plan that is flown with the model and the battery of the options.
PredictionInput read_plan_basis(const StageCall& call, const BasisArguments& arguments,
                                const std::filesystem::path& plan) {
    if (!arguments.model || !arguments.battery)
        throw UsageError("a plan is flown with --model MODEL.toml and --battery BATTERY.toml");
    mission::NewMission fresh;
    fresh.name = plan.stem().string();
    fresh.mechanical = std::filesystem::absolute(*arguments.model).string();
    fresh.model = mechanical::read_mechanical_model(*arguments.model);
    fresh.battery = std::filesystem::absolute(*arguments.battery).string();
    fresh.pack = battery::read_battery(*arguments.battery);
    fly_plan({plan, std::filesystem::absolute(plan).string(), {}, arguments.airspeed_m_per_s}, *arguments.model, fresh);
    for (const auto& chosen : fresh.flown->chosen) note(call, fmt::format("chosen: {}", chosen));
    const auto file = plan.string();
    const auto mission = mission::parse_mission(new_mission_toml(fresh), file, {.allow_unplanned = true});
    warn_of_setup(call, setup_of(mission));
    auto basis = live::input_from_mission(setup_of(mission), file);
    basis.remaining_s = arguments.remaining_s;
    return basis;
}

}  // namespace

void add_basis_options(Options& options, BasisArguments& arguments) {
    constexpr double max_remaining_s = 1e6;  // no battery flies for eleven days
    constexpr double max_m_per_s = 200.0;
    const bool with_battery = arguments.uses_missions_battery;
    options.add("model", arguments.model, {.value = "MODEL.toml", .file = FileRole::input, .excludes = {"mission"}},
                "from flightwatt fit, of two flights or more");
    options.add(
        "remaining", arguments.remaining_s, {.value = "S", .min = 0.0, .max = max_remaining_s, .unit = "s"},
        "seconds from now until landing begins; with --mission only where the position of the flight differs from "
        "the path, or, without any, the time since its cruise began");
    options.add("airspeed", arguments.airspeed_m_per_s,
                {.value = "M_PER_S", .min = 0.0, .above_min = true, .unit = "m/s", .excludes = {"mission"}},
                "airspeed of the remaining cruise: predicts it by the model's [physical] at this flight's own level");
    options.add("climb", arguments.climb_m_per_s,
                {.value = "M_PER_S", .min = -max_m_per_s, .max = max_m_per_s, .unit = "m/s", .needs = {"airspeed"}},
                "and its climb (0; below 0 it descends)");
    options.add("mission", arguments.mission, input_file("MISSION.toml"),
                fmt::format("a mission, instead of --model: the remaining path or cruise is flown, with its model, its "
                            "wind{}",
                            with_battery ? ", its landing, its battery and its schedule" : " and its landing"));
    options.add("plan", arguments.plan,
                {.value = "FILE", .file = FileRole::input, .needs = {"battery"}, .excludes = {"mission"}},
                "a plan that is flown (.plan, .waypoints, GeoJSON, KML, CSV), with --model and --battery");
    options.add(
        "battery", arguments.battery, input_file("BATTERY.toml"),
        "also predict state of charge and voltage at landing, and how long the cruise could continue from there");
    options.add(
        "initial-soc", arguments.initial_soc_percent,
        {.value = "PERCENT",
         .min = 0.0,
         .max = 100.0,
         .unit = "%",
         .needs = with_battery ? std::vector<std::string>{"battery", "mission"} : std::vector<std::string>{"battery"}},
        "the battery's state of charge when the log begins; else by its voltage at rest");
}

PredictionInput read_basis(const StageCall& call, const BasisArguments& arguments,
                           std::optional<mission::MissionVariant>* mission) {
    auto basis = arguments.mission ? read_mission_basis(call, arguments, mission)
                 : arguments.plan  ? read_plan_basis(call, arguments, *arguments.plan)
                                   : read_model_basis(call, arguments);
    if (arguments.battery) {
        basis.battery = battery::read_battery(*arguments.battery);
        basis.battery_file = *arguments.battery;
    }
    if (arguments.initial_soc_percent) basis.initial_soc_percent = arguments.initial_soc_percent;
    return basis;
}

void add_time_options(Options& options, RequestedTime& time) {
    options.add(
        "at", time.since_lift_off_s,
        {.value = "S",
         .min = 0.0,
         .above_min = true,
         .unit = "s since lift-off",
         .excludes = {"at-log-time"},
         .old_name = "until"},
        "the time of the prediction in seconds since lift-off, as flightwatt segment finds it in the flight up to "
        "then; default: the end of the log, which may still grow");
    options.add("at-log-time", time.log_time_s,
                {.value = "S", .min = 0.0, .above_min = true, .unit = "s", .old_name = "until-log-time"},
                "the same in the log's own seconds");
}

double resolve_log_time(const RequestedTime& time, const std::vector<flight::FlightSeries>& candidates,
                        std::size_t sortie, const flight::SegmentationOptions& options) {
    if (time.log_time_s) return *time.log_time_s;
    if (!time.since_lift_off_s) {
        double last_s = 0.0;
        for (const auto& series : candidates) last_s = std::max(last_s, last_time_s(series));
        return last_s;
    }
    std::optional<double> first_s;
    std::optional<NoResultError> refusal;
    for (const auto& series : candidates) {
        try {
            const double time_s = mechanical::log_time_after_lift_off(series, *time.since_lift_off_s, sortie, options);
            first_s = std::min(first_s.value_or(time_s), time_s);
        } catch (const NoResultError& error) {
            if (!refusal) refusal = error;
        }
    }
    if (!first_s) throw NoResultError(*refusal);
    return *first_s;
}

void add_source_options(Options& options, SourceArguments& arguments) {
    const std::vector<std::string> links{"mavlink", "udp", "serial", "ivy"};
    options.begin_group("Source of telemetry");
    options.add("follow", arguments.follow, {.value = "FILE", .file = FileRole::input, .excludes = links},
                "a log that is being written: a ground station's .tlog, a .data, or a binary one of Paparazzi");
    options.add("mavlink", arguments.mavlink, {.value = "LINK", .excludes = {"udp", "serial", "ivy"}},
                "MAVLink of ArduPilot, PX4 and others: udp:14550 (a port of this machine), udpout:HOST:PORT (a program "
                "that must hear first: a heartbeat is sent once a second), tcp:HOST:PORT or /dev/ttyUSB0:57600");
    options.add("udp", arguments.udp, {.value = "PORT", .excludes = {"serial", "ivy"}},
                "Paparazzi's link frames on a UDP port (4242), or at ADDRESS:PORT");
    options.add("serial", arguments.serial, {.value = "DEVICE:BAUD", .excludes = {"ivy"}},
                "link frames, or an XBee's packets, on a serial line (/dev/ttyUSB0:57600)");
    options.add("ivy", arguments.ivy, {.value = "ADDRESS:PORT"}, "an Ivy bus (127.255.255.255:2010)");
    options.add("clock-factor", arguments.clock_factor,
                {.value = "X", .min = 0.0, .above_min = true, .unit = "times as fast", .needs = links},
                "messages without a time arrive X times as fast as they were sent: of a log that is played (1)");
    options.add(
        "log", arguments.log, {.value = "FILE.log", .file = FileRole::input, .excludes = {"messages"}},
        "the telemetry's definitions; default: the .log next to a file that is followed, else the built-in ones, "
        "which frames lack");
    options.add("messages", arguments.messages, input_file("FILE"), "the same from a messages.xml");
    options.begin_group("Options");
}

bool is_mavlink_source(const SourceArguments& arguments) {
    return arguments.mavlink || (arguments.follow && is_tlog(*arguments.follow));
}

std::optional<std::string> definitions_of_source(const SourceArguments& arguments) {
    if (arguments.messages) return arguments.messages;
    if (arguments.log || !arguments.follow) return arguments.log;
    const auto log_file = telemetry::find_log_file(*arguments.follow);
    return log_file ? std::optional(log_file->string()) : std::nullopt;
}

std::unique_ptr<live::MessageSource> open_source(const StageCall& call, const SourceArguments& arguments) {
    const auto& [follow_file, mavlink, udp, serial, ivy, clock_factor, log, messages] = arguments;
    const bool has_option = follow_file || mavlink || udp || serial || ivy;
    if (!call.inputs.empty() && call.inputs.front() != "-") {
        throw UsageError(
            fmt::format("'{0}': expected - (the standard input); to follow a file: --follow {0}", call.inputs.front()));
    }
    if (call.inputs.empty() != has_option)
        throw UsageError(
            "expected one source: --follow FILE, --mavlink LINK, --udp PORT, --serial DEVICE:BAUD, --ivy ADDRESS:PORT "
            "or - (the standard input)");
    if (is_mavlink_source(arguments) && (log || messages))
        throw UsageError("--log and --messages define Paparazzi's messages: MAVLink's are known");
    const double factor = clock_factor.value_or(1.0);
    if (follow_file) return follow(arguments, *follow_file);
    if (mavlink) return live::open_mavlink(*mavlink, factor);
    if (ivy) return live::open_ivy_bus(*ivy, factor);
    if (udp) return live::open_udp(*udp, read_definitions(arguments, "--udp " + *udp), factor);
    if (serial) return live::open_serial(*serial, read_definitions(arguments, "--serial " + *serial), factor);
    return live::open_standard_input();
}

}  // namespace flightwatt::cli
