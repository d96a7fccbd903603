#include "compute/profile_specification.h"

#include "base/atomic_file.h"
#include "base/toml_reader.h"
#include "compute/compute_model.h"

#include <algorithm>
#include <cctype>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

/// A component before its ranges are multiplied out.
struct WrittenComponent {
    std::string name;
    std::vector<std::string> command;
    std::vector<QosRange> ranges;
    ProfileTiming timing;
    bool alone = true;
    Location where;
};

/// Names become those of files, columns and TOML keys.
void refuse_bad_name(const std::string& name, std::string_view also, const Location& where) {
    const auto is_good = [&](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || also.find(c) != std::string_view::npos;
    };
    if (!name.empty() && std::ranges::all_of(name, is_good) && name.front() != '.') return;
    throw InputError(where, fmt::format("'{}' cannot be the name of a file and a column", name),
                     fmt::format("use letters, digits and {}", also));
}

ProfileTiming timing_from(const TomlTable& table, const ProfileTiming& fallback) {
    ProfileTiming timing = fallback;
    if (table.has("duration_s")) timing.duration_s = number_in(more_than(0.0), table, "duration_s");
    timing.warm_up_s = number_in_or(at_least(0.0), table, "warm_up_s", fallback.warm_up_s);
    timing.timeout_s = number_in_or(more_than(0.0), table, "timeout_s", fallback.timeout_s);
    const double min_s = timing.warm_up_s + timing.duration_s.value_or(0.0);
    if (timing.timeout_s <= min_s && table.has("timeout_s")) {
        throw InputError(
            table.where("timeout_s"),
            fmt::format("timeout_s = {} is over before warm-up and duration, {} s", timing.timeout_s, min_s));
    }
    return timing;
}

std::vector<double> values_from(const TomlTable& ranges, const std::string& name) {
    if (!ranges.is_table(name)) return ranges.numbers(name);
    const auto range = ranges.table(name);
    range.refuse_keys_except({"values", "from", "to", "step"});
    if (range.has("values")) {
        if (range.has("from") || range.has("to") || range.has("step")) {
            throw InputError(range.where(), fmt::format("{} has values and a range", name), "keep one of them");
        }
        return range.numbers("values");
    }
    const double from = range.number("from");
    const double to = number_in(at_least(from), range, "to");
    const double step = number_in(more_than(0.0), range, "step");
    if ((to - from) / step > static_cast<double>(max_configurations)) {
        throw InputError(range.where("step"), fmt::format("step = {} makes too many values", step));
    }
    return linear_range(from, to, step);
}

std::vector<QosRange> ranges_from(const TomlTable& component) {
    std::vector<QosRange> ranges;
    const auto table = component.optional_table("qos");
    if (!table) return ranges;
    for (const auto& name : table->keys()) {
        const auto where = table->where(name);
        refuse_bad_name(name, "_", where);
        if (name == "component") {
            throw InputError(where, "a parameter is called 'component', the placeholder of the component's name");
        }
        QosRange range{name, values_from(*table, name)};
        if (range.values.empty()) throw InputError(where, fmt::format("{} has no values", name));
        std::ranges::sort(range.values);
        if (std::ranges::adjacent_find(range.values) != range.values.end()) {
            throw InputError(where, fmt::format("{} has a value twice", name));
        }
        ranges.push_back(std::move(range));
    }
    return ranges;
}

void require_use_of_parameters(const WrittenComponent& component) {
    const auto line = fmt::format("{}", fmt::join(component.command, " "));
    for (const auto& range : component.ranges) {
        if (line.find("{" + range.name + "}") != std::string::npos) continue;
        throw InputError(component.where,
                         fmt::format("the command of {} does not use its parameter {}", component.name, range.name),
                         fmt::format("write {{{}}} where its value belongs", range.name));
    }
}

WrittenComponent component_from(const TomlTable& table, const std::string& name, const Location& where,
                                const ProfileSpecification& specification, const ProfileTiming& timing) {
    refuse_bad_name(name, "_-+.", where);
    if (name == "idle" || name == "runs") {
        throw InputError(where, fmt::format("a component is called '{}', as a file of the results is", name));
    }
    WrittenComponent component{name, {}, ranges_from(table), timing_from(table, timing), true, where};
    component.alone = table.optional_boolean("alone").value_or(true);
    const bool has_command = table.has("command");
    table.refuse_unknown_keys();
    if (!has_command && specification.sampler.kind == SamplerKind::recorded) return component;
    component.command = table.strings("command");
    component.where = table.where("command");
    if (component.command.empty() || component.command.front().empty()) {
        throw InputError(component.where, "an empty command, expected a program and its arguments");
    }
    require_use_of_parameters(component);
    return component;
}

