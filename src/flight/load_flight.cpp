#include "flight/load_flight.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/overwrite_guard.h"
#include "flight/flight_identity.h"
#include "flight/phase_statistics.h"
#include "flight/selected_track.h"
#include "flight/series_file.h"
#include "flight/sources/log_family.h"
#include "flight/telemetry_series.h"

#include <algorithm>
#include <new>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

constexpr std::size_t min_altitudes = 2;     // for segmentation
constexpr std::size_t min_id_beginning = 4;  // characters: more than a whole id of Paparazzi has

/// "GPS 310, ALIVE 12, ...".
std::string shown_census(const FlightFile& file) {
    constexpr std::size_t shown = 12;
    auto names = census_of(file);
    const bool more = names.size() > shown;
    names.resize(std::min(names.size(), shown));
    return fmt::format("{}{}", fmt::join(names, ", "), more ? ", ..." : "");
}

telemetry::TelemetryLog read_log(const FlightFile& file) {
    std::optional<telemetry::LogConfiguration> configuration;
    if (const auto& text = file.log_text()) configuration = telemetry::parse_log_configuration(*text, file.log_file());
    if (file.framing()) {
        return with_binary_log(file, [&](const telemetry::BinaryLog& log) {
            return telemetry::read_binary_telemetry(log, std::move(configuration).value(), flight_messages());
        });
    }
    return telemetry::read_telemetry(file.text(), file.path(), std::move(configuration), flight_messages());
}

/// A synthetic log without a .log is recognised by its first line.
void name_synthetic(const FlightFile& file, std::vector<FlightSeries>& candidates) {
    if (file.framing()) return;
    if (file.text().substr(0, file.text().find('\n')).find("INFO_MSG \"SYNTHETIC:") == std::string_view::npos) return;
    for (auto& series : candidates)
        if (series.aircraft_name.empty()) series.aircraft_name = unnamed_synthetic;
}

/// The aircraft that flew. Throws InputError without power if it is required or there is no altitude either.
FlightSeries read_series(const FlightFile& file, const LoadOptions& options) {
    auto series = choose_aircraft(read_candidates(file, options.aircraft, options.aircraft_required),
                                  options.aircraft.has_value());
    const bool needs_power = options.power_required || SelectedTracks(series)["altitude_m"].time_s.size() < min_altitudes;
    if (series.clock_restart || (needs_power && power_track(series).empty())) require_power(series, shown_census(file));
    return series;
}

/// Why the aircraft did not fly; empty if it did.
std::string not_flown_reason(const FlightSeries& series) {
    const SelectedTracks tracks(series);
    if (tracks["altitude_m"].time_s.size() < min_altitudes) return "no altitude";
    const auto phases = segment(tracks);
    if (!phases.sorties.empty()) return "";
    return phases.ground_events.empty() ? "no motion" : phases.ground_events.front().what;
}

void restrict_to_sortie(FlightPhases& phases, std::size_t number, const std::string& file) {
    const auto count = phases.sorties.size();
    std::erase_if(phases.sorties, [&](const Sortie& sortie) { return sortie.number != number; });
    if (phases.sorties.empty()) {
        throw InputError({file}, fmt::format("has no sortie {}: there are {}", number, count));
    }
}

std::string parenthesised(const std::string& text) { return text.empty() ? "" : fmt::format(" ({})", text); }

/// Limits sorties times samples: a log of a day with twenty sorties at 10 Hz has 17 million.
void limit_work(const SelectedTracks& tracks, const FlightPhases& phases) {
    constexpr std::size_t max_work = 100'000'000;
    const auto samples = tracks["power_w"].time_s.size();
    if (phases.sorties.size() * samples <= max_work) return;
    throw InputError({tracks.series().file},
                     fmt::format("{} sorties in {} samples of power", phases.sorties.size(), samples),
                     "is it the log of one flight? Split it, or select a sortie with --sortie N");
}

std::vector<std::string> all_warnings(const SelectedTracks& tracks, const FlightPhases& phases,
                                      const FlightAssessment& assessment) {
    auto warnings = warnings_of(tracks);
    if (!assessment.lacks_power.empty())
        warnings.push_back(assessment.lacks_power + ": the energy of its phases is unknown");
    for (const auto* more : {&phases.warnings, &assessment.power.warnings})
        warnings.insert(warnings.end(), more->begin(), more->end());
    const PowerStatistics power(tracks.series());
    for (const auto& sortie : phases.sorties)
        if (const double lost_s = power.between(sortie.start_s(), sortie.end_s()).lost_s; lost_s > 0.0)
            warnings.push_back(
                fmt::format("damage hides the power of {:.1f} s in flight: its energy is not counted", lost_s));
    return warnings;
}

