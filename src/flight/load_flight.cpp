#include "flight/load_flight.h"

#include "base/error.h"
#include "flight/flight_identity.h"
#include "flight/link_gaps.h"
#include "flight/phase_statistics.h"
#include "flight/power_check.h"
#include "flight/select.h"
#include "flight/vtol_flight.h"

#include <algorithm>
#include <new>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

constexpr std::size_t min_altitudes = 2;  // for segmentation

/// "GPS 310, ALIVE 12, ...".
std::string describe_message_counts(const FlightFile& file) {
    constexpr std::size_t shown = 12;
    auto names = list_message_counts(file);
    const bool more = names.size() > shown;
    names.resize(std::min(names.size(), shown));
    return fmt::format("{}{}", fmt::join(names, ", "), more ? ", ..." : "");
}

/// The aircraft that flew. Throws InputError without power if it is required or there is no altitude either.
FlightSeries choose_series(const FlightFile& file, Candidates candidates, bool power_required, bool of_others) {
    auto series = choose_aircraft(std::move(candidates), of_others);
    const auto data = select_tracks(series);
    const bool needs_power = power_required || data.altitude_m.time_s.size() < min_altitudes;
    if (data.clock_restart || (needs_power && data.power_w.empty())) require_power(data, describe_message_counts(file));
    return series;
}

/// Why the aircraft did not fly; empty if it did.
std::string not_flown_reason(const FlightSeries& series) {
    const auto data = select_tracks(series);
    if (data.altitude_m.time_s.size() < min_altitudes) return "no altitude";
    const auto phases = segment(data);
    if (!phases.sorties.empty()) return "";
    return phases.ground_events.empty() ? "no motion" : phases.ground_events.front().what;
}

/// Leaves out the other sorties, with the log before and after them.
void restrict_to_sortie(FlightPhases& phases, std::size_t number, const std::string& file) {
    const auto count = phases.sorties.size();
    for (const auto& sortie : phases.sorties) {
        if (sortie.number < number) phases.part.start_s = sortie.end_s();
        if (sortie.number > number) phases.part.end_s = std::min(phases.part.end_s, sortie.start_s());
    }
    std::erase_if(phases.sorties, [&](const Sortie& sortie) { return sortie.number != number; });
    if (phases.sorties.empty()) {
        throw InputError({file}, fmt::format("has no sortie {}: there are {}", number, count));
    }
}

std::string parenthesised(const std::string& text) { return text.empty() ? "" : fmt::format(" ({})", text); }

/// Limits sorties times samples: a log of a day with twenty sorties at 10 Hz has 17 million.
void limit_work(const FlightData& data, const FlightPhases& phases) {
    constexpr std::size_t max_work = 100'000'000;
    const auto samples = data.power_w.time_s.size();
    if (phases.sorties.size() * samples <= max_work) return;
    throw InputError({data.file}, fmt::format("{} sorties in {} samples of power", phases.sorties.size(), samples),
                     "is it the log of one flight? Split it, or select a sortie with --sortie N");
}

/// All diagnostics, of one flight and one log each.
Diagnostics all_diagnostics(const FlightData& data, const FlightPhases& phases, const FlightAssessment& assessment) {
    const auto& flight = data.flight;
    auto found = selection_diagnostics(data);
    if (is_simulated(data.aircraft_name))
        found.push_back({Severity::warning, "flown by a simulator",
                         fmt::format("a simulator flew it ({}): its power is simulated too", data.aircraft_name),
                         flight});
    if (!assessment.lacks_power.empty())
        found.push_back({Severity::warning, "no measured power",
                         assessment.lacks_power + ": the energy of its phases is unknown", flight});
    append(found, Severity::warning, "uncertain phases", flight, phases.warnings);
    for (auto finding : assessment.power.warnings) {
        finding.flight = flight;
        found.push_back(std::move(finding));
    }
    for (const auto& sortie : phases.sorties)
        if (auto text = describe_vtol(data, sortie); !text.empty())
            found.push_back({Severity::note, "flown as a VTOL", std::move(text), flight});
    const PowerStatistics power(data);
    for (const auto& sortie : phases.sorties)
        if (const double lost_s = power.between(sortie.start_s(), sortie.end_s()).lost_s; lost_s > 0.0)
            found.push_back(
                {Severity::warning, "power lost by damage",
                 fmt::format("damage hides the power of {:.1f} s in flight: its energy is not counted", lost_s),
                 flight});
    return found;
}

