#include "mission/file/planning_toml.h"

#include "battery/battery_toml.h"

#include <algorithm>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

std::optional<std::size_t> read_parameter(const TomlTable& table, const compute::PowerProfile& profile) {
    const auto& known = profile.parameters;
    const auto name = table.optional_string("parameter");
    if (!name) {
        if (known.empty()) return std::nullopt;
        if (known.size() == 1) return 0;
        throw InputError(table.where(),
                         fmt::format("the profile has {} parameters: which one has the utility?", known.size()),
                         fmt::format("add parameter = ..., one of {}", fmt::join(known, ", ")));
    }
    const auto found = std::ranges::find(known, *name);
    if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
    throw InputError(table.where("parameter"), fmt::format("the profile has no parameter '{}'", *name),
                     known.empty() ? "it has none: leave `parameter` out"
                                   : fmt::format("its parameters are {}", fmt::join(known, ", ")));
}

UtilityShape read_shape(const TomlTable& table) {
    const auto name = table.optional_string("shape").value_or("linear");
    if (name == "linear") return UtilityShape::linear;
    if (name == "sqrt") return UtilityShape::square_root;
    if (name == "log") return UtilityShape::logarithm;
    if (name == "points") return UtilityShape::points;
    throw InputError(table.where("shape"), fmt::format("there is no shape '{}'", name),
                     R"(it is "linear", "sqrt", "log" or "points")");
}

void require_defined(const TomlTable& table, UtilityShape shape, double min_qos) {
    const bool defined = shape == UtilityShape::square_root ? min_qos >= 0.0
                         : shape == UtilityShape::logarithm ? min_qos > -1.0
                                                            : true;
    if (defined) return;
    throw InputError(table.where("shape"),
                     fmt::format("this shape has no value at {}, where the profile begins", min_qos),
                     R"(use "linear" or "points")");
}

/// The key of the points' values; files of version 0.1 call it `worth`.
std::string_view value_key(const TomlTable& table) { return table.has("worth") ? "worth" : "value"; }

void read_points(const TomlTable& table, const std::vector<double>& axis, Utility& utility) {
    const auto value = value_key(table);
    utility.points_qos = table.numbers("qos");
    utility.points_value = table.numbers(value);
    const auto& x = utility.points_qos;
    const auto& y = utility.points_value;
    if (x.size() < 2 || x.size() != y.size()) {
        throw InputError(table.where(value),
                         fmt::format("{} numbers of qos and {} of {} are no points", x.size(), y.size(), value),
                         "give as many of each, 2 or more");
    }
    if (std::ranges::adjacent_find(x, std::greater_equal<>()) != x.end())
        throw InputError(table.where("qos"), "the values of qos do not rise");
    if (!std::ranges::is_sorted(y)) {
        throw InputError(table.where(value), fmt::format("{} falls: better quality cannot have less utility", value),
                         "the numbers must not fall");
    }
    if (x.front() > axis.front() || x.back() < axis.back()) {
        throw InputError(table.where("qos"),
                         fmt::format("the points from {} to {} do not cover the profile's range, {} to {}", x.front(),
                                     x.back(), axis.front(), axis.back()),
                         "add points at its ends");
    }
}

std::size_t component_index(const compute::ComputeModel& compute, const std::string& name, const Location& where) {
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
        std::ranges::sort(values);
        values.erase(std::unique(values.begin(), values.end()), values.end());
        choices.levels[i] = std::move(values);
    }
    levels.refuse_unknown_keys();
}

}  // namespace

std::optional<Packs> read_packs(const TomlTable& mission) {
    constexpr double most_packs = 1000.0;
    constexpr double max_change_s = 1e6;
    const auto table = mission.optional_table("packs", "{ count = 3, change_s = 300 }");
    if (!table) return std::nullopt;
    table->refuse_keys_except({"count", "change_s", "home", "battery"});
    Packs packs;
    packs.count = count_in(*table, "count", 1);
    require_in(at_most(most_packs), static_cast<double>(packs.count), "count", table->where("count"));
    packs.change_s = number_in(between(0.0, max_change_s), *table, "change_s");
    if (table->has("home") && !mission.has("path"))
        throw InputError(table->where("home"), "home belongs to a [path]", "leave it out, or add one");
    if (!table->has("battery")) return packs;
    for (const auto& name : table->strings("battery"))
        packs.batteries.push_back(battery::read_battery(std::filesystem::path(table->file()).parent_path() / name));
    if (packs.batteries.size() != packs.count)
        throw InputError(table->where("battery"),
                         fmt::format("{} batteries for {} packs", packs.batteries.size(), packs.count),
                         "give one for each pack, in the order of the flights");
    if (mission.has("capacity_ah"))
        throw InputError(mission.where("capacity_ah"), "capacity_ah, and [packs] has batteries of their own",
                         "leave one of them out");
    return packs;
}