std::string exclusion_of(const FlightSeries& series, const FlightAssessment& assessment, const LoadOptions& options) {
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
            loaded.warnings.push_back(fmt::format(
                "the log {} in the air, at {:.0f} s: the energy is only that of the logged part", what, time_s));
        };
        if (first.phase != Phase::takeoff || !first.complete) warn("begins", sortie.start_s());
        if (last.phase != Phase::landing || !last.complete) warn("ends", sortie.end_s());
    }
}

/// The series of all senders of telemetry, each with the skipped lines of the whole log.
std::vector<FlightSeries> all_candidates(telemetry::TelemetryLog log) {
    constexpr std::size_t max_candidates = 32;
    constexpr std::size_t max_skips = 10'000'000;
    auto senders = telemetry_senders(log);
    if (senders.empty()) senders.emplace_back();
    auto skipped = std::exchange(log.skipped, {});
    std::size_t skips = 0;
    for (const auto& kind : skipped) skips += kind.lines.size();
    if (senders.size() > max_candidates || (senders.size() > 1 && skips * senders.size() > max_skips)) {
        throw InputError({log.data_file.string()},
                         fmt::format("{} senders may be aircraft: {}", senders.size(), short_list(senders)),
                         "select one with --aircraft ID");
    }
    std::vector<FlightSeries> candidates;
    for (const auto& sender : senders) {
        candidates.push_back(flight_series(log, sender));
        candidates.back().skipped = skipped;
    }
    return candidates;
}

/// Why a .log cannot be used; empty if it can.
std::string error_of_definitions(const std::filesystem::path& log, bool for_frames) {
    try {
        const auto text = read_file(log, telemetry::max_log_configuration_bytes);
        telemetry::parse_log_configuration(text, log);
        if (for_frames) telemetry::parse_message_dictionary(text, log);
    } catch (const InputError& error) {
        return fmt::format("{}: {}", log.string(), error.what());
    }
    return "";
}

FlightSeries read_autopilot(const FlightFile& file) {
    const auto format = file.autopilot().value();
    const auto& family = format == telemetry::AutopilotFormat::ulog ? px4_family() : ardupilot_family();
    return family_series(read_autopilot_log(file.text(), format, file.path(), family_messages(family)), family);
}

/// Of the aircraft of a log, with their names, those that a text names: by id, else by name or the beginning of an id.
std::vector<std::string> named_aircraft(const std::string& text, const std::map<std::string, std::string>& names) {
    if (names.contains(text)) return {text};
    std::vector<std::string> ids;
    for (const auto& [id, name] : names)
        if (name == text || (text.size() >= min_id_beginning && id.starts_with(text))) ids.push_back(id);
    return ids;
}

std::vector<FlightSeries> parse_candidates(const FlightFile& file, const std::optional<std::string>& aircraft,
                                           bool required) {
    std::vector<FlightSeries> candidates;
    std::vector<std::string> ids;
    if (file.is_series() || file.autopilot()) {
        const auto& map = file.column_map();
        candidates.push_back(map                ? parse_mapped_csv(file.text(), file.path(), *map)
                             : file.is_series() ? parse_series_csv(file.text(), file.path())
                                                : read_autopilot(file));
        const auto& series = candidates.front();
        ids.push_back(series.aircraft_id);
        if (!aircraft || !required || ids.front().empty() || series.flight == *aircraft ||
            !named_aircraft(*aircraft, {{series.aircraft_id, series.aircraft_name}}).empty())
            return candidates;
    } else {
        auto log = read_log(file);
        std::map<std::string, std::string> names;
        for (const auto& sender : log.senders) {
            ids.push_back(sender.id);
            const auto* known = log.configuration ? &log.configuration->aircraft : nullptr;
            names[sender.id] = known != nullptr && known->contains(sender.id) ? known->at(sender.id).name : "";
        }
        if (aircraft)
            for (const auto& id : named_aircraft(*aircraft, names)) candidates.push_back(flight_series(log, id));
        const bool takes_any =
            !aircraft || !required || telemetry::flight_name(file.path()) == *aircraft;
        if (candidates.empty() && takes_any) candidates = all_candidates(std::move(log));
        name_synthetic(file, candidates);
        if (!candidates.empty()) return candidates;
    }
    throw OtherAircraftError({file.path().string()}, fmt::format("aircraft {} sent nothing", *aircraft),
                             "the log has " + short_list(ids));
}

}  // namespace

