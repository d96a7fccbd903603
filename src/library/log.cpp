#include "base/error.h"
#include "flight/load_flight.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <flightwatt/log.h>
#include <fmt/format.h>

namespace flightwatt {

Log::Log(std::shared_ptr<const flight::LoadedFlight> loaded) : loaded_(std::move(loaded)) {}

std::string Log::name() const { return loaded_->series.flight; }

std::string Log::aircraft() const { return loaded_->series.aircraft_name; }

std::vector<std::string> Log::track_names() const {
    std::vector<std::string> names;
    for (const auto& [name, member] : flight::track_members())
        if (!(loaded_->data.*member).empty()) names.emplace_back(name);
    return names;
}

Track Log::track(std::string_view name) const {
    const auto members = flight::track_members();
    const auto found = std::ranges::find(members, name, &flight::TrackMember::name);
    if (found == members.end()) throw UsageError(fmt::format("'{}' is no quantity of a log; see track_names()", name));
    const auto& chosen = loaded_->data.*found->track;
    return {std::string(name), chosen.source, chosen.time_s, chosen.value};
}

std::vector<std::string> Log::warnings() const {
    std::vector<std::string> texts;
    for (const auto& diagnostic : loaded_->diagnostics)
        if (diagnostic.severity != Severity::note) texts.push_back(diagnostic.text);
    return texts;
}

std::string Log::exclusion() const { return loaded_->exclusion; }

std::vector<Log> read_log(const std::filesystem::path& file) {
    auto loaded = flight::load_flights(file, {.flight_required = false, .power_required = false});
    std::vector<Log> logs;
    for (auto& flight : loaded.flights)
        logs.emplace_back(std::make_shared<const flight::LoadedFlight>(std::move(flight)));
    return logs;
}

std::vector<Log> read_logs(const std::vector<std::filesystem::path>& files) {
    std::vector<Log> logs;
    for (const auto& file : files) std::ranges::move(read_log(file), std::back_inserter(logs));
    return logs;
}

}  // namespace flightwatt