std::string exclusion_of(const FlightInfo& series, const FlightAssessment& assessment, const LoadOptions& options) {
    if (options.excluded.contains(series.flight)) return "--exclude names it";
    if (assessment.lacks_power.empty() && options.keep.contains(series.flight)) return "";
    if (auto reason = simulation_reason(series.aircraft_name, options); !reason.empty()) return reason;
    return exclusion_reason(assessment);
}

/// The energy before the beginning and after the end of the log is missing.
void warn_of_missing_ends(LoadedFlight& loaded) {
    for (const auto& sortie : loaded.phases.sorties) {
        const auto& first = sortie.phases.front();
        const auto& last = sortie.phases.back();
        const auto warn = [&](const char* what, double time_s) {
            loaded.diagnostics.push_back(
                {Severity::warning, "begins or ends in the air",
                 fmt::format("the log {} in the air, at {:.0f} s: the energy is only that of the logged part", what,
                             time_s),
                 loaded.series.flight});
        };
        if (first.phase != Phase::takeoff || !first.complete) warn("begins", sortie.start_s());
        if (last.phase != Phase::landing || !last.complete) warn("ends", sortie.end_s());
    }
}

LoadedFlight load_candidates(const FlightFile& file, Candidates candidates, const LoadOptions& options) {
    auto loaded = segment_and_check(
        choose_series(file, std::move(candidates), options.power_required, options.aircraft.has_value()), options);
    warn_of_missing_ends(loaded);  // not in segment_and_check: predict processes logs that end in the air
    return loaded;
}

}  // namespace

FlightFile::FlightFile(const std::filesystem::path& path, const LoadOptions& options)
    : FlightFile(path, options.max_log_bytes, options.messages, options.columns) {}

std::size_t choose_recording(const std::vector<Candidates>& recordings, const FlightFile& file,
                             const std::optional<std::size_t>& requested) {
    if (requested && *requested > recordings.size()) {
        throw InputError({file.path().string()},
                         fmt::format("has no recording {}: there are {}", *requested, recordings.size()));
    }
    if (requested && recordings[*requested - 1].empty()) {
        throw OtherAircraftError({file.path().string()},
                                 fmt::format("the aircraft sent nothing in recording {}", *requested));
    }
    if (requested || recordings.size() == 1) return requested.value_or(1);
    const auto flew = [](const FlightSeries& series) {
        return !series.clock_restart && not_flown_reason(series).empty();
    };
    const auto found = std::ranges::find_if(
        recordings, [&](const Candidates& candidates) { return std::ranges::any_of(candidates, flew); });
    const auto used = found == recordings.end() ? std::ranges::find_if_not(recordings, &Candidates::empty) : found;
    return static_cast<std::size_t>(used - recordings.begin()) + 1;
}

Candidates read_candidates(const FlightFile& file, const std::optional<std::string>& aircraft, bool required) {
    auto recordings = read_recordings(file, aircraft, required);
    return std::move(recordings[choose_recording(recordings, file, std::nullopt) - 1]);
}

FlightSeries choose_aircraft(Candidates candidates, bool of_others) {
    if (candidates.empty()) throw OtherAircraftError({}, "the aircraft sent nothing");
    if (candidates.size() == 1) return std::move(candidates.front());
    std::vector<std::string> reasons(candidates.size());
    std::ranges::transform(candidates, reasons.begin(), not_flown_reason);
    const bool any = std::ranges::any_of(reasons, &std::string::empty);
    std::vector<std::string> ids;
    std::size_t last = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (any && !reasons[i].empty()) continue;
        const auto& id = candidates[i].aircraft_id;
        ids.push_back(any ? id : fmt::format("{} ({})", id, reasons[i]));
        last = i;
    }
    if (ids.size() > 1) {
        const auto& file = candidates.front().file;
        const auto found = short_list(ids);
        if (!any) throw InputError({file}, "none of its aircraft flew: " + found);
        const auto several = "several aircraft flew: " + found;
        const auto* hint = "select one with --aircraft ID";
        if (of_others) throw OtherAircraftError({file}, several, hint);
        throw InputError({file}, several, hint);
    }
    return std::move(candidates[last]);
}

FlightAssessment assess_flight(const FlightData& data, const FlightPhases& phases, const SegmentationOptions& options) {
    const bool has_altitude = data.altitude_m.time_s.size() >= min_altitudes;
    const bool has_power = !data.power_w.empty();
    FlightAssessment assessment;
    if (!has_power) assessment.lacks_power = "no measured power" + parenthesised(no_power_reason(data));
    assessment.power.origin = data.current_origin;
    if (has_altitude && has_power) assessment.power = check_power_record(data, phases, options);
    assessment.diagnostics = all_diagnostics(data, phases, assessment);
    return assessment;
}

