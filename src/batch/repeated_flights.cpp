#include "batch/batch_run.h"

#include <algorithm>
#include <tuple>
#include <unordered_map>

#include <fmt/format.h>

namespace flightwatt::batch {
namespace {

/// Candidates for duplicates, the preferred ones first.
std::vector<const BatchFlight*> candidates_among(const BatchFlights& flights) {
    const auto is_fitted = [](const BatchFlight& flight) { return !flight.selection.flights.empty(); };
    std::vector<const BatchFlight*> candidates;
    candidates.reserve(flights.size());
    for (const auto& flight : flights)
        if (is_fitted(flight) || !flight.record.no_power_reason.empty()) candidates.push_back(&flight);
    std::ranges::stable_sort(candidates, {}, [&](const BatchFlight* flight) {
        return std::tuple(!is_fitted(*flight), flight->log_is_missing, !flight->record.content.has_definitions);
    });
    return candidates;
}

}  // namespace

std::string duplicate_reason(const std::string& other) {
    return fmt::format("it is the same flight as {}, which is used", other);
}

std::vector<DuplicateFlight> find_duplicates(const BatchFlights& flights) {
    std::vector<DuplicateFlight> copies;
    std::unordered_map<std::uint64_t, const FlightRecord*> used;  // by fingerprint
    for (const auto* flight : candidates_among(flights)) {
        const auto& record = flight->record;
        if (record.content.fingerprint == 0) continue;
        const auto [original, is_first] = used.emplace(record.content.fingerprint, &record);
        if (!is_first) copies.push_back({record.flight, original->second->flight, record.no_power_reason.empty()});
    }
    std::ranges::sort(copies, {}, &DuplicateFlight::flight);
    return copies;
}

const std::string* original_of(const std::string& flight, const std::vector<DuplicateFlight>& copies) {
    const auto copy = std::ranges::lower_bound(copies, flight, {}, &DuplicateFlight::flight);
    const bool is_found = copy != copies.end() && copy->flight == flight && copy->has_power;
    return is_found ? &copy->same_as : nullptr;
}

void exclude_duplicates(BatchFlights& flights, const std::vector<DuplicateFlight>& copies) {
    for (auto& flight : flights) {
        const auto& name = flight.record.flight;
        const auto copy = std::ranges::lower_bound(copies, name, {}, &DuplicateFlight::flight);
        if (copy == copies.end() || copy->flight != name) continue;
        flight.selection.flights.clear();
        flight.selection.flights.shrink_to_fit();
        flight.selection.exclusions.push_back({name, std::nullopt,
                                               copy->has_power
                                                   ? duplicate_reason(copy->same_as)
                                                   : fmt::format("it is the same flight as {}", copy->same_as)});
    }
}

}  // namespace flightwatt::batch
