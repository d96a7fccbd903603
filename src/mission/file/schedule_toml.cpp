#include "mission/file/schedule_toml.h"

#include "base/number.h"
#include "base/units.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

std::string spell(Phase phase, double start_s, double end_s) {
    return fmt::format("{} from {:.6g} s to {:.6g} s", phase_word(phase), start_s, end_s);
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
        throw InputError(entry.where(key), fmt::format("{} = \"{}\" is no time in a phase", key, text),
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
            throw InputError(table.where("middle"), "`middle` is given with `from` or `to`",
                             "state the time in one way");
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
                         fmt::format("it takes {:.6g} s in this mission", duration_s));
    }
}

/// Throws at the first unknown key, before a missing one is reported. `what` begins the message, `of_none` and
/// `of_known` the hint.
void refuse_unknown_names(const TomlTable& table, const std::vector<std::string>& known, const std::string& what,
                          std::string_view of_none, std::string_view of_known) {
    for (const auto& key : table.keys()) {
        if (std::ranges::find(known, key) != known.end()) continue;
        const auto all = known.empty() ? std::string(of_none) : fmt::format("{} {}", of_known, fmt::join(known, ", "));
        throw InputError(table.where(key), fmt::format("{} '{}'", what, key), meant_or(key, known, all));
    }
}

compute::RunningComponent read_running(const TomlTable& run, const std::string& name, std::size_t index,
                                       const compute::PowerProfile& profile) {
    const auto given = run.table(name);
    refuse_unknown_names(given, profile.parameters, name + " has no parameter", "it has none", "its parameters are");
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
    refuse_unknown_names(run, known, "there is no component", "the mission has no [components.NAME]",
                         "the components are");
    // In the model's order, not the file's: sums of power are then the same however a mission is written.
    compute::Configuration configuration;
    for (std::size_t i = 0; i < known.size(); ++i)
        if (run.has(known[i])) configuration.push_back(read_running(run, known[i], i, compute.components[i].profile));
    return configuration;
}

ScheduleEntry read_entry(const TomlTable& table, const compute::ComputeModel& compute,
                         const PerPhase<double>& duration_s) {
    table.refuse_keys_except({"phase", "from", "to", "middle", "otherwise", "run"});
    ScheduleEntry entry;
    entry.where = table.where();
    entry.otherwise = table.optional_boolean("otherwise").value_or(false);
    if (table.has("otherwise") && !entry.otherwise)
        throw InputError(table.where("otherwise"), "`otherwise = false` has no effect", "leave it out");
    if (table.has("phase")) entry.phase = read_flown_phase(table, duration_s);
    if (!entry.phase && !entry.otherwise) {
        throw InputError(entry.where, "this entry has no time",
                         "give it a phase, or `otherwise = true` for whatever the others leave");
    }
    if (entry.phase && !entry.otherwise) read_segment(table, duration_s[*entry.phase], entry);
    for (const std::string_view key : {"from", "to", "middle"}) {
        if (entry.otherwise && table.has(key)) {
            throw InputError(table.where(key), fmt::format("`{}` is given with `otherwise`", key),
                             "`otherwise` is what is left; leave one of them out");
        }
    }
    entry.run = read_run(table.table("run"), compute);
    return entry;
}

/// The `otherwise` of a phase, or of the mission.
const ScheduleEntry* otherwise_of(const std::vector<ScheduleEntry>& entries, std::optional<Phase> phase) {
    const auto found = std::ranges::find_if(
        entries, [&](const ScheduleEntry& entry) { return entry.otherwise && entry.phase == phase; });
    return found == entries.end() ? nullptr : &*found;
}

void refuse_second_otherwise(const std::vector<ScheduleEntry>& entries) {
    for (const auto& entry : entries) {
        if (!entry.otherwise) continue;
        const auto* first = otherwise_of(entries, entry.phase);
        if (first == &entry) continue;
        throw InputError(entry.where,
                         fmt::format("a second `otherwise` for {}, the first is in line {}",
                                     entry.phase ? to_string(*entry.phase) : "the whole mission", first->where.line),
                         "keep one of them");
    }
}

[[noreturn]] void refuse_overlap(const ScheduleEntry& first, const ScheduleEntry& second) {
    const auto [earlier, later] =
        std::minmax(first, second, [](const auto& a, const auto& b) { return a.where.line < b.where.line; });
    throw InputError(
        later.where,
        fmt::format("{} is scheduled twice, here and in line {}",
                    spell(*first.phase, std::max(first.start_s, second.start_s), std::min(first.end_s, second.end_s)),
                    earlier.where.line),
        first.whole_phase || second.whole_phase
            ? "give the entry of the whole phase `otherwise = true`, and it takes what the others leave"
            : "end one where the other begins");
}

