#include "mission/file/schedule_toml.h"

#include "base/number.h"
#include "base/units.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

std::string spell(flight::Phase phase, double start_s, double end_s) {
    return fmt::format("{} from {} s to {} s", to_string(phase), start_s, end_s);
}

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
    const auto segment = spell(*entry.phase, entry.start_s, entry.end_s);
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

ScheduleEntry read_entry(const TomlTable& table, const compute::ComputeModel& compute,
                         const flight::PerPhase<double>& duration_s) {
    table.refuse_keys_except({"phase", "from", "to", "middle", "otherwise", "run"});
    ScheduleEntry entry;
    entry.where = table.where();
    entry.otherwise = table.optional_boolean("otherwise").value_or(false);
    if (table.has("otherwise") && !entry.otherwise) {
        throw InputError(table.where("otherwise"), "`otherwise = false` says nothing", "leave it out");
    }
    if (table.has("phase")) entry.phase = read_flown_phase(table, duration_s);
    if (!entry.phase && !entry.otherwise) {
        throw InputError(entry.where, "this entry does not say when",
                         "give it a phase, or `otherwise = true` for whatever the others leave");
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

/// An `otherwise`, and whether it found anything to cover.
struct Filler {
    const ScheduleEntry* entry = nullptr;
    bool used = false;
};

struct Fillers {
    flight::PerPhase<Filler> of_phase;
    Filler of_mission;
};

Fillers find_fillers(const std::vector<ScheduleEntry>& entries) {
    Fillers fillers;
    for (const auto& entry : entries) {
        if (!entry.otherwise) continue;
        auto& filler = entry.phase ? fillers.of_phase[*entry.phase] : fillers.of_mission;
        if (filler.entry != nullptr) {
            throw InputError(entry.where,
                             fmt::format("a second `otherwise` for {}, the first is in line {}",
                                         entry.phase ? to_string(*entry.phase) : "the whole mission",
                                         filler.entry->where.line),
                             "keep one of them");
        }
        filler.entry = &entry;
    }
    return fillers;
}

void refuse_unused(const Filler& filler) {
    if (filler.entry == nullptr || filler.used) return;
    throw InputError(filler.entry->where, "this `otherwise` covers nothing: the other entries leave no time",
                     "take it out");
}

[[noreturn]] void refuse_overlap(const ScheduleEntry& first, const ScheduleEntry& second) {
    const bool in_order = first.where.line <= second.where.line;
    const auto& later = in_order ? second : first;
    const auto& earlier = in_order ? first : second;
    const bool whole = first.whole_phase || second.whole_phase;
    throw InputError(
        later.where,
        fmt::format(
            "{} is scheduled twice, here and in line {}",
            spell(*first.phase, std::max(first.start_s, second.start_s), std::min(first.end_s, second.end_s)),
            earlier.where.line),
        whole ? "give the entry of the whole phase `otherwise = true`, and it takes what the others leave"
              : "let one end where the other begins");
}

[[noreturn]] void refuse_gap(const ScheduleSegment& gap, const ScheduleEntry& near) {
    throw InputError(near.where,
                     fmt::format("nothing is scheduled for {}", spell(gap.phase, gap.start_s, gap.end_s)),
                     "add an entry with `otherwise = true`; `run = {}` runs nothing");
}

std::vector<const ScheduleEntry*> explicit_entries(const std::vector<ScheduleEntry>& entries,
                                                   flight::Phase phase) {
    std::vector<const ScheduleEntry*> found;
    for (const auto& entry : entries) {
        if (!entry.otherwise && entry.phase == phase) found.push_back(&entry);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto* a, const auto* b) { return a->start_s < b->start_s; });
    return found;
}

void refuse_overlaps(const std::vector<ScheduleEntry>& entries, flight::Phase phase, double tolerance_s) {
    const auto sorted = explicit_entries(entries, phase);
    for (std::size_t i = 1; i < sorted.size(); ++i) {
        if (sorted[i]->start_s < sorted[i - 1]->end_s - tolerance_s)
            refuse_overlap(*sorted[i - 1], *sorted[i]);
    }
}

/// Appends the segments of one phase, whose explicit entries do not overlap.
void resolve_phase(const std::vector<ScheduleEntry>& entries, flight::Phase phase, double duration_s,
                   Fillers& fillers, std::vector<ScheduleSegment>& segments) {
    const double tolerance_s = same_time_tolerance_s(duration_s);
    double covered_s = 0.0;
    const ScheduleEntry* previous = nullptr;
    const auto fill_until = [&](double until_s, const ScheduleEntry& near) {
        ScheduleSegment gap{phase, covered_s, until_s, {}};
        auto& own = fillers.of_phase[phase];
        auto& filler = own.entry != nullptr ? own : fillers.of_mission;
        if (filler.entry == nullptr) refuse_gap(gap, near);
        gap.run = filler.entry->run;
        filler.used = true;
        segments.push_back(std::move(gap));
        covered_s = until_s;
    };
    for (const auto* entry : explicit_entries(entries, phase)) {
        if (entry->start_s > covered_s + tolerance_s) fill_until(entry->start_s, *entry);
        const double end_s = entry->end_s >= duration_s - tolerance_s ? duration_s : entry->end_s;
        segments.push_back({phase, covered_s, end_s, entry->run});
        covered_s = end_s;
        previous = entry;
    }
    if (covered_s < duration_s - tolerance_s) {
        fill_until(duration_s, previous != nullptr ? *previous : entries.back());
    }
}

}  // namespace

