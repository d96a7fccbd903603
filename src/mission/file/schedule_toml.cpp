#include "mission/file/schedule_toml.h"

#include "base/number.h"
#include "base/units.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

/// The number before the '%' of "40 %".
double percent_in(const TomlTable& entry, std::string_view key) {
    const auto text = entry.string(key);
    std::string_view number = text;
    const bool is_percent = !number.empty() && number.back() == '%';
    if (is_percent) number.remove_suffix(1);
    while (!number.empty() && number.back() == ' ') number.remove_suffix(1);
    const auto value = parse_number(number);
    if (!is_percent || !value) {
        throw InputError(
            entry.where(key), fmt::format("{} = \"{}\" is no time in a phase", key, text),
            fmt::format("write seconds ({} = 240) or percent of the phase ({} = \"40 %\")", key, key));
    }
    return *value;
}

void read_segment(const TomlTable& table, double duration_s, ScheduleEntry& entry) {
    const bool has_from = table.has("from");
    const bool has_to = table.has("to");
    const bool has_middle = table.has("middle");
    entry.whole_phase = !has_from && !has_to && !has_middle;
    entry.start_s = has_from ? read_time_s(table, "from", duration_s) : 0.0;
    entry.end_s = has_to ? read_time_s(table, "to", duration_s) : duration_s;
    if (has_middle) {
        if (has_from || has_to) {
            throw InputError(table.where("middle"), "`middle` stands with `from` or `to`",
                             "use one way of saying when");
        }
        const double length_s = read_time_s(table, "middle", duration_s);
        entry.start_s = (duration_s - length_s) / 2.0;
        entry.end_s = (duration_s + length_s) / 2.0;
    }
    const std::string_view key = has_middle ? "middle" : has_from ? "from" : has_to ? "to" : "phase";
    const double tolerance_s = same_time_tolerance_s(duration_s);
    const auto segment =
        fmt::format("{} from {} s to {} s", to_string(*entry.phase), entry.start_s, entry.end_s);
    if (entry.end_s - entry.start_s <= tolerance_s) {
        throw InputError(table.where(key), fmt::format("the segment {} is empty", segment),
                         "it must start before it ends");
    }
    if (entry.start_s < -tolerance_s || entry.end_s > duration_s + tolerance_s) {
        throw InputError(table.where(key), fmt::format("the segment {} is not within the phase", segment),
                         fmt::format("it takes {} s in this mission", duration_s));
    }
}

/// Before a parameter is missed: the key that is there, and wrong, is what the user has to find.
void refuse_unknown_parameters(const TomlTable& given, const std::string& component,
                               const compute::PowerProfile& profile) {
    const auto& known = profile.parameters;
    for (const auto& key : given.keys()) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        const auto near = nearest_word(key, known);
        throw InputError(given.where(key), fmt::format("{} has no parameter '{}'", component, key),
                         !near.empty()   ? fmt::format("did you mean '{}'?", near)
                         : known.empty() ? "it has none"
                                         : fmt::format("its parameters are {}", fmt::join(known, ", ")));
    }
}

compute::RunningComponent read_running(const TomlTable& run, const std::string& name, std::size_t index,
                                       const compute::PowerProfile& profile) {
    const auto given = run.table(name);
    refuse_unknown_parameters(given, name, profile);
    compute::RunningComponent running{index, {}};
    for (std::size_t i = 0; i < profile.parameters.size(); ++i) {
        const auto& parameter = profile.parameters[i];
        const double value = given.number(parameter);
        require_in_range(profile, i, value, given.where(parameter));
        running.qos.push_back(value);
    }
    return running;
}

compute::Configuration read_run(const TomlTable& run, const compute::ComputeModel& compute) {
    std::vector<std::string> known;
    for (const auto& component : compute.components) known.push_back(component.name);
    for (const auto& name : run.keys()) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        const auto near = nearest_word(name, known);
        throw InputError(run.where(name), fmt::format("there is no component '{}'", name),
                         !near.empty()   ? fmt::format("did you mean '{}'?", near)
                         : known.empty() ? "the mission has no [components.NAME]"
                                         : fmt::format("the components are {}", fmt::join(known, ", ")));
    }
    // In the model's order, not the file's: sums of power are then the same however a mission is written.
    compute::Configuration configuration;
    for (std::size_t i = 0; i < known.size(); ++i) {
        if (run.has(known[i])) {
            configuration.push_back(read_running(run, known[i], i, compute.components[i].profile));
        }
    }
    return configuration;
}

flight::Phase read_phase(const TomlTable& table) {
    const auto name = table.string("phase");
    if (const auto phase = flight::phase_from(name)) return *phase;
    throw InputError(table.where("phase"), fmt::format("there is no phase '{}'", name),
                     "the phases are takeoff, cruise and landing");
}

ScheduleEntry read_entry(const TomlTable& table, const compute::ComputeModel& compute,
                         const flight::PerPhase<double>& duration_s) {
    table.refuse_keys_except({"phase", "from", "to", "middle", "otherwise", "run"});
    ScheduleEntry entry;
    entry.where = table.where();
    entry.otherwise = table.optional_boolean("otherwise").value_or(false);
    if (table.has("otherwise") && !entry.otherwise) {
        throw InputError(table.where("otherwise"), "`otherwise = false` says nothing", "leave it out");
    }
    if (table.has("phase")) entry.phase = read_phase(table);
    if (!entry.phase && !entry.otherwise) {
        throw InputError(entry.where, "this entry does not say when",
                         "give it a phase, or `otherwise = true` for whatever the others leave");
    }
    if (entry.phase && duration_s[*entry.phase] == 0.0) {
        throw InputError(table.where("phase"),
                         fmt::format("{} takes no time in this mission", to_string(*entry.phase)));
    }
    if (entry.phase && !entry.otherwise) read_segment(table, duration_s[*entry.phase], entry);
    for (const std::string_view key : {"from", "to", "middle"}) {
        if (entry.otherwise && table.has(key)) {
            throw InputError(table.where(key), fmt::format("`{}` stands with `otherwise`", key),
                             "`otherwise` is what is left; leave one of them out");
        }
    }
    entry.run = read_run(table.table("run"), compute);
    return entry;
}

}  // namespace

double read_time_s(const TomlTable& entry, std::string_view key, double duration_s) {
    return entry.is_number(key) ? entry.number(key) : units::part_of(duration_s, percent_in(entry, key));
}

std::vector<ScheduleEntry> read_schedule(const TomlTable& mission, const compute::ComputeModel& compute,
                                         const flight::PerPhase<double>& duration_s) {
    std::vector<ScheduleEntry> entries;
    for (const auto& table : mission.tables("schedule")) {
        entries.push_back(read_entry(table, compute, duration_s));
    }
    return entries;
}

}  // namespace flightwatt::mission