FlightFile::FlightFile(const std::filesystem::path& path, std::size_t max_bytes,
                       const std::optional<std::filesystem::path>& messages,
                       const std::optional<std::filesystem::path>& columns)
    : path_(path) {
    std::error_code error;
    is_series_ = path.extension() == ".csv" && std::filesystem::is_regular_file(path, error);
    if (is_series_) {
        text_ = read_file(path, max_bytes, "if it is a series, --max-log-mb raises the limit");
        require_kind(text_, FileKind::log, path.string());
        column_map_ = column_map_of(text_, path, columns);
        return;
    }
    text_ = telemetry::read_data_file(path, max_bytes);
    autopilot_ = telemetry::detect_autopilot_format(text_);
    if (autopilot_) return;
    require_kind(text_, FileKind::log, path.string());
    framing_ = telemetry::detect_binary_framing(text_);
    auto log = telemetry::find_log_file(path);
    if (log && messages) log_error_ = error_of_definitions(*log, framing_.has_value());
    if (!log || !log_error_.empty()) log = messages;
    if (log) {
        log_file_ = *log;
        log_text_ = read_file(*log, telemetry::max_log_configuration_bytes);
    }
    if (!log_error_.empty()) log_error_ += fmt::format(": the definitions are those of {}", log_file_.string());
}

FlightFile::FlightFile(const std::filesystem::path& path, const LoadOptions& options)
    : FlightFile(path, options.max_log_bytes, options.messages, options.columns) {}

telemetry::MessageDictionary FlightFile::definitions() const {
    if (!log_text_) {
        throw InputError({path_.string()}, "is a binary log, and no .log defines its messages",
                         "name the messages.xml or .log of the aircraft and build that flew, with --messages FILE");
    }
    return telemetry::parse_message_dictionary(*log_text_, log_file_);
}

std::vector<std::string> census_of(const FlightFile& file) {
    std::vector<std::string> names;
    if (file.is_series()) return names;
    if (file.autopilot()) {
        for (const auto& of : read_autopilot_log(file.text(), *file.autopilot(), file.path(), {}).messages)
            names.push_back(fmt::format("{} {}", of.name, of.count));
        return names;
    }
    const auto counts = file.framing()
                            ? with_binary_log(file, [](const auto& log) { return census_of_binary_messages(log); })
                            : telemetry::count_messages(file.text());
    for (const auto& [name, count] : counts) names.push_back(fmt::format("{} {}", name, count));
    return names;
}

std::vector<FlightSeries> read_candidates(const FlightFile& file, const std::optional<std::string>& aircraft,
                                          bool required) {
    auto candidates = parse_candidates(file, aircraft, required);
    for (auto& series : candidates)
        if (!file.log_error().empty()) series.notes.push_back(file.log_error());
    return candidates;
}

FlightSeries choose_aircraft(std::vector<FlightSeries> candidates, bool of_others) {
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

FlightAssessment assess_flight(const SelectedTracks& tracks, const FlightPhases& phases,
                               const SegmentationOptions& options) {
    const auto& series = tracks.series();
    const bool has_altitude = tracks["altitude_m"].time_s.size() >= min_altitudes;
    const bool has_power = !tracks["power_w"].empty();
    FlightAssessment assessment;
    if (!has_power) assessment.lacks_power = "no measured power" + parenthesised(no_power_reason(series));
    assessment.power.origin = series.current_origin;
    if (has_altitude && has_power) assessment.power = check_power_record(tracks, phases, options);
    assessment.warnings = all_warnings(tracks, phases, assessment);
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
    {
        const SelectedTracks tracks(series);
        const bool has_altitude = tracks["altitude_m"].time_s.size() >= min_altitudes;
        if (options.power_required || !has_altitude || series.clock_restart) require_power(series);
        if (options.flight_required || has_altitude) loaded.phases = segment(tracks, options.segmentation);
        if (options.flight_required) require_sortie(series, loaded.phases, series.file);
        if (options.sortie) restrict_to_sortie(loaded.phases, *options.sortie, series.file);
        if (options.flight_required) limit_work(tracks, loaded.phases);
        assessment = assess_flight(tracks, loaded.phases, options.segmentation);
        loaded.sources = track_sources(tracks);
    }
    if (options.correct_idle_offset && loaded.lacks_power.empty()) {
        correct_idle_offset(series, loaded.power.idle);
        const SelectedTracks tracks(series);
        loaded.warnings = all_warnings(tracks, loaded.phases, assessment);
        loaded.sources = track_sources(tracks);
    }
    loaded.exclusion = exclusion_of(series, assessment, options);
    loaded.series = std::move(series);
    return loaded;
}

LoadedFlight load_flight(const FlightFile& file, const LoadOptions& options) {
    auto loaded = segment_and_check(read_series(file, options), options);
    warn_of_missing_ends(loaded);  // not in segment_and_check: predict processes logs that end in the air
    return loaded;
}

LoadedFlight load_flight(const std::filesystem::path& path, const LoadOptions& options) {
    try {
        return load_flight(FlightFile(path, options), options);
    } catch (const std::bad_alloc&) {
        throw InputError({path.string()}, "cannot be read: not enough memory");
    }
}

FlightSeries read_flight(const std::filesystem::path& path, const std::optional<std::string>& aircraft) {
    return read_series(FlightFile(path), {.aircraft = aircraft});
}

}  // namespace flightwatt::flight
