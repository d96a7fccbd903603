#include "cli/output/live_options.h"

#include "base/error.h"
#include "base/number.h"
#include "base/units.h"
#include "cli/output/mission_output.h"
#include "cli/stage.h"
#include "live/prediction.h"
#include "live/sources.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/prediction.h"
#include "mission/mission_file.h"
#include "telemetry/binary_log.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

using live::PredictionInput;

/// The model that --model names.
mechanical::MechanicalModel read_model(const StageCall& call) {
    const auto file = call.get<std::string>("model");
    auto model = mechanical::read_mechanical_model(file);
    for (const auto& warning : model_warnings(model)) warn(call, fmt::format("{}: {}", file, warning));
    return model;
}

/// How the rest of the cruise is to be flown, where --airspeed says it.
std::optional<mechanical::FlightState> motion_ahead(const StageCall& call) {
    constexpr double max_m_per_s = 200.0;
    const auto airspeed = positive_option(call, "airspeed", "m/s");
    if (!airspeed) {
        if (call.has("climb")) throw UsageError("--climb goes with --airspeed");
        return std::nullopt;
    }
    mechanical::FlightState motion{.airspeed_m_per_s = *airspeed};
    if (call.has("climb")) motion.climb_m_per_s = number_option(call, "climb", -max_m_per_s, max_m_per_s);
    return motion;
}

std::optional<double> remaining_option(const StageCall& call) {
    constexpr double max_s = 1e6;  // no battery flies for eleven days
    if (!call.has("remaining")) return std::nullopt;
    return number_option(call, "remaining", 0.0, max_s);
}

PredictionInput read_mission_basis(const StageCall& call, PathNeed need, std::optional<mission::MissionVariant>* kept) {
    if (call.has("model")) throw UsageError("--mission names its model: leave --model out");
    if (call.has("airspeed") || call.has("climb"))
        throw UsageError("--mission says how the rest is flown: leave --airspeed and --climb out");
    const auto remaining_s = remaining_option(call);
    const auto file = call.get<std::string>("mission");
    mission::MissionReadOptions reading;
    reading.allow_unplanned = true;
    auto mission = mission::read_mission(file, reading);
    const auto& setup = setup_of(mission);
    if (!setup.cruise_path && need == PathNeed::required) {
        throw InputError({file}, "the mission has no [path]",
                         "say where it flies (docs/missions.md, path), or give --model and --remaining");
    }
    if (!setup.mechanical)
        throw InputError({file}, "the mission has no mechanical model", "name one: mechanical = FILE");
    warn_of_setup(call, setup);
    auto basis =
        need == PathNeed::required ? live::path_input_from_mission(setup, file) : live::input_from_mission(setup, file);
    basis.remaining_s = remaining_s;
    if (kept != nullptr) *kept = std::move(mission);
    return basis;
}

PredictionInput read_model_basis(const StageCall& call) {
    if (!call.has("model")) throw UsageError("no model given: expected --model MODEL.toml, or --mission MISSION.toml");
    if (!call.has("remaining")) throw UsageError("no time left given: expected --remaining SECONDS");
    const auto remaining_s = remaining_option(call);
    const auto motion = motion_ahead(call);
    auto basis = live::input_from_model(read_model(call), call.get<std::string>("model"), remaining_s.value());
    basis.motion = motion;
    if (basis.motion) live::require_physical(basis.model, call.get<std::string>("model"), "--airspeed");
    return basis;
}

constexpr std::array links{"udp", "serial", "ivy"};

/// Whether the file that is to be followed is binary: by its content, and while it has none by its name.
bool is_binary_log(const std::filesystem::path& path) {
    constexpr std::size_t enough = 65'536;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return false;  // rejected when it is followed
    std::string bytes(enough, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
    if (!bytes.empty()) return telemetry::detect_binary_framing(bytes).has_value();
    const auto ending = path.extension().string();
    return ending == ".LOG" || ending == ".tlm" || ending == ".TLM" || ending == ".bin";
}

telemetry::MessageDictionary read_definitions(const StageCall& call, const std::string& what) {
    if (const auto file = definitions_of_source(call)) return telemetry::read_message_dictionary(*file);
    throw InputError({what}, "frames need the definitions of their messages",
                     "give --log FILE.log of the aircraft, or --messages messages.xml");
}

std::unique_ptr<live::MessageSource> follow(const StageCall& call, const std::string& file) {
    if (!is_binary_log(file)) return live::follow_data_file(file);
    return live::follow_binary_log(file, read_definitions(call, file));
}

void refuse_other_sources(const StageCall& call) {
    std::vector<std::string> given;
    if (!call.inputs.empty()) given.emplace_back("-");
    for (const auto* option : {"follow", "udp", "serial", "ivy"}) {
        if (call.has(option)) given.push_back(std::string("--") + option);
    }
    if (given.empty())
        throw UsageError(
            "no source given: expected --follow FILE, --udp PORT, --serial DEVICE:BAUD, --ivy ADDRESS:PORT or - (the "
            "standard input)");
    if (given.size() > 1)
        throw UsageError(fmt::format("{} and {} exclude each other: give one of them", given[0], given[1]));
}

}  // namespace