ProfiledComponent multiplied_out(const std::string& name, const std::vector<WrittenComponent>& parts,
                                 const ProfileTiming& timing, const SamplerSettings& sampler, const Location& where) {
    std::vector<QosRange> ranges;
    for (const auto& part : parts) ranges.insert(ranges.end(), part.ranges.begin(), part.ranges.end());
    ProfiledComponent component{name, {}, {}, timing};
    double count = 1.0;
    for (const auto& range : ranges) {
        if (std::ranges::find(component.parameters, range.name) != component.parameters.end()) {
            throw InputError(where, fmt::format("two components of {} have a parameter {}", name, range.name),
                             "call one of them differently");
        }
        component.parameters.push_back(range.name);
        count *= static_cast<double>(range.values.size());
    }
    if (count > static_cast<double>(max_configurations)) {
        throw InputError(where, fmt::format("{} has {} configurations", name, count), "profile fewer values");
    }
    for (auto& qos : cartesian_product(ranges)) {
        ProfiledConfiguration configuration;
        for (const auto& part : parts) {
            std::vector<std::string> words;
            for (const auto& word : part.command) words.push_back(substitute_qos(word, component.parameters, qos));
            configuration.commands.push_back(std::move(words));
        }
        if (sampler.kind == SamplerKind::recorded) {
            auto file = substitute_qos(sampler.file, component.parameters, qos);
            constexpr std::string_view placeholder = "{component}";
            const auto at = file.find(placeholder);
            if (at != std::string::npos) file.replace(at, placeholder.size(), name);
            configuration.recording = sampler.folder / file;
        }
        configuration.qos = std::move(qos);
        component.configurations.push_back(std::move(configuration));
    }
    return component;
}

void require_recorded_file(const TomlTable& table, const std::vector<ProfiledComponent>& components) {
    std::set<std::filesystem::path> seen;
    for (const auto& component : components) {
        for (const auto& configuration : component.configurations) {
            if (seen.insert(configuration.recording).second) continue;
            throw InputError(
                table.where("file"),
                fmt::format("several configurations have the recording {}", configuration.recording.string()),
                "name the file by {component} and every {parameter}");
        }
    }
}

void add_together(const TomlTable& root, const std::vector<WrittenComponent>& written, const ProfileTiming& timing,
                  ProfileSpecification& specification) {
    for (const auto& group : root.tables("together")) {
        const auto names = group.strings("components");
        const auto where = group.where("components");
        if (names.size() < 2) throw InputError(where, "fewer than two components cannot run together");
        std::vector<WrittenComponent> parts;
        for (const auto& name : names) {
            const auto found = std::ranges::find(written, name, &WrittenComponent::name);
            if (found == written.end()) {
                throw InputError(where, fmt::format("there is no component '{}'", name));
            }
            parts.push_back(*found);
        }
        const auto name = group.optional_string("name").value_or(fmt::format("{}", fmt::join(names, "+")));
        refuse_bad_name(name, "_-+.", where);
        auto& components = specification.components;
        if (std::ranges::find(components, name, &ProfiledComponent::name) != components.end()) {
            throw InputError(where, fmt::format("a second '{}'", name));
        }
        components.push_back(multiplied_out(name, parts, timing_from(group, timing), specification.sampler, where));
        group.refuse_unknown_keys();
    }
}

}  // namespace

ProfileSpecification parse_profile_specification(std::string_view text, const std::filesystem::path& path) {
    const auto root = parse_toml(text, path.string(), FileKind::specification);
    require_known_format(root);
    ProfileSpecification specification;
    specification.file = path.string();
    specification.sampler = read_sampler_settings(root, path.parent_path());
    const auto timing = timing_from(root, {});
    specification.repeats = count_in_or(root, "repeats", 1, 1);
    specification.seed = count_in_or(root, "seed", 0, 1);
    specification.idle_s = number_in_or(at_least(0.0), root, "idle_s", specification.idle_s);
    specification.above_idle = root.optional_boolean("above_idle").value_or(false);
    const auto components = root.table("components");
    std::vector<WrittenComponent> written;
    for (const auto& name : components.keys()) {
        written.push_back(component_from(components.table(name), name, components.where(name), specification, timing));
        const auto& last = written.back();
        if (!last.alone) continue;
        specification.components.push_back(
            multiplied_out(name, {last}, last.timing, specification.sampler, last.where));
    }
    add_together(root, written, timing, specification);
    root.refuse_unknown_keys();
    if (specification.components.empty()) throw InputError(components.where(), "there is nothing to profile");
    if (specification.sampler.kind == SamplerKind::recorded) {
        require_recorded_file(root.table("sampler"), specification.components);
        if (specification.sampler.idle_file.empty()) specification.idle_s = 0.0;
    }
    if (specification.above_idle && specification.idle_s == 0.0) {
        throw InputError({specification.file}, "power above idle is asked for, and idle power is not measured",
                         "set idle_s, or idle_file of recordings");
    }
    return specification;
}

ProfileSpecification read_profile_specification(const std::filesystem::path& path) {
    if (path.extension() == ".cfg")
        throw InputError({path.string()}, "is a file of powprofiler, expected TOML",
                         "a mission reads its recordings: profile = FILE.cfg; programs to run are [components.NAME]");
    return parse_profile_specification(read_file(path), path);
}

}  // namespace flightwatt::compute
