#include "batch/batch_files.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "flight/phases_file.h"
#include "flight/series_file.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt::batch {
namespace {

std::set<std::string> names_of(const std::vector<LogFile>& logs) {
    std::set<std::string> names;
    for (const auto& log : logs) names.insert(log.flight);
    return names;
}

std::vector<std::string> file_names(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

/// The flights that have a record in the folder, by name.
std::vector<std::string> recorded_flights(const std::filesystem::path& folder) {
    std::vector<std::string> flights;
    for (const auto& file : file_names(folder)) {
        if (file.ends_with(record_ending)) {
            flights.push_back(file.substr(0, file.size() - std::string_view(record_ending).size()));
        }
    }
    return flights;
}

/// What write_file_atomically() puts after a file's name until it renames it: a point and six letters or
/// digits. "" if `file` has no such ending.
std::string_view unfinished_ending(std::string_view file) {
    constexpr std::size_t length = std::string_view(".XXXXXX").size();
    if (file.size() <= length) return "";
    const auto ending = file.substr(file.size() - length);
    const bool random =
        std::all_of(ending.begin() + 1, ending.end(), [](unsigned char c) { return std::isalnum(c) != 0; });
    return ending.front() == '.' && random ? ending : "";
}

/// Whether a file of the flights folder is one that a batch wrote, for a flight that is not in `names`, or
/// did not get to rename when it was killed.
bool is_left_over(std::string_view file, const std::set<std::string>& names) {
    const auto whole = file.substr(0, file.size() - unfinished_ending(file).size());
    for (const std::string_view ending : {record_ending, series_ending, phases_ending}) {
        if (file.ends_with(ending)) return !names.contains(std::string(file.substr(0, file.size() - ending.size())));
        if (whole.ends_with(ending)) return true;
    }
    return false;
}

/// The same in OUT itself, where users keep copies: six small letters (flights.csv.backup) are a word of
/// theirs rather than a random name, of which one in two hundred is such.
bool is_unfinished_summary(std::string_view file) {
    const auto ending = unfinished_ending(file);
    if (ending.empty() ||
        std::all_of(ending.begin() + 1, ending.end(), [](unsigned char c) { return std::islower(c) != 0; })) {
        return false;
    }
    const auto whole = file.substr(0, file.size() - ending.size());
    return whole == catalogue_name || std::find(model_names.begin(), model_names.end(), whole) != model_names.end();
}

std::string reason_of(const FlightRecord& record, const std::vector<LogFile>& logs) {
    const auto same =
        std::find_if(logs.begin(), logs.end(), [&](const LogFile& log) { return log.path.string() == record.log; });
    if (same != logs.end()) return fmt::format("it is called {} now", same->flight);
    std::error_code ignored;
    if (std::filesystem::exists(record.log, ignored)) {
        return fmt::format("its log {} is not in this batch", record.log);
    }
    return "its log is gone";
}

StoredFlight read_flight(const std::filesystem::path& folder, const std::string& name) {
    const auto file = folder / (name + record_ending);
    auto record = record_from_json(read_file(file));
    if (!record) {
        throw InputError({file.string()}, "this is no record of a flight that this version writes",
                         "run flightwatt batch again");
    }
    record->flight = name;  // JSON holds no name that is not UTF-8
    StoredFlight flight{std::move(*record), {}, {}};
    if (!flight.record.accepted) return flight;
    flight.series = flight::read_series_csv(folder / (name + series_ending));
    flight.series.flight = name;
    flight.phases = flight::read_phases_csv(folder / (name + phases_ending));
    return flight;
}

}  // namespace

std::vector<DroppedFlight> find_dropped(const std::vector<LogFile>& logs, const std::filesystem::path& out) {
    const auto names = names_of(logs);
    const auto folder = out / "flights";
    std::vector<DroppedFlight> dropped;
    for (const auto& flight : recorded_flights(folder)) {
        if (names.contains(flight)) continue;
        FlightRecord record;  // one that cannot be read names no log, and its log is then as good as gone
        try {
            record = record_from_json(read_file(folder / (flight + record_ending))).value_or(FlightRecord{});
        } catch (const InputError&) {
            continue;  // not a file: no record of ours
        }
        dropped.push_back({flight, reason_of(record, logs)});
    }
    return dropped;
}

void remove_left_overs(const std::vector<LogFile>& logs, const std::filesystem::path& out) {
    const auto names = names_of(logs);
    std::error_code ignored;
    for (const auto& file : file_names(out / "flights")) {
        if (is_left_over(file, names)) std::filesystem::remove(out / "flights" / file, ignored);
    }
    for (const auto& file : file_names(out)) {
        if (is_unfinished_summary(file)) std::filesystem::remove(out / file, ignored);
    }
}

std::vector<StoredFlight> read_stored_flights(const std::filesystem::path& out) {
    const auto folder = out / "flights";
    if (!std::filesystem::is_directory(folder)) {
        throw InputError({out.string()}, "this is no folder of flightwatt batch: there is no flights/ in it",
                         fmt::format("make it with: flightwatt batch LOGS -o {}", out.string()));
    }
    std::vector<StoredFlight> flights;
    for (const auto& name : recorded_flights(folder)) flights.push_back(read_flight(folder, name));
    if (flights.empty()) {
        throw InputError({folder.string()}, "there is no record of a flight in it",
                         fmt::format("make them with: flightwatt batch LOGS -o {}", out.string()));
    }
    return flights;
}

}  // namespace flightwatt::batch