flight::Phase read_flown_phase(const TomlTable& entry, const flight::PerPhase<double>& duration_s) {
    const auto name = entry.string("phase");
    const auto phase = flight::phase_from(name);
    if (!phase) {
        throw InputError(entry.where("phase"), fmt::format("there is no phase '{}'", name),
                         "the phases are takeoff, cruise and landing");
    }
    if (duration_s[*phase] > 0.0) return *phase;
    throw InputError(entry.where("phase"), fmt::format("{} takes no time in this mission", name));
}

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

std::vector<ScheduleSegment> resolve_schedule(const std::vector<ScheduleEntry>& entries,
                                              const flight::PerPhase<double>& duration_s) {
    if (entries.empty()) throw std::invalid_argument("a schedule has at least one entry");
    auto fillers = find_fillers(entries);
    for (const auto phase : flight::all_phases) {
        refuse_overlaps(entries, phase, same_time_tolerance_s(duration_s[phase]));
    }
    std::vector<ScheduleSegment> segments;
    for (const auto phase : flight::all_phases) {
        if (duration_s[phase] > 0.0) resolve_phase(entries, phase, duration_s[phase], fillers, segments);
    }
    for (const auto& filler : fillers.of_phase.values) refuse_unused(filler);
    refuse_unused(fillers.of_mission);
    return segments;
}

std::vector<ScheduleSegment> resolve_fixed_segments(const std::vector<ScheduleEntry>& entries,
                                                    const flight::PerPhase<double>& duration_s) {
    for (const auto& entry : entries) {
        if (!entry.otherwise) continue;
        throw InputError(entry.where, "`otherwise` leaves nothing to plan",
                         "take it out: what no other entry fixes is planned");
    }
    std::vector<ScheduleSegment> segments;
    for (const auto phase : flight::all_phases) {
        const double tolerance_s = same_time_tolerance_s(duration_s[phase]);
        refuse_overlaps(entries, phase, tolerance_s);
        double covered_s = 0.0;
        for (const auto* entry : explicit_entries(entries, phase)) {
            const double start_s = entry->start_s > covered_s + tolerance_s ? entry->start_s : covered_s;
            const double end_s =
                entry->end_s >= duration_s[phase] - tolerance_s ? duration_s[phase] : entry->end_s;
            segments.push_back({phase, start_s, end_s, entry->run});
            covered_s = end_s;
        }
    }
    return segments;
}

}  // namespace flightwatt::mission
