#include "flight/load_flight.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_use.h"
#include "flight/chosen_track.h"
#include "flight/flight_identity.h"
#include "flight/series_file.h"
#include "flight/telemetry_series.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

/// The messages of a log, the most frequent first: "GPS 310, ALIVE 12, ...".
std::string census(const FlightFile& file) {
    if (file.is_series()) return "";
    std::vector<std::string> names;
    for (const auto& [name, count] : telemetry::census_of_messages(file.text())) {
        names.push_back(fmt::format("{} {}", name, count));
    }
    constexpr std::size_t shown = 12;
    const bool more = names.size() > shown;
    names.resize(std::min(names.size(), shown));
    return fmt::format("{}{}", fmt::join(names, ", "), more ? ", ..." : "");
}

telemetry::TelemetryLog read_log(const FlightFile& file) {
    std::optional<telemetry::LogConfiguration> configuration;
    if (const auto& text = file.log_text()) configuration = telemetry::parse_log_configuration(*text, file.log_file());
    return telemetry::read_telemetry(file.text(), file.path(), std::move(configuration), flight_messages());
}

/// A synthetic log says in its first line what its .log says by the aircraft's name.
void name_synthetic(const FlightFile& file, std::vector<FlightSeries>& candidates) {
    if (file.text().substr(0, file.text().find('\n')).find("INFO_MSG \"SYNTHETIC:") == std::string_view::npos) return;
    for (auto& series : candidates)
        if (series.aircraft_name.empty()) series.aircraft_name = unnamed_synthetic;
}

/// Altitude and throttle alone, on the altitude's clock: enough to see whether an aircraft flew.
bool flew(const FlightSeries& series) {
    auto power = chosen_track(series, "altitude_m");
    if (power.time_s.size() < 2) return false;
    power.name = "power_w";
    power.source = plain_source;
    power.value.assign(power.time_s.size(), 0.0);
    auto moving = series;
    replace_track(moving, std::move(power));
    return !segment(moving).sorties.empty();
}

/// The one that flew, with the power that `file` tells of it.
FlightSeries read_series(const FlightFile& file, const std::optional<std::string>& aircraft_id) {
    auto series = choose_aircraft(read_candidates(file, aircraft_id));
    if (series.clock_restart || power_track(series).empty()) require_power(series, census(file));
    return series;
}

void restrict_to_sortie(FlightPhases& phases, std::size_t number, const std::string& file) {
    const auto count = phases.sorties.size();
    std::erase_if(phases.sorties, [&](const Sortie& sortie) { return sortie.number != number; });
    if (phases.sorties.empty()) {
        throw InputError({file}, fmt::format("has no sortie {}: there are {}", number, count));
    }
}

std::string exclusion_of(const LoadedFlight& flight, const LoadOptions& options) {
    if (options.excluded.contains(flight.series.flight)) return "--exclude names it";
    if (flight.power.power_faults.empty() || options.keep.contains(flight.series.flight)) return "";
    return describe_power_faults(flight.power.power_faults);
}

}  // namespace

FlightFile::FlightFile(const std::filesystem::path& path) : path_(path) {
    note_input(path);
    if (path.extension() == ".csv" && std::filesystem::is_regular_file(path)) {
        series_text_ = read_file(path);
        return;
    }
    data_.emplace(path);
    if (const auto log = telemetry::find_log_file(path)) {
        log_file_ = *log;
        log_text_ = read_file(*log);
    }
}

std::vector<FlightSeries> read_candidates(const FlightFile& file, const std::optional<std::string>& aircraft_id) {
    std::vector<FlightSeries> candidates;
    std::vector<std::string> ids;
    if (file.is_series()) {
        candidates.push_back(parse_series_csv(file.text(), file.path()));
        ids.push_back(candidates.front().aircraft_id);
        if (!aircraft_id || ids.front().empty() || ids.front() == *aircraft_id) return candidates;
    } else {
        const auto log = read_log(file);
        for (const auto& sender : log.senders) ids.push_back(sender.id);
        if (!aircraft_id) {
            for (const auto& id : telemetry_senders(log)) candidates.push_back(flight_series(log, id));
            if (candidates.empty()) candidates.push_back(flight_series(log, ""));
            name_synthetic(file, candidates);
            return candidates;
        }
        if (std::find(ids.begin(), ids.end(), *aircraft_id) != ids.end()) {
            candidates.push_back(flight_series(log, *aircraft_id));
            name_synthetic(file, candidates);
            return candidates;
        }
    }
    throw InputError({file.path().string()}, fmt::format("aircraft {} sent nothing", *aircraft_id),
                     fmt::format("the log holds {}", fmt::join(ids, ", ")));
}

FlightSeries choose_aircraft(std::vector<FlightSeries> candidates) {
    if (candidates.size() == 1) return std::move(candidates.front());
    std::vector<bool> has_flown(candidates.size());
    std::transform(candidates.begin(), candidates.end(), has_flown.begin(), flew);
    const bool any = std::find(has_flown.begin(), has_flown.end(), true) != has_flown.end();
    std::vector<std::string> ids;
    std::size_t last = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (any && !has_flown[i]) continue;
        ids.push_back(candidates[i].aircraft_id);
        last = i;
    }
    if (ids.size() > 1) {
        throw InputError({candidates.front().file}, fmt::format("several aircraft flew: {}", fmt::join(ids, ", ")),
                         "choose one with --aircraft ID");
    }
    return std::move(candidates[last]);
}

LoadedFlight examine_flight(FlightSeries series, const LoadOptions& options) {
    require_power(series);
    LoadedFlight loaded;
    const bool can_segment = options.flight_required || !chosen_track(series, "altitude_m").empty();
    if (can_segment) loaded.phases = segment(series, options.segmentation);
    if (options.flight_required) require_sortie(series, loaded.phases, series.file);
    if (options.sortie) restrict_to_sortie(loaded.phases, *options.sortie, series.file);
    loaded.power.origin = series.current_origin;
    if (can_segment) loaded.power = check_power_record(series, loaded.phases, options.segmentation);
    if (options.correct_idle_offset) correct_idle_offset(series, loaded.power.idle);
    loaded.warnings = warnings_of(series);
    loaded.warnings.insert(loaded.warnings.end(), loaded.phases.warnings.begin(), loaded.phases.warnings.end());
    loaded.series = std::move(series);
    loaded.exclusion = exclusion_of(loaded, options);
    return loaded;
}

LoadedFlight load_flight(const FlightFile& file, const LoadOptions& options) {
    return examine_flight(read_series(file, options.aircraft_id), options);
}

LoadedFlight load_flight(const std::filesystem::path& path, const LoadOptions& options) {
    return load_flight(FlightFile(path), options);
}

FlightSeries read_flight(const std::filesystem::path& path, const std::optional<std::string>& aircraft_id) {
    return read_series(FlightFile(path), aircraft_id);
}

}  // namespace flightwatt::flight