std::string simulation_reason(const std::string& aircraft_name, const LoadOptions& options) {
    if (options.simulated || !is_simulated(aircraft_name)) return "";
    return fmt::format("a simulator flew it ({}); --simulated uses such flights", aircraft_name);
}

std::string exclusion_reason(const FlightAssessment& assessment) {
    if (!assessment.lacks_power.empty()) return assessment.lacks_power;
    return assessment.power.power_faults.empty() ? "" : describe_power_faults(assessment.power.power_faults);
}

LoadedFlight segment_and_check(FlightSeries series, const LoadOptions& options) {
    LoadedFlight loaded;
    FlightAssessment& assessment = loaded;
    auto data = select_tracks(series);
    const auto gaps = options.bridges_link_gaps ? bridge_link_gaps(data) : std::vector<LinkGap>();
    const bool has_altitude = data.altitude_m.time_s.size() >= min_altitudes;
    if (options.power_required || !has_altitude || data.clock_restart) require_power(data);
    if (options.flight_required || has_altitude) loaded.phases = segment(data, options.segmentation);
    if (options.flight_required) require_sortie(data, loaded.phases, data.file);
    if (options.sortie) restrict_to_sortie(loaded.phases, *options.sortie, data.file);
    if (options.flight_required) limit_work(data, loaded.phases);
    assessment = assess_flight(data, loaded.phases, options.segmentation);
    if (options.correct_idle_offset && loaded.lacks_power.empty()) {
        correct_idle_offset(series, data, loaded.power.idle);
        if (loaded.power.idle)
            std::erase_if(loaded.power.warnings, [](const auto& found) { return found.kind == "current at rest"; });
        data = select_tracks(series);
        if (options.bridges_link_gaps) bridge_link_gaps(data);
        loaded.diagnostics = all_diagnostics(data, loaded.phases, assessment);
    }
    if (const auto jump = clock_jump_fault(data, loaded.phases, loaded.power))
        bridge_gap(data, {jump->start_s, jump->start_s + jump->duration_s});
    append(loaded.diagnostics, Severity::warning, "link lost", data.flight, gap_warnings(gaps, loaded.phases.sorties));
    loaded.exclusion = exclusion_of(data, assessment, options);
    if (loaded.exclusion.empty()) loaded.exclusion = unknown_energy_reason(gaps, loaded.phases.sorties);
    loaded.series = std::move(series);
    loaded.data = std::move(data);
    return loaded;
}

LoadedFile load_flights(const FlightFile& file, const LoadOptions& options) {
    auto recordings = read_recordings(file, options.aircraft, options.aircraft_required);
    LoadedFile loaded{.recordings = recordings.size()};
    const bool is_only = options.recording || recordings.size() == 1;
    const auto first = is_only ? choose_recording(recordings, file, options.recording) : 1;
    for (auto number = first; number <= (is_only ? first : recordings.size()); ++number) {
        try {
            loaded.flights.push_back(load_candidates(file, std::move(recordings[number - 1]), options));
            loaded.flights.back().recording = number;
        } catch (const InputError& error) {
            if (is_only) throw;
            loaded.unused[number] = error.what() + parenthesised(error.hint());
        }
    }
    if (!loaded.flights.empty()) return loaded;
    std::vector<std::string> reasons;
    for (const auto& [number, reason] : loaded.unused)
        reasons.push_back(fmt::format("recording {}: {}", number, reason));
    throw InputError({file.path().string()}, fmt::format("has {} recordings without a flight: {}", recordings.size(),
                                                         fmt::join(reasons, "; ")));
}

LoadedFile load_flights(const std::filesystem::path& path, const LoadOptions& options) {
    try {
        return load_flights(FlightFile(path, options), options);
    } catch (const std::bad_alloc&) {
        throw InputError({path.string()}, "cannot be read: not enough memory");
    }
}

LoadedFlight first_flight(LoadedFile file) {
    const auto flew = std::ranges::find_if(file.flights, [](const auto& of) { return !of.phases.sorties.empty(); });
    return std::move(flew == file.flights.end() ? file.flights.front() : *flew);
}

LoadedFlight load_flight(const std::filesystem::path& path, const LoadOptions& options) {
    return first_flight(load_flights(path, options));
}

FlightSeries read_flight(const std::filesystem::path& path, const std::optional<std::string>& aircraft) {
    const FlightFile file(path);
    return choose_series(file, read_candidates(file, aircraft), true, aircraft.has_value());
}

}  // namespace flightwatt::flight