void add_basis_options(boost::program_options::options_description& options, PathNeed need) {
    auto add = options.add_options();
    add("remaining", value<double>("S"),
        "seconds from the moment until landing begins; with --mission only where the flight is not as far along the "
        "path as its positions say, or, without any, the time since its cruise began");
    add("airspeed", value<double>("M_PER_S"),
        "how fast the rest of the cruise is flown: predicts it by the model's [physical] at this flight's own level");
    add("climb", value<double>("M_PER_S"), "and how fast it climbs (0; below 0 it descends)");
    add("mission", input_file("MISSION.toml"),
        need == PathNeed::required
            ? "a mission with a [path], instead of --model: the rest of its path is flown, with its model, its wind "
              "and its landing"
            : "a mission, instead of --model: the rest of its path, or of its cruise, is flown, with its model, its "
              "wind, its landing, its battery and its schedule");
    add("battery", input_file("BATTERY.toml"),
        "also tell state of charge and voltage at landing, and how long the cruise could go on from there");
    add("initial-soc", value<double>("PERCENT"),
        "the battery's state of charge when the log begins; else by its voltage at rest");
}

PredictionInput read_basis(const StageCall& call, PathNeed need, std::optional<mission::MissionVariant>* mission) {
    if (call.has("initial-soc") && !call.has("battery") && (need == PathNeed::required || !call.has("mission")))
        throw UsageError("--initial-soc goes with --battery");
    std::optional<double> initial_soc_percent;
    if (call.has("initial-soc"))
        initial_soc_percent = number_option(call, "initial-soc", 0.0, units::percent_per_whole);
    auto basis = call.has("mission") ? read_mission_basis(call, need, mission) : read_model_basis(call);
    if (const auto file = call.get_optional<std::string>("battery")) {
        basis.battery = battery::read_battery(*file);
        basis.battery_file = *file;
    }
    if (initial_soc_percent) basis.initial_soc_percent = initial_soc_percent;
    return basis;
}

RequestedTime read_requested_time(const StageCall& call) {
    const auto log_time_s = positive_option(call, "until-log-time", "s");
    if (log_time_s && !call.options["until"].defaulted()) {
        throw UsageError("--until and --until-log-time exclude each other: give one of them");
    }
    const auto text = call.get<std::string>("until");
    if (text == "now") return {std::nullopt, log_time_s};
    const auto since_s = parse_number(text);
    if (!since_s || !(*since_s > 0.0) || !std::isfinite(*since_s)) {
        throw UsageError(fmt::format("--until {}: expected now, or seconds since lift-off, more than 0", text));
    }
    return {since_s, std::nullopt};
}

double resolve_log_time(const RequestedTime& moment, const std::vector<flight::FlightSeries>& candidates,
                        std::size_t sortie, const flight::SegmentationOptions& options) {
    if (moment.log_time_s) return *moment.log_time_s;
    if (!moment.since_lift_off_s) {
        double last_s = 0.0;
        for (const auto& series : candidates) last_s = std::max(last_s, mechanical::last_time_s(series));
        return last_s;
    }
    std::optional<double> first_s;
    std::optional<NoResultError> refusal;
    for (const auto& series : candidates) {
        try {
            const double time_s =
                mechanical::log_time_after_lift_off(series, *moment.since_lift_off_s, sortie, options);
            first_s = std::min(first_s.value_or(time_s), time_s);
        } catch (const NoResultError& error) {
            if (!refusal) refusal = error;
        }
    }
    if (!first_s) throw NoResultError(*refusal);
    return *first_s;
}

void add_source_options(boost::program_options::options_description& options) {
    auto add = options.add_options();
    add("follow", input_file("FILE"), "a log that is being written: a .data, or a binary one");
    add("udp", value("PORT"), "Paparazzi's link frames that come in on a UDP port (4242), or at ADDRESS:PORT");
    add("serial", value("DEVICE:BAUD"), "link frames, or an XBee's packets, on a serial line (/dev/ttyUSB0:57600)");
    add("ivy", value("ADDRESS:PORT"), "an Ivy bus (127.255.255.255:2010)");
    add("clock-factor", value<double>("X"),
        "messages without a time come in X times as fast as they were: of a log that is played (1)");
    add("log", input_file("FILE.log"),
        "the telemetry's definitions; by default the .log beside a file that is followed, else the built-in ones, which "
        "frames lack");
    add("messages", input_file("FILE"), "the same from a messages.xml");
}

std::optional<std::string> definitions_of_source(const StageCall& call) {
    if (call.has("messages") && call.has("log"))
        throw UsageError("--messages and --log exclude each other: give one of them");
    if (call.has("messages")) return call.get<std::string>("messages");
    if (call.has("log")) return call.get<std::string>("log");
    if (!call.has("follow")) return std::nullopt;
    const auto beside = telemetry::find_log_file(call.get<std::string>("follow"));
    return beside ? std::optional(beside->string()) : std::nullopt;
}

std::unique_ptr<live::MessageSource> open_source(const StageCall& call) {
    if (!call.inputs.empty() && call.inputs.front() != "-") {
        throw UsageError(
            fmt::format("'{0}': expected - (the standard input); to follow a file: --follow {0}", call.inputs.front()));
    }
    refuse_other_sources(call);
    const auto factor = positive_option(call, "clock-factor", "times as fast");
    const bool is_link = std::any_of(links.begin(), links.end(), [&](const char* link) { return call.has(link); });
    if (factor && !is_link) throw UsageError("--clock-factor goes with --udp, --serial or --ivy");
    if (call.has("follow")) return follow(call, call.get<std::string>("follow"));
    if (call.has("ivy")) return live::open_ivy_bus(call.get<std::string>("ivy"), factor.value_or(1.0));
    if (call.has("udp")) {
        const auto at = call.get<std::string>("udp");
        return live::open_udp(at, read_definitions(call, "--udp " + at), factor.value_or(1.0));
    }
    if (call.has("serial")) {
        const auto line = call.get<std::string>("serial");
        return live::open_serial(line, read_definitions(call, "--serial " + line), factor.value_or(1.0));
    }
    return live::standard_input();
}

}  // namespace flightwatt::cli
