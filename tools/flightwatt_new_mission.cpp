// A mission file to begin with, made for the files that it names.

#include "base/number.h"
#include "battery/battery.h"
#include "battery/battery_toml.h"
#include "cli/output/mission_output.h"
#include "cli/output/stage_options.h"
#include "cli/stage.h"
#include "compute/profile_reader.h"
#include "mission/mission_file.h"
#include "mission/new_mission_path.h"
#include "mission/new_mission_plan.h"
#include "mission/new_mission_toml.h"
#include "stages.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string_view>

#include <boost/algorithm/string.hpp>
#include <fmt/format.h>

namespace {

using namespace flightwatt;

/// JSON of the stage.
struct NewMissionOutput {
    std::string mission;
    std::vector<std::string> components;
    bool planned = false;
};

Fields<NewMissionOutput> record_fields(const NewMissionOutput*) {
    using R = NewMissionOutput;
    return {field("mission", &R::mission, "name of the mission"),
            field("components", &R::components, "names of the components"),
            field("planned", &R::planned, "its schedule is made by `plan`")};
}

/// A file as a mission in `folder` names it.
std::string named_from(const std::filesystem::path& folder, const std::filesystem::path& file) {
    std::error_code error;
    const auto near = std::filesystem::proximate(file, folder, error);
    return (error ? std::filesystem::absolute(file) : near).generic_string();
}

struct NewMissionArguments {
    std::optional<std::string> model;
    std::optional<std::string> battery;
    std::vector<std::string> profiles;
    std::optional<std::string> parameters;
    std::optional<std::string> name;
    std::optional<std::string> plan;
    mission::PlanToFly flown;  ///< but its file
    std::optional<std::string> wind;
    bool replaces = false;
    mission::NewMission mission;  ///< what options state of it
};

std::string required_file(const std::optional<std::string>& file, const char* option, const char* made_by) {
    if (!file) throw UsageError(fmt::format("expected --{} FILE, from `flightwatt {}`", option, made_by));
    return *file;
}

/// The file's name without its ending, or the next free one of NAME_2, NAME_3, ...
std::string component_name(const std::filesystem::path& profile, const std::vector<mission::NewComponent>& others) {
    const auto stem = profile.stem().string();
    auto name = stem;
    for (int use = 2; std::ranges::find(others, name, &mission::NewComponent::name) != others.end(); ++use)
        name = fmt::format("{}_{}", stem, use);
    return name;
}

/// The mission that the options describe, to be written to `file`.
mission::NewMission described_mission(const NewMissionArguments& arguments, const std::filesystem::path& file) {
    const auto mechanical = required_file(arguments.model, "model", "batch");
    const auto pack = required_file(arguments.battery, "battery", "battery");
    const auto folder = std::filesystem::absolute(file).parent_path();
    auto fresh = arguments.mission;
    fresh.name = arguments.name.value_or(file.stem().string());
    fresh.mechanical = named_from(folder, mechanical);
    fresh.model = mechanical::read_mechanical_model(mechanical);
    fresh.battery = named_from(folder, pack);
    fresh.pack = battery::read_battery(pack);
    if (arguments.plan) {
        auto flown = arguments.flown;
        flown.file = *arguments.plan;
        flown.name = named_from(folder, flown.file);
        if (flown.terrain) flown.terrain_name = named_from(folder, *flown.terrain);
        fly_plan(flown, mechanical, fresh);
    }
    if (arguments.wind) fresh.wind = cli::parse_wind(*arguments.wind, true);
    compute::ProfileNaming naming;
    naming.where.file = "new-mission --parameters A,B";
    if (arguments.parameters) boost::algorithm::split(naming.parameters, *arguments.parameters, boost::is_any_of(","));
    for (const auto& profile : arguments.profiles) {
        fresh.components.push_back({component_name(profile, fresh.components), named_from(folder, profile),
                                    compute::read_power_profile(profile, naming)});
    }
    if (fresh.is_planned && fresh.components.empty()) {
        throw UsageError("--planned: expected --profile FILE of the software whose schedule is to be planned");
    }
    fresh.states_parameters = arguments.parameters.has_value();
    return fresh;
}

/// The option that states the key in a line of the mission; empty if none does.
std::string option_of(std::string_view text, std::size_t line) {
    for (; line > 1; --line) text.remove_prefix(std::min(text.size(), text.find('\n') + 1));
    const std::string key(text.substr(0, text.find(' ')));
    const std::map<std::string, std::string> options{{"payload_kg", "--payload"},
                                                     {"airspeed_m_per_s", "--airspeed"},
                                                     {"takeoff_mass_kg", "--mass"},
                                                     {"speed_m_per_s", "--wind"}};
    const auto found = options.find(key);
    return found == options.end() ? "" : found->second;
}

/// The mission as `simulate` reads it. What is wrong with an option or a plan is placed there, and not in the mission,
/// which is not written.
mission::MissionVariant read_again(const std::string& text, const std::filesystem::path& file,
                                   const NewMissionArguments& arguments) {
    try {
        return mission::parse_mission(text, file, {.allow_unplanned = arguments.mission.is_planned});
    } catch (const InputError& error) {
        if (error.where().file != file) throw;
        if (const auto option = option_of(text, error.where().line); !option.empty())
            throw InputError({"new-mission " + option}, error.what(), error.hint());
        if (!arguments.plan) throw;
        throw InputError({*arguments.plan}, error.what(), error.hint());
    }
}

int write_new_mission(const cli::StageCall& call, const NewMissionArguments& arguments) {
    const std::filesystem::path file = call.output.value_or("mission.toml");
    std::error_code none;
    if (call.output && !arguments.replaces && std::filesystem::exists(file, none))
        throw UsageError(
            fmt::format("{} is there already and stays as it is: give another name, or --force to "
                        "replace it",
                        file.string()));
    const auto fresh = described_mission(arguments, file);
    const auto text = new_mission_toml(fresh);
    const auto read = read_again(text, file, arguments);
    cli::write_result(call, text);
    cli::warn_of_setup(call, setup_of(read));
    if (fresh.flown)
        for (const auto& chosen : fresh.flown->chosen) cli::note(call, fmt::format("chosen: {}", chosen));
    if (call.json) {
        NewMissionOutput output{fresh.name, {}, fresh.is_planned};
        for (const auto& component : fresh.components) output.components.push_back(component.name);
        cli::print_json(call, output);
    } else if (call.output) {
        cli::note_power_model(call, setup_of(read));
    }
    return cli::ok;
}

}  // namespace

