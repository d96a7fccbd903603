#include "base/error.h"
#include "base/overwrite_guard.h"
#include "base/parallel.h"
#include "batch/batch_files.h"
#include "batch/batch_run.h"
#include "batch/manifest.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::batch {
namespace {

/// Those that may be another one, or another one it: those to be used first come first.
std::vector<const BatchFlight*> candidates_among(const BatchFlights& flights) {
    const auto is_fitted = [](const BatchFlight& flight) { return !flight.selection.flights.empty(); };
    std::vector<const BatchFlight*> candidates;
    candidates.reserve(flights.size());
    for (const auto& flight : flights)
        if (is_fitted(flight) || !flight.record.no_power_reason.empty()) candidates.push_back(&flight);
    // The one with power is used, of these one that is still there, of these the better copy.
    std::ranges::stable_sort(candidates, [&](const BatchFlight* one, const BatchFlight* other) {
        const auto rank = [&](const BatchFlight* flight) {
            return std::pair(!is_fitted(*flight), flight->log_is_missing);
        };
        if (rank(one) != rank(other)) return rank(one) < rank(other);
        return is_preferred_duplicate(one->record.content, other->record.content);
    });
    return candidates;
}

struct NamedContent {
    std::string flight;
    bool has_power = false;
    flight::FlightSketch content;  ///< with its marks, which only its file has
};

NamedContent content_of(const FlightRecord& record, const std::filesystem::path& out) {
    const OverwriteExemption own;
    const auto file = result_path(out, record.flight, record_suffix);
    auto marks = marks_from_json(read_file(file));
    if (!marks) throw InputError({file.string()}, "it changed while it was read", "run flightwatt batch again");
    NamedContent named{record.flight, record.no_power_reason.empty(), record.content};
    named.content.hashes = *std::move(marks);
    return named;
}

}  // namespace

std::string duplicate_reason(const std::string& other) {
    return fmt::format("it is the same flight as {}, which is used", other);
}

Duplicates find_duplicates(const BatchFlights& flights, const std::filesystem::path& out) {
    const auto candidates = candidates_among(flights);
    flight::SketchIndex known;
    std::vector<std::string> used;
    Duplicates repeated;
    constexpr std::size_t at_once = 256;  // of a hundred thousand, marks would fill the memory
    std::vector<NamedContent> contents(at_once);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (i % at_once == 0) {
            for_each_in_parallel(std::min(at_once, candidates.size() - i),
                                 [&](std::size_t k) { contents[k] = content_of(candidates[i + k]->record, out); });
        }
        auto& [name, has_power, content] = contents[i % at_once];
        const auto alike = known.find(content);
        const auto same = std::ranges::find_if(alike, [](const auto& like) { return like.likeness.is_same; });
        if (same != alike.end()) {
            repeated.copies.push_back({name, used[same->number], has_power});
            continue;
        }
        for (const auto& [number, likeness] : alike)
            repeated.overlaps.emplace_back(name, flight::describe_overlap(used[number], name, likeness));
        known.add(std::move(content));
        used.push_back(name);
    }
    std::ranges::sort(repeated.copies, {}, &DuplicateFlight::flight);
    return repeated;
}

const std::string* original_of(const std::string& flight, const Duplicates& repeated) {
    const auto copy = std::ranges::lower_bound(repeated.copies, flight, {}, &DuplicateFlight::flight);
    const bool is_found = copy != repeated.copies.end() && copy->flight == flight && copy->has_power;
    return is_found ? &copy->same_as : nullptr;
}

void exclude_duplicates(BatchFlights& flights, const Duplicates& repeated) {
    if (repeated.copies.empty() && repeated.overlaps.empty()) return;
    auto overlaps = repeated.overlaps;
    std::ranges::stable_sort(overlaps, {}, &std::pair<std::string, std::string>::first);
    for (auto& flight : flights) {
        const auto& name = flight.record.flight;
        const auto copy = std::ranges::lower_bound(repeated.copies, name, {}, &DuplicateFlight::flight);
        const bool is_copy = copy != repeated.copies.end() && copy->flight == name;
        auto part = std::ranges::lower_bound(overlaps, name, {}, &std::pair<std::string, std::string>::first);
        const bool has_part = part != overlaps.end() && part->first == name;
        if (!is_copy && !has_part) continue;
        for (; part != overlaps.end() && part->first == name; ++part) flight.record.warnings.push_back(part->second);
        if (is_copy) {
            flight.selection.flights.clear();
            flight.selection.flights.shrink_to_fit();
            flight.selection.exclusions.push_back({name, std::nullopt,
                                                   copy->has_power
                                                       ? duplicate_reason(copy->same_as)
                                                       : fmt::format("it is the same flight as {}", copy->same_as)});
        }
    }
}

}  // namespace flightwatt::batch
