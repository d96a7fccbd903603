#include "batch/log_files.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/fingerprint.h"
#include "base/text.h"
#include "flight/flight_file.h"
#include "telemetry/autopilot_log.h"
#include "telemetry/data_file.h"
#include "telemetry/log_configuration.h"
#include "telemetry/ulog_folder.h"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::batch {
namespace {

/// Whether a batch wrote a CSV: its record is in the same folder.
bool is_result(const std::filesystem::path& csv) {
    auto name = csv.filename().string();
    for (const std::string_view ending : {".series.csv", ".phases.csv"})
        if (name.ends_with(ending)) name.resize(name.size() - ending.size());
    std::error_code none;
    return std::filesystem::exists(csv.parent_path() / (name + ".record.json"), none);
}

/// .data, of SD cards .LOG and .tlm, of other autopilots .bin, .ulg and .px4log, of ground stations .tlog, compressed or
/// not. An X.LOG that is XML
/// defines the messages of X.tlm; a .log counts if it is a DataFlash log as text. Of the tables of ulog2csv one counts,
/// of other tables those that are flights.
bool is_log_name(const std::filesystem::path& path, const std::optional<std::filesystem::path>& columns) {
    auto name = path.filename().string();
    if (const auto log = columns ? std::nullopt : telemetry::find_ulog_tables(path)) return log->filename() == name;
    if (flight::is_flight_csv(path, columns)) return !is_result(path);
    for (const std::string_view packed : {".gz", ".bz2", ".xz", ".zst"}) {
        if (!name.ends_with(packed)) continue;
        name.resize(name.size() - packed.size());
        break;
    }
    constexpr std::array<std::string_view, 10> endings{".data", ".LOG", ".tlm",    ".TLM",  ".bin",
                                                       ".BIN",  ".ulg", ".px4log", ".tlog", ".TLOG"};
    const bool is_log = std::ranges::any_of(endings, [&](std::string_view ending) { return name.ends_with(ending); });
    if (name.ends_with(".log"))
        return telemetry::detect_autopilot_format(telemetry::beginning_of_file(path)).has_value();
    return is_log && !(name.ends_with(".LOG") && telemetry::begins_as_xml(path));
}

/// First line of the nearest not-fitted.txt between the given folder and the log, or empty.
std::string why_not_fitted(const std::filesystem::path& log, const std::filesystem::path& given) {
    auto inner = log.parent_path().lexically_relative(given);  // "." for the folder itself
    for (; !inner.empty() && inner != "."; inner = inner.parent_path()) {
        const auto file = given / inner / "not-fitted.txt";
        std::error_code none;
        if (!std::filesystem::exists(file, none)) continue;
        const auto text = read_file(file);
        auto reason = text.substr(0, text.find_first_of("\r\n"));
        if (reason.empty()) {
            throw InputError({file.string(), 1}, "is empty",
                             "expected a first line with the reason for not fitting these logs");
        }
        return reason;
    }
    return {};
}

std::string cause_of(const std::error_code& error) { return fmt::format("cannot be listed: {}", error.message()); }

/// Drops the CSVs of a folder, from `first` on, that were made from one of its logs.
void drop_series_of_logs(std::vector<LogFile>& logs, std::size_t first) {
    const auto is_csv = [](const LogFile& log) { return log.path.ends_with(".csv"); };
    std::unordered_set<std::string> of_logs;
    for (auto i = first; i < logs.size(); ++i)
        if (!is_csv(logs[i])) of_logs.insert(telemetry::flight_name(logs[i].path));
    const auto begin = logs.begin() + static_cast<std::ptrdiff_t>(first);
    const auto is_made = [&](const LogFile& log) {
        return is_csv(log) && of_logs.contains(telemetry::flight_name(log.path));
    };
    logs.erase(std::remove_if(begin, logs.end(), is_made), logs.end());
}

void add_folder(const std::filesystem::path& folder, const std::filesystem::path& given,
                const std::optional<std::filesystem::path>& columns, std::vector<LogFile>& logs) {
    std::error_code error;
    const auto first = logs.size();
    std::vector<std::filesystem::path> below;
    std::filesystem::directory_iterator entry(folder, error);
    while (!error && entry != std::filesystem::directory_iterator()) {
        std::error_code ignored;
        // A broken link with a log's name is rejected later.
        if (entry->is_directory(ignored)) {
            if (!entry->is_symlink(ignored)) below.push_back(entry->path());
        } else if (is_log_name(entry->path(), columns)) {
            logs.push_back({entry->path().string(), {}, why_not_fitted(entry->path(), given)});
        }
        entry.increment(error);
    }
    if (error) logs.push_back({folder.string(), {}, {}, cause_of(error)});
    drop_series_of_logs(logs, first);
    for (const auto& inner : below) add_folder(inner, given, columns, logs);
}

std::vector<LogFile> each_once(std::vector<LogFile> logs) {
    for (auto& log : logs) {
        auto normal = std::filesystem::path(log.path).lexically_normal().string();
        // LINK/.. is not the folder of LINK.
        const bool is_same =
            log.path.find("..") == std::string::npos || canonical_path(normal) == canonical_path(log.path);
        if (is_same) log.path = std::move(normal);
    }
    std::ranges::sort(
        logs, {}, [](const LogFile& log) { return std::pair(std::filesystem::path(log.path), log.why_not_fitted); });
    for (auto& log : logs) log.place = canonical_path(log.path);
    std::unordered_set<std::string> seen;
    std::erase_if(logs, [&](const LogFile& log) { return !seen.insert(log.place).second; });
    return logs;
}

/// The name, or of one that is too long for files its beginning and a fingerprint.
std::string file_name_of(std::string name) {
    constexpr std::size_t max_size = 255 - std::string_view("_999@64.record.json").size();
    constexpr std::size_t prefix = 200;
    if (name.size() <= max_size) return name;
    Fingerprint fingerprint;
    fingerprint.add(name);
    auto size = prefix;
    while (continues_character(name[size])) --size;  // whole characters
    return name.substr(0, size) + "~" + fingerprint.hex();
}

}  // namespace

