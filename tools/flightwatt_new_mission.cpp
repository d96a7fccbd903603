// A mission file to begin with: every key explained, made for the files that it names.

#include "battery/battery.h"
#include "battery/battery_toml.h"
#include "cli/output/mission_output.h"
#include "cli/stage.h"
#include "compute/profile_reader.h"
#include "mission/mission_file.h"
#include "mission/new_mission_toml.h"
#include "stages.h"

#include <algorithm>
#include <filesystem>

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
    bool is_planned = false;
    std::optional<std::string> name;
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

int write_new_mission(const cli::StageCall& call, const NewMissionArguments& arguments) {
    const auto mechanical = required_file(arguments.model, "model", "batch");
    const auto pack = required_file(arguments.battery, "battery", "battery");
    const std::filesystem::path file = call.output.value_or("mission.toml");
    std::error_code none;
    if (call.output && std::filesystem::exists(file, none)) {
        throw OutputError(fmt::format("{} is there already and stays as it is: give another name", file.string()));
    }
    const auto folder = std::filesystem::absolute(file).parent_path();
    mission::NewMission fresh;
    fresh.name = arguments.name.value_or(file.stem().string());
    fresh.mechanical = named_from(folder, mechanical);
    fresh.model = mechanical::read_mechanical_model(mechanical);
    fresh.battery = named_from(folder, pack);
    fresh.pack = battery::read_battery(pack);
    fresh.is_planned = arguments.is_planned;
    compute::ProfileNaming naming;
    naming.where.file = "new-mission --parameters A,B";
    if (arguments.parameters) boost::algorithm::split(naming.parameters, *arguments.parameters, boost::is_any_of(","));
    for (const auto& profile : arguments.profiles) {
        fresh.components.push_back({component_name(profile, fresh.components), named_from(folder, profile),
                                    compute::read_power_profile(profile, naming)});
    }
    if (fresh.is_planned && fresh.components.empty()) {
        throw UsageError("--plan: expected --profile FILE of the software whose schedule is to be planned");
    }
    auto text = new_mission_toml(fresh);
    if (arguments.parameters) boost::algorithm::replace_all(text, "\n#parameters = [", "\nparameters = [");
    const auto read = mission::parse_mission(text, file, {.allow_unplanned = fresh.is_planned});
    cli::write_result(call, text);
    cli::warn_of_setup(call, setup_of(read));
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
component runs at the middle of what was profiled, and 20 % of charge are kept in reserve. It contains every other key of a
mission as a comment, with its meaning and an example. An existing file is not replaced.)"};
    stage.next = [](const auto& call) { return call.has("plan") ? "flightwatt plan {}" : "flightwatt simulate {}"; };
    stage.json_schema = cli::document_schema<NewMissionOutput>;
    stage.min_inputs = 0;
    stage.max_inputs = 0;
    stage.output_help = "write the mission to FILE, which names its files relative to it";
    stage.examples = {"flightwatt new-mission --model model.toml --battery pack.toml -o first.toml",
                      "flightwatt new-mission --model model.toml --battery pack.toml --profile dnn.csv --plan"};
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
    options.add("plan", arguments.is_planned,
                "leave the schedule to flightwatt plan: utilities and [plan] instead of [[schedule]]");
    options.add("name", arguments.name, {.value = "NAME"}, "the mission's name; default: FILE's");
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return write_new_mission(call, arguments); });
}
