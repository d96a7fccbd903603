#include "mission/file/schedule_entries.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

std::string spell(flight::Phase phase, double start_s, double end_s) {
    return fmt::format("{} from {} s to {} s", to_string(phase), start_s, end_s);
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