std::string canonical_path(const std::string& log) {
    const std::filesystem::path path(log);
    std::error_code error;
    const auto folder = std::filesystem::absolute(path.has_parent_path() ? path.parent_path() : ".", error);
    const auto canonical = std::filesystem::weakly_canonical(folder, error);
    return ((error ? folder.lexically_normal() : canonical) / path.filename()).string();
}

void UniqueNames::reserve(const std::string& name) { taken_.insert(name); }

std::string UniqueNames::assign(const std::filesystem::path& log) {
    auto name = file_name_of(telemetry::flight_name(log));
    if (name.empty()) name = "unnamed";
    if (flight::is_recording_name(name)) name += "_";
    if (taken_.insert(name).second) return name;
    // With thousands of one name the search resumes where it stopped.
    for (auto& use = next_.try_emplace(name, 2).first->second;; ++use) {
        auto free = fmt::format("{}_{}", name, use);
        if (taken_.insert(free).second) return free;
    }
}

std::vector<std::string> parse_path_list(std::string_view text, const std::string& file) {
    if (const auto nul = text.find('\0'); nul != std::string_view::npos) {
        const auto line = static_cast<std::size_t>(std::ranges::count(text.substr(0, nul), '\n')) + 1;
        throw InputError({file, line}, "contains a NUL",
                         "expected the path of a log in each line, as find -print writes them");
    }
    std::vector<std::string> paths;
    while (!text.empty()) {
        auto line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(text.size(), line.size() + 1));
        if (line.ends_with('\r')) line.remove_suffix(1);  // a list that was written on Windows
        if (!line.empty()) paths.emplace_back(line);
    }
    return paths;
}

std::vector<LogFile> find_logs(const std::vector<std::string>& inputs, const std::vector<std::string>& listed,
                               const std::optional<std::filesystem::path>& columns) {
    std::vector<LogFile> logs;
    const auto add = [&](const std::string& path, bool has_to_exist) {
        std::error_code error;
        const auto status = std::filesystem::status(path, error);
        if (std::filesystem::is_directory(status)) return add_folder(path, path, columns, logs);
        if (has_to_exist && !std::filesystem::exists(status)) {
            const auto cause = path.empty() || !error || error == std::errc::no_such_file_or_directory
                                   ? "does not exist"
                                   : error.message();
            throw InputError(
                {path.empty() ? "''" : path}, cause,
                "expected a .data log, a .LOG or .tlm of an SD card, a .bin, .ulg or .tlog, or a folder of them");
        }
        const auto tables = columns ? std::nullopt : telemetry::find_ulog_tables(path);
        logs.push_back({tables ? tables->string() : path});
    };
    for (const auto& input : inputs) add(input, true);
    for (const auto& path : listed) add(path, false);
    logs = each_once(std::move(logs));
    if (logs.empty()) {
        throw InputError(
            {}, "no log in " + short_list(inputs.empty() ? listed : inputs),
            "expected *.data, *.LOG, *.tlm, *.bin, *.ulg or *.tlog, also .gz, .bz2, .xz or .zst, or flights as *.csv");
    }
    UniqueNames names;
    for (auto& log : logs) log.flight = names.assign(log.path);
    return logs;
}

}  // namespace flightwatt::batch