/// An entry, with times that meet its neighbours and the ends of the phase exactly.
struct PlacedEntry {
    PhaseSegment segment;
    const ScheduleEntry* entry;
};

/// The explicit entries of a phase in order. Throws InputError where two overlap.
std::vector<PlacedEntry> placed_entries(const std::vector<ScheduleEntry>& entries, Phase phase, double duration_s) {
    const double tolerance_s = same_time_tolerance_s(duration_s);
    std::vector<PlacedEntry> placed;
    for (const auto& entry : entries)
        if (!entry.otherwise && entry.phase == phase) placed.push_back({{phase, entry.start_s, entry.end_s}, &entry});
    std::ranges::stable_sort(
        placed, [](const PlacedEntry& a, const PlacedEntry& b) { return a.segment.start_s < b.segment.start_s; });
    double covered_s = 0.0;
    const ScheduleEntry* previous = nullptr;
    for (auto& [segment, entry] : placed) {
        if (previous != nullptr && segment.start_s < previous->end_s - tolerance_s) refuse_overlap(*previous, *entry);
        if (segment.start_s <= covered_s + tolerance_s) segment.start_s = covered_s;
        if (segment.end_s >= duration_s - tolerance_s) segment.end_s = duration_s;
        covered_s = segment.end_s;
        previous = entry;
    }
    return placed;
}

}  // namespace

Phase read_flown_phase(const TomlTable& entry, const PerPhase<double>& duration_s) {
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
    return entry.is_number(key) ? entry.number(key) : units::amount_from_percent(duration_s, percent_in(entry, key));
}

std::vector<ScheduleEntry> read_schedule(const TomlTable& mission, const compute::ComputeModel& compute,
                                         const PerPhase<double>& duration_s) {
    std::vector<ScheduleEntry> entries;
    for (const auto& table : mission.tables("schedule")) entries.push_back(read_entry(table, compute, duration_s));
    return entries;
}

Schedule resolve_schedule(const std::vector<ScheduleEntry>& entries, const PerPhase<double>& duration_s) {
    if (entries.empty()) throw std::invalid_argument("a schedule has at least one entry");
    refuse_second_otherwise(entries);
    PerPhase<std::vector<PlacedEntry>> placed;
    for (const auto phase : all_phases) placed[phase] = placed_entries(entries, phase, duration_s[phase]);
    Schedule segments;
    std::set<const ScheduleEntry*> used;
    for (const auto phase : all_phases) {
        double covered_s = 0.0;
        const auto* filler = otherwise_of(entries, phase);
        if (filler == nullptr) filler = otherwise_of(entries, std::nullopt);
        const auto fill_until = [&](double until_s, const ScheduleEntry& near) {
            if (filler == nullptr)
                throw InputError(near.where,
                                 fmt::format("nothing is scheduled for {}", spell(phase, covered_s, until_s)),
                                 "add an entry with `otherwise = true`; `run = {}` runs nothing");
            used.insert(filler);
            segments.push_back({phase, covered_s, until_s, filler->run});
        };
        for (const auto& [segment, entry] : placed[phase]) {
            if (segment.start_s > covered_s) fill_until(segment.start_s, *entry);
            segments.push_back({segment, entry->run});
            covered_s = segment.end_s;
        }
        if (covered_s < duration_s[phase] - same_time_tolerance_s(duration_s[phase]))
            fill_until(duration_s[phase], placed[phase].empty() ? entries.back() : *placed[phase].back().entry);
    }
    for (const auto& entry : entries) {
        if (!entry.otherwise || used.contains(&entry)) continue;
        throw InputError(entry.where, "this `otherwise` covers nothing: the other entries leave no time",
                         "take it out");
    }
    return segments;
}

Schedule resolve_fixed_segments(const std::vector<ScheduleEntry>& entries, const PerPhase<double>& duration_s) {
    for (const auto& entry : entries) {
        if (!entry.otherwise) continue;
        throw InputError(entry.where, "`otherwise` leaves nothing to plan",
                         "take it out: what no other entry fixes is planned");
    }
    Schedule segments;
    for (const auto phase : all_phases)
        for (const auto& [segment, entry] : placed_entries(entries, phase, duration_s[phase]))
            segments.push_back({segment, entry->run});
    return segments;
}

}  // namespace flightwatt::mission
