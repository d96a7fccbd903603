#include "batch/manifest.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/overwrite_guard.h"
#include "base/text.h"
#include "base/toml_reader.h"
#include "flight/flight_file.h"
#include "telemetry/recordings.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <boost/algorithm/hex.hpp>
#include <fmt/format.h>

namespace flightwatt::batch {
namespace {

/// File names need not be UTF-8.
Json bytes_json(const std::string& bytes) {
    if (valid_utf8(bytes) == bytes) return bytes;
    return {{"hex", boost::algorithm::hex(bytes)}};
}

std::string bytes_from(const Json& json) {
    return json.is_object() ? boost::algorithm::unhex(json.at("hex").get<std::string>()) : json.get<std::string>();
}

/// Throws std::exception for an invalid flight.
LogFile flight_from(const Json& json) {
    LogFile flight{bytes_from(json.at("log")), bytes_from(json.at("flight")), bytes_from(json.at("why_not_fitted"))};
    flight.place = bytes_from(json.at("place"));
    constexpr std::string_view in_no_name("/\0", 2);
    const bool is_name = !flight.flight.empty() && flight.flight.find_first_of(in_no_name) == std::string::npos;
    const bool is_path = (flight.path + flight.place).find('\0') == std::string::npos;
    if (!is_name || !is_path) throw std::invalid_argument("no names of a flight");
    return flight;
}

Json json_of(const LogFile& flight) {
    return {{"flight", bytes_json(flight.flight)},
            {"log", bytes_json(flight.path)},
            {"place", bytes_json(flight.place)},
            {"why_not_fitted", bytes_json(flight.why_not_fitted)}};
}

std::unordered_set<std::string_view> names_of(const std::vector<LogFile>& flights) {
    std::unordered_set<std::string_view> names;
    for (const auto& flight : flights) names.insert(flight.flight);
    return names;
}

bool is_there(const std::filesystem::path& path) {
    std::error_code unknown;
    return std::filesystem::exists(path, unknown);
}

constexpr auto each_key = "is_of_each";  // of batch.json

bool is_folder_of_each(const std::filesystem::path& out) {
    if (!is_there(out / manifest_name)) return false;
    try {
        const OverwriteExemption own;
        return Json::parse(read_file(out / manifest_name)).value(each_key, false);
    } catch (const std::exception&) {
        return false;  // damaged
    }
}

/// Names this run's logs: as before, or with `prune` as a batch of them alone. Returns the names of the earlier flights
/// that are among them and keep their names.
std::unordered_set<std::string_view> name_logs(std::vector<LogFile>& logs, const std::vector<LogFile>& earlier,
                                               bool prune) {
    std::unordered_map<std::string_view, const LogFile*> by_place;
    std::unordered_map<std::string_view, const LogFile*> by_path;
    for (const auto& flight : earlier) {
        by_place.emplace(flight.place, &flight);
        by_path.emplace(flight.path, &flight);
    }
    // The flight of the same log, or of the same path if its own log is missing (moved folders).
    const auto find = [&](const LogFile& log) -> const LogFile* {
        if (const auto same = by_place.find(log.place); same != by_place.end()) return same->second;
        const auto moved = by_path.find(log.path);
        return moved == by_path.end() || is_there(moved->second->place) ? nullptr : moved->second;
    };
    std::unordered_set<std::string_view> known;
    UniqueNames names;
    std::vector<LogFile*> without_name;
    for (auto& log : logs) {
        const auto* before = log.problem.empty() && !prune ? find(log) : nullptr;
        if (before != nullptr && known.insert(before->flight).second) {
            log.flight = before->flight;
            names.reserve(log.flight);
        } else {
            without_name.push_back(&log);
        }
    }
    if (!prune)
        for (const auto& flight : earlier) names.reserve(flight.flight);
    for (auto* log : without_name) {
        log->flight = names.assign(log->path);
        const auto* before = log->problem.empty() && prune ? find(*log) : nullptr;
        if (before != nullptr && before->flight == log->flight) known.insert(before->flight);
    }
    return known;
}

/// An earlier flight that is not among this run's logs.
void add_earlier(LogFile flight, bool prune, BatchPlan& plan, std::vector<LogFile>& logs) {
    if (canonical_path(flight.path) != flight.place) flight.path = flight.place;  // run from another folder
    flight.is_of_this_run = false;
    flight.is_missing = !is_there(flight.path);
    const auto now = std::ranges::find(logs, flight.place, &LogFile::place);
    const auto state = flight.is_missing   ? "is missing"
                       : now != logs.end() ? fmt::format("is flight {} now", now->flight)
                                           : "is not in this batch";
    if (prune)
        plan.dropped.push_back({flight.flight, fmt::format("its log {} {}", flight.path, state)});
    else
        logs.push_back(std::move(flight));
}

}  // namespace

void read_batch_json(const std::filesystem::path& file, const std::string& text, const char* problem,
                     const std::string& hint, const std::function<void(const Json&)>& read) {
    try {
        const auto json = Json::parse(text, [](int depth, Json::parse_event_t /*event*/, Json& /*parsed*/) {
            constexpr int deepest = 20;
            if (depth > deepest) throw std::runtime_error("nested too deep");
            return true;
        });
        if (json.at("format").get<double>() > format_version) {
            throw InputError(
                {file.string()},
                fmt::format("its format is newer than this program, which reads formats up to {}", format_version),
                "use a newer FlightWatt, or " + hint);
        }
        read(json);
    } catch (const InputError&) {
        throw;
    } catch (const std::exception&) {
        throw InputError({file.string()}, problem, hint);
    }
}

std::filesystem::path result_path(const std::filesystem::path& out, std::string_view flight, const char* ending) {
    return out / "flights" / (std::string(flight) + ending);
}

void remove_results(const std::filesystem::path& out, const std::string& flight) {
    std::error_code ignored;
    const bool may_have_others = std::filesystem::exists(result_path(out, flight, record_suffix), ignored);
    for (std::size_t number = 1; number <= (may_have_others ? telemetry::max_recordings : 1); ++number)
        for (const auto* ending : result_suffixes)
            std::filesystem::remove(result_path(out, flight::recording_name(flight, number), ending), ignored);
}

std::vector<LogFile> read_manifest(const std::filesystem::path& out) {
    const OverwriteExemption own;
    const auto file = out / manifest_name;
    std::error_code none;
    std::vector<LogFile> logs;
    if (std::filesystem::symlink_status(file, none).type() == std::filesystem::file_type::not_found) return logs;
    read_batch_json(file, read_file(file), "not a manifest of a batch, or damaged", "choose another folder with -o",
                    [&](const Json& json) {
                        const auto& flights = json.at("flights");
                        if (!flights.is_array()) throw std::invalid_argument("no list of flights");
                        std::ranges::transform(flights, std::back_inserter(logs), flight_from);
                        if (names_of(logs).size() < logs.size()) throw std::invalid_argument("a name twice");
                    });
    return logs;
}

void write_manifest(const std::vector<LogFile>& logs, const std::filesystem::path& out, bool is_of_each) {
    auto flights = Json::array();
    for (const auto& flight : logs) flights.push_back(json_of(flight));
    auto files = std::set<std::string>(model_names.begin(), model_names.end());
    files.insert(catalogue_name);
    Json json{{"format", format_version}, {"files", files}, {"unfinished", temporary_folder}};
    if (is_of_each) json[each_key] = true;
    json["flights"] = std::move(flights);
    const OverwriteExemption own;
    write_file_atomically(out / manifest_name, json.dump(1, ' ') + "\n", out / temporary_folder);
}

BatchPlan plan_batch(std::vector<LogFile> logs, const std::filesystem::path& out, bool prune) {
    BatchPlan plan;
    plan.earlier = read_manifest(out);
    for (auto& log : logs)
        if (log.place.empty()) log.place = canonical_path(log.path);
    const auto known = name_logs(logs, plan.earlier, prune);
    for (const auto& flight : plan.earlier)
        if (!known.contains(flight.flight)) add_earlier(flight, prune, plan, logs);
    std::ranges::stable_sort(logs, {}, [](const LogFile& log) { return std::filesystem::path(log.path); });
    // A log with a problem leaves no file.
    std::ranges::copy_if(logs, std::back_inserter(plan.flights),
                         [](const LogFile& log) { return log.problem.empty(); });
    std::ranges::stable_sort(plan.flights, {}, &LogFile::flight);
    plan.logs = std::move(logs);
    return plan;
}

void refuse_foreign_files(const BatchPlan& plan, const std::filesystem::path& out) {
    std::vector<std::filesystem::path> files{out / catalogue_name};
    for (const auto* name : model_names) files.emplace_back(out / name);
    for (const auto& file : files) register_output(file);
    register_output(out / manifest_name);
    for (const auto* ending : result_suffixes) {
        for (const auto& dropped : plan.dropped) check_overwrite(result_path(out, dropped.flight, ending));
        for (const auto& flight : plan.flights) files.push_back(result_path(out, flight.flight, ending));
    }
    for (const auto& file : files) check_overwrite(file);
    if (is_there(out / manifest_name)) return;
    for (const auto& file : files) {
        std::error_code none;
        if (!is_there(file) || std::filesystem::is_directory(file, none)) continue;  // that cannot be overwritten
        throw UsageError(
            fmt::format("{} is not of a batch, as there is no {}, and would be replaced; move it away, or choose "
                        "another folder with -o",
                        file.string(), manifest_name));
    }
}

void prepare_folder(const BatchPlan& plan, const std::filesystem::path& out) {
    std::error_code ignored;
    std::filesystem::remove_all(out / temporary_folder, ignored);
    make_directories(out / "flights");
    make_directories(out / temporary_folder);
    const auto stay = names_of(plan.flights);
    for (const auto& dropped : plan.dropped)
        if (!stay.contains(dropped.flight)) remove_results(out, dropped.flight);
    write_manifest(plan.flights, out, plan.is_of_each);
}

std::vector<std::filesystem::path> folders_of_each(const std::filesystem::path& out) {
    std::vector<std::filesystem::path> folders;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(out, none))
        if (entry.is_directory(none) && !entry.is_symlink(none) && is_folder_of_each(entry.path()))
            folders.push_back(entry.path());
    std::ranges::sort(folders);
    return folders;
}

void remove_batch(const std::filesystem::path& out) {
    const auto flights = read_manifest(out);
    std::vector<std::filesystem::path> files{out / catalogue_name, out / manifest_name};
    for (const auto* name : model_names) files.emplace_back(out / name);
    for (const auto& file : files) check_overwrite(file);
    for (const auto& flight : flights)
        for (const auto* ending : result_suffixes) check_overwrite(result_path(out, flight.flight, ending));
    std::error_code ignored;
    for (const auto& flight : flights) remove_results(out, flight.flight);
    for (const auto& file : files) std::filesystem::remove(file, ignored);
    std::filesystem::remove_all(out / temporary_folder, ignored);
    for (const auto& folder : {out / "flights", out}) std::filesystem::remove(folder, ignored);
}

}  // namespace flightwatt::batch
