#include "flight/flight_file.h"

#include "base/atomic_file.h"
#include "base/input_file.h"
#include "base/number.h"
#include "flight/families/ardupilot_family.h"
#include "flight/families/log_family.h"
#include "flight/families/mapped_csv.h"
#include "flight/families/mavlink_family.h"
#include "flight/families/px4_family.h"
#include "flight/flight_identity.h"
#include "flight/series_file.h"
#include "flight/telemetry_series.h"
#include "telemetry/log_reader.h"
#include "telemetry/recordings.h"
#include "telemetry/ulog_folder.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include <boost/algorithm/string/predicate.hpp>
#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

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

/// A synthetic log without a .log is recognised by its first line, Paparazzi's simulator NPS by its own messages.
void name_unflown(const FlightFile& file, std::vector<FlightSeries>& candidates) {
    if (file.framing()) return;
    const std::string_view text = file.text();
    const auto has = [](std::string_view in, std::string_view what) { return in.find(what) != std::string_view::npos; };
    const bool is_synthetic = has(text.substr(0, text.find('\n')), "INFO_MSG \"SYNTHETIC:");
    const bool is_simulated = has(text, "NPS_");
    for (auto& series : candidates) {
        if (is_synthetic && series.aircraft_name.empty()) series.aircraft_name = unnamed_synthetic;
        if (is_simulated && has(text, fmt::format(" {} NPS_", series.aircraft_id)))
            series.aircraft_name += series.aircraft_name.empty() ? "NPS" : " NPS";
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
        auto& of_sender = candidates.back().skipped;
        of_sender.insert(of_sender.begin(), skipped.begin(), skipped.end());
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

const LogFamily& family_of(telemetry::AutopilotFormat format) {
    using telemetry::AutopilotFormat;
    switch (format) {
        case AutopilotFormat::ulog:
        case AutopilotFormat::ulog_tables:
            return px4_family();
        case AutopilotFormat::sdlog2:
            return sdlog2_family();
        case AutopilotFormat::tlog:
            return mavlink_family();
        default:
            return ardupilot_family();
    }
}

/// The recordings of each aircraft in a log; several of a ground station's log are candidates of the same recording,
/// and those that follow each other with one number are recordings.
std::vector<Candidates> read_autopilot(const FlightFile& file) {
    const auto format = file.autopilot().value();
    const auto& family = family_of(format);
    auto logs = read_autopilot_logs(file.text(), format, file.path(), family_messages(family));
    std::vector<Candidates> recordings;
    std::map<std::string, std::size_t> numbers;  // of recordings, by system
    for (const auto& read : logs) numbers[read.log.senders.front().id] = 0;
    for (auto& read : logs) {
        const auto system = read.log.senders.front().id;
        auto& number = numbers[system];
        for (auto& log : recordings_of(std::move(read.log))) {
            if (recordings.size() == number) recordings.emplace_back();
            telemetry::AutopilotLog part{std::move(log), read.facts, read.messages};
            auto series = format == telemetry::AutopilotFormat::tlog ? mavlink_series(std::move(part))
                                                                     : family_series(std::move(part), family);
            if (numbers.size() > 1) series.aircraft_name += " " + system;
            recordings[number++].push_back(std::move(series));
        }
    }
    return recordings;
}

/// An aircraft of several in a log (LoadOptions::aircraft). Not required: a log without it is read as if none were
/// named.
struct AircraftRequest {
    const std::optional<std::string>& name;
    bool required;
};

/// Of the aircraft of a log, with their names, those that a text names: by id, else by name or the beginning of an id.
std::vector<std::string> named_aircraft(const std::string& text, const std::map<std::string, std::string>& names) {
    if (names.contains(text)) return {text};
    std::vector<std::string> ids;
    for (const auto& [id, name] : names)
        if (name == text || (text.size() >= min_id_beginning && id.starts_with(text))) ids.push_back(id);
    return ids;
}

/// The recordings of a file of one aircraft; none if it is another one.
std::vector<Candidates> parse_single(const FlightFile& file, const AircraftRequest& aircraft,
                                     std::set<std::string>& ids) {
    const auto& map = file.column_map();
    std::vector<Candidates> recordings;
    if (!map && !file.is_series()) {
        recordings = read_autopilot(file);
    } else {
        for (auto& series :
             map ? parse_mapped_csv(file.text(), file.path(), *map) : parse_series_recordings(file.text(), file.path()))
            recordings.push_back({std::move(series)});
    }
    // Names of several in a .tlog end with their systems' numbers.
    const bool is_tlog = file.autopilot() == telemetry::AutopilotFormat::tlog;
    for (auto& candidates : recordings) {
        for (const auto& series : candidates) ids.insert(series.aircraft_id);
        std::erase_if(candidates, [&](const FlightSeries& series) {
            return aircraft.name && aircraft.required && !series.aircraft_id.empty() &&
                   series.flight != *aircraft.name &&
                   !(is_tlog && series.aircraft_name.ends_with(" " + *aircraft.name)) &&
                   named_aircraft(*aircraft.name, {{series.aircraft_id, series.aircraft_name}}).empty();
        });
    }
    return recordings;
}

/// The ids of the senders of a log, with the names of their aircraft.
std::map<std::string, std::string> sender_names(const telemetry::TelemetryLog& log) {
    std::map<std::string, std::string> names;
    for (const auto& sender : log.senders) {
        const auto* known = log.configuration ? &log.configuration->aircraft : nullptr;
        names[sender.id] = known != nullptr && known->contains(sender.id) ? known->at(sender.id).name : "";
    }
    return names;
}

std::vector<Candidates> parse_recordings(const FlightFile& file, const AircraftRequest& aircraft,
                                         std::set<std::string>& ids) {
    if (file.is_series() || file.autopilot()) return parse_single(file, aircraft, ids);
    const bool takes_any =
        !aircraft.name || !aircraft.required || telemetry::flight_name(file.path()) == *aircraft.name;
    std::vector<Candidates> recordings;
    for (auto& log : recordings_of(read_log(file))) {
        const auto names = sender_names(log);
        auto& candidates = recordings.emplace_back();
        if (aircraft.name)
            for (const auto& id : named_aircraft(*aircraft.name, names)) candidates.push_back(flight_series(log, id));
        if (candidates.empty() && takes_any) candidates = all_candidates(std::move(log));
        name_unflown(file, candidates);
        for (const auto& [id, name] : names) ids.insert(id);
    }
    return recordings;
}

/// Names the recordings behind the first, and notes where they begin.
void name_recordings(std::vector<Candidates>& recordings) {
    for (std::size_t i = 1; i < recordings.size(); ++i) {
        for (auto& series : recordings[i]) {
            double begin_s = std::numeric_limits<double>::infinity();
            for (const auto& track : series.tracks)
                if (!track.empty()) begin_s = std::min(begin_s, track.time_s.front());
            series.flight = recording_name(series.flight, i + 1);
            series.notes.push_back(
                fmt::format("recording {} of {} recordings in its file, from {:.1f} s of its clock on", i + 1,
                            recordings.size(), begin_s));
        }
    }
}

}  // namespace

FlightFile::FlightFile(const std::filesystem::path& path, std::size_t max_bytes,
                       const std::optional<std::filesystem::path>& messages,
                       const std::optional<std::filesystem::path>& columns)
    : path_(path) {
    const auto tables = columns ? std::nullopt : telemetry::find_ulog_tables(path);
    std::error_code error;
    const bool is_csv = boost::iequals(path.extension().string(), ".csv") || is_flight_csv(path, columns);
    is_series_ = !tables && is_csv && std::filesystem::is_regular_file(path, error);
    if (tables) {
        path_ = *tables;
        text_ =
            telemetry::join_ulog_tables(path_, family_messages(px4_family()), std::max(max_bytes, max_series_bytes));
        autopilot_ = telemetry::detect_autopilot_format(text_);
        return;
    }
    if (is_series_) {
        text_ = read_file(path, std::max(max_bytes, max_series_bytes), "--max-log-mb raises the limit");
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

telemetry::MessageDictionary FlightFile::definitions() const {
    if (!log_text_) {
        throw InputError({path_.string()}, "is a binary log, and no .log defines its messages",
                         "name the messages.xml or .log of the aircraft and build that flew, with --messages FILE");
    }
    return telemetry::parse_message_dictionary(*log_text_, log_file_);
}

std::vector<std::string> list_message_counts(const FlightFile& file) {
    std::vector<std::string> names;
    if (file.is_series()) return names;
    if (file.autopilot()) {
        for (const auto& log : read_autopilot_logs(file.text(), *file.autopilot(), file.path(), {}))
            for (const auto& of : log.messages) names.push_back(fmt::format("{} {}", of.name, of.count));
        return names;
    }
    const auto counts = file.framing()
                            ? with_binary_log(file, [](const auto& log) { return count_binary_messages(log); })
                            : telemetry::count_messages(file.text());
    for (const auto& [name, count] : counts) names.push_back(fmt::format("{} {}", name, count));
    return names;
}

std::string recording_name(const std::string& flight, std::size_t recording) {
    return recording == 1 ? flight : fmt::format("{}@{}", flight, recording);
}

bool is_recording_name(const std::string& flight) {
    const auto at = flight.rfind('@');
    return at != std::string::npos && at > 0 && parse_unsigned(flight.substr(at + 1)).has_value();
}

std::vector<Candidates> read_recordings(const FlightFile& file, const std::optional<std::string>& aircraft,
                                        bool required) {
    std::set<std::string> ids;
    auto recordings = parse_recordings(file, {aircraft, required}, ids);
    if (std::ranges::all_of(recordings, &Candidates::empty)) {
        throw OtherAircraftError({file.path().string()}, fmt::format("aircraft {} sent nothing", aircraft.value_or("")),
                                 "the log has " + short_list({ids.begin(), ids.end()}));
    }
    if (recordings.size() > telemetry::max_recordings) {
        throw InputError({file.path().string()}, fmt::format("has {} recordings", recordings.size()),
                         fmt::format("a file may have {}: split it", telemetry::max_recordings));
    }
    for (auto& candidates : recordings)
        for (auto& series : candidates)
            if (!file.log_error().empty()) series.notes.push_back(file.log_error());
    name_recordings(recordings);
    return recordings;
}

}  // namespace flightwatt::flight
