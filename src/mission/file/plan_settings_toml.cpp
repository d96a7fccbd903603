#include "mission/file/plan_settings_toml.h"

#include "base/toml_numbers.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

std::size_t component_index(const compute::ComputeModel& compute, const std::string& name,
                            const Location& where) {
    std::vector<std::string> known;
    for (std::size_t i = 0; i < compute.components.size(); ++i) {
        if (compute.components[i].name == name) return i;
        known.push_back(compute.components[i].name);
    }
    throw InputError(where, fmt::format("there is no component '{}'", name),
                     fmt::format("the components are {}", fmt::join(known, ", ")));
}

void read_levels(const TomlTable& levels, const compute::PowerProfile& profile, ComponentChoices& choices) {
    for (std::size_t i = 0; i < profile.parameters.size(); ++i) {
        const auto& parameter = profile.parameters[i];
        if (!levels.has(parameter)) continue;
        auto values = levels.numbers(parameter);
        if (values.empty()) {
            throw InputError(levels.where(parameter), fmt::format("{} = [] leaves no choice", parameter),
                             "leave it out for the levels that were profiled");
        }
        for (const double value : values) require_in_range(profile, i, value, levels.where(parameter));
        std::sort(values.begin(), values.end());
        values.erase(std::unique(values.begin(), values.end()), values.end());
        choices.levels[i] = std::move(values);
    }
    levels.refuse_unknown_keys();
}

}  // namespace

PlanSettings read_plan_settings(const TomlTable& mission, const compute::ComputeModel& compute) {
    PlanSettings settings;
    for (const auto& component : compute.components) settings.choices.push_back({component.profile.axes});
    const auto plan = mission.optional_table("plan");
    if (!plan) return settings;
    plan->refuse_keys_except({"slot_s", "dwell_s", "may_be_off", "levels"});
    settings.slot_s = number_in_or(more_than(0.0), *plan, "slot_s", settings.slot_s);
    settings.dwell_s = number_in_or(at_least(0.0), *plan, "dwell_s", settings.dwell_s);
    if (plan->has("may_be_off")) {
        for (const auto& name : plan->strings("may_be_off")) {
            settings.choices[component_index(compute, name, plan->where("may_be_off"))].may_be_off = true;
        }
    }
    if (const auto levels = plan->optional_table("levels")) {
        for (const auto& name : levels->keys()) {
            const auto i = component_index(compute, name, levels->where(name));
            read_levels(levels->table(name), compute.components[i].profile, settings.choices[i]);
        }
    }
    return settings;
}

}  // namespace flightwatt::mission
