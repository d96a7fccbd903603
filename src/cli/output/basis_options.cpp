#include "cli/output/basis_options.h"

#include "base/error.h"
#include "base/units.h"
#include "cli/numeric_options.h"
#include "cli/output/mission_output.h"
#include "live/prediction.h"
#include "mechanical/model_check.h"
#include "mission/mission_file.h"

#include <map>
#include <utility>

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

/// None: as the model and the flight allow.
std::optional<mechanical::CruisePrior> level_option(const StageCall& call) {
    const auto name = call.get<std::string>("level");
    static const std::map<std::string, mechanical::CruisePrior> sources{
        {"curve", mechanical::CruisePrior::curve},
        {"constant", mechanical::CruisePrior::constant},
        {"airspeed", mechanical::CruisePrior::airspeed},
        {"covariate", mechanical::CruisePrior::covariate}};
    if (name == "auto") return std::nullopt;
    if (const auto found = sources.find(name); found != sources.end()) return found->second;
    throw UsageError(fmt::format("--level {}: expected auto, curve, constant, airspeed or covariate", name));
}

/// How the rest of the cruise is to be flown, where --airspeed says it.
std::optional<mechanical::FlightState> motion_ahead(const StageCall& call) {
    constexpr double max_m_per_s = 200.0;
    const auto airspeed = positive_option(call, "airspeed", "m/s");
    if (!airspeed) {
        if (call.has("climb")) throw UsageError("--climb goes with --airspeed");
        return std::nullopt;
    }
    if (!call.options["level"].defaulted())
        throw UsageError("--airspeed and --level exclude each other: give one of them");
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
    if (call.has("airspeed") || call.has("climb") || !call.options["level"].defaulted())
        throw UsageError("--mission says how the rest is flown: leave --airspeed, --climb and --level out");
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
    basis.level = level_option(call);
    if (basis.motion) live::require_physical(basis.model, call.get<std::string>("model"), "--airspeed");
    return basis;
}

}  // namespace

void add_basis_options(boost::program_options::options_description& options, PathNeed need) {
    auto add = options.add_options();
    add("remaining", value<double>("S"),
        "seconds from the moment until landing begins; with --mission only where the flight is not as far along the "
        "path as its positions say, or, without any, the time since its cruise began");
    add("level", value("HOW")->default_value("auto"),
        "what is expected of the cruise before its own power is looked at: the model's curve, the curve's mean "
        "(constant), the power that the airspeed so far and the other flights' later one stand for (airspeed), or that "
        "of the model's level law (covariate); auto is covariate for a model that was fitted with --level-covariate, "
        "and else curve");
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

}  // namespace flightwatt::cli