int flightwatt::stages::new_mission_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "new-mission", "--model MODEL.toml --battery PACK.toml [--profile P.csv]...",
        R"(Writes a mission file to begin with, for that aircraft, pack and software. It simulates as it is: each
component runs at the middle of what was profiled, and 20 % of charge are kept in reserve. --plan names what is flown:
a plan of QGroundControl or ArduPilot, a flight plan of Paparazzi, or an area (GeoJSON, KML). --all-keys adds every other
key as a comment, with its meaning and an example.)"};
    stage.next = [](const auto& call) { return call.has("planned") ? "flightwatt plan {}" : "flightwatt simulate {}"; };
    stage.json_schema = cli::document_schema<NewMissionOutput>;
    stage.min_inputs = 0;
    stage.max_inputs = 0;
    stage.output_help = "write the mission to FILE, which names its files relative to it";
    stage.examples = {"flightwatt new-mission --model model.toml --battery pack.toml -o first.toml",
                      "flightwatt new-mission --model model.toml --battery pack.toml --plan survey.plan --wind 6@250",
                      "flightwatt new-mission --model model.toml --battery pack.toml --profile dnn.csv --planned"};
    NewMissionArguments arguments;
    auto& options = stage.options;
    options.add("model", arguments.model,
                {.value = "MODEL.toml", .file = cli::FileRole::input, .old_name = "mechanical"},
                "the aircraft's mechanical power, from flightwatt batch or fit");
    options.add("battery", arguments.battery, cli::input_file("PACK.toml"), "its pack, from flightwatt battery");
    options.add("profile", arguments.profiles, cli::input_file("FILE"),
                "software on board, from flightwatt profile; may be given several times");
    options.add("parameters", arguments.parameters, {.value = "A,B", .needs = {"profile"}},
                "names of the profiles' parameters, where these have flags (powprofiler)");
    options.add("planned", arguments.mission.is_planned,
                "leave the schedule to flightwatt plan: utilities and [plan] instead of [[schedule]]");
    options.add("name", arguments.name, {.value = "NAME"}, "the mission's name; default: FILE's");
    options.add("cruise", arguments.mission.cruise_s,
                {.value = "TIME", .min = 0.0, .above_min = true, .unit = "s", .excludes = {"plan"}},
                "duration of the cruise: 1800, 30min or 0.5h; default: the mean of the model's flights");
    options.add("payload", arguments.mission.payload_kg, {.value = "KG", .min = 0.0, .max = 1000.0, .unit = "kg"},
                "what the aircraft carries beyond its own mass");
    options.add(
        "mass", arguments.mission.takeoff_mass_kg,
        {.value = "KG", .min = 0.0, .above_min = true, .unit = "kg", .needs = {"payload"}, .old_name = "takeoff-mass"},
        "mass of the aircraft as it flew, where its flights do not show the effect of payload");
    options.add("reserve", arguments.mission.reserve_soc_percent, {.value = "PERCENT", .min = 0.0, .max = 99.0},
                "charge to land with");
    options.add("plan", arguments.plan, cli::input_file("FILE"),
                "what is flown: .plan, .waypoints, GeoJSON, KML, CSV, or a flight plan of Paparazzi (XML)");
    cli::add_plan_options(options, arguments.flown, {"plan"});
    options.add("wind", arguments.wind, {.value = "SPEED@DEG", .needs = {"plan"}},
                "wind along the plan: 6@250 is 6 m/s from 250 degrees");
    options.add("packs", arguments.mission.packs, {.value = "N", .min = 1.0, .max = 1000.0},
                "fly the cruise with N packs, changed on the ground: [packs]");
    options.add("all-keys", arguments.mission.shows_all_keys, "write every key, explained, those not used as comments");
    options.add("force", arguments.replaces, "replace FILE of -o");
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return write_new_mission(call, arguments); });
}