Utility read_utility(const TomlTable& table, const compute::PowerProfile& profile) {
    table.refuse_keys_except({"parameter", "weight", "shape", "qos", "value", "worth"});
    Utility utility;
    utility.parameter = read_parameter(table, profile);
    utility.weight = number_in_or(at_least(0.0), table, "weight", 1.0);
    if (table.has("value") && table.has("worth")) {
        throw InputError(table.where("worth"), "`worth` is the older name of `value`, and both are there",
                         "remove `worth`");
    }
    utility.shape = read_shape(table);
    const bool has_points = utility.shape == UtilityShape::points;
    for (const std::string_view key : {"shape", "qos", "value", "worth"}) {
        if (!table.has(key) || (utility.parameter && (has_points || key == "shape"))) continue;
        throw InputError(
            table.where(key), fmt::format("`{}` has no meaning here", key),
            utility.parameter ? R"(it belongs to shape = "points")" : "the profile has no parameter: leave it out");
    }
    if (!utility.parameter) return utility;
    const auto& axis = profile.axes[*utility.parameter];
    require_defined(table, utility.shape, axis.front());
    if (has_points) read_points(table, axis, utility);
    return utility;
}

PlanSettings read_plan_settings(const TomlTable& mission, const compute::ComputeModel& compute) {
    PlanSettings settings;
    for (const auto& component : compute.components) settings.choices.push_back({component.profile.axes});
    const auto plan = mission.optional_table("plan");
    if (!plan) return settings;
    plan->refuse_keys_except({"slot_s", "dwell_s", "may_be_off", "levels"});
    settings.slot_s = number_in_or(more_than(0.0), *plan, "slot_s", settings.slot_s);
    settings.dwell_s = number_in_or(at_least(0.0), *plan, "dwell_s", settings.dwell_s);
    if (plan->has("may_be_off"))
        for (const auto& name : plan->strings("may_be_off"))
            settings.choices[component_index(compute, name, plan->where("may_be_off"))].may_be_off = true;
    if (const auto levels = plan->optional_table("levels")) {
        for (const auto& name : levels->keys()) {
            const auto i = component_index(compute, name, levels->where(name));
            read_levels(levels->table(name), compute.components[i].profile, settings.choices[i]);
        }
    }
    return settings;
}

std::optional<AdaptivePolicy> read_adaptive_policy(const TomlTable& mission) {
    const auto policy = mission.optional_table("policy");
    if (!policy) return std::nullopt;
    policy->refuse_keys_except({"kind", "decide_every_s", "mechanical_sd_percent", "learning_time_s", "probability"});
    const auto kind = policy->string("kind");
    if (kind == "static") {
        for (const auto& key : policy->keys()) {
            if (key == "kind") continue;
            throw InputError(policy->where(key), fmt::format("`{}` has no meaning with kind = \"static\"", key),
                             "leave it out, or make it kind = \"adaptive\"");
        }
        return std::nullopt;
    }
    if (kind != "adaptive") {
        throw InputError(policy->where("kind"), fmt::format("there is no policy '{}'", kind),
                         "it is \"adaptive\" or \"static\"");
    }
    AdaptivePolicy read;
    read.decide_every_s = number_in_or(between(0.1, 1e6), *policy, "decide_every_s", 0.0);
    read.mechanical_sd_percent = optional_number_in(between(0.0, 100.0), *policy, "mechanical_sd_percent");
    read.learning_time_s = number_in_or(between(0.0, 1e6), *policy, "learning_time_s", read.learning_time_s);
    read.probability = number_in_or(between(0.5, 0.999999), *policy, "probability", read.probability);
    return read;
}

}  // namespace flightwatt::mission
