#include "batch/manifest.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/overwrite_guard.h"
#include "base/text.h"
#include "base/toml_reader.h"
#include "batch/flight_record.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <boost/algorithm/hex.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace flightwatt::batch {
namespace {

using ManifestJson = nlohmann::ordered_json;

/// File names need not be UTF-8.
ManifestJson bytes_json(const std::string& bytes) {
    if (valid_utf8(bytes) == bytes) return bytes;
    return {{"hex", boost::algorithm::hex(bytes)}};
}

std::string bytes_from(const ManifestJson& json) {
    return json.is_object() ? boost::algorithm::unhex(json.at("hex").get<std::string>()) : json.get<std::string>();
}

/// Throws std::exception for an invalid flight.
LogFile flight_from(const ManifestJson& json) {
    LogFile flight{bytes_from(json.at("log")), bytes_from(json.at("flight")), bytes_from(json.at("why_not_fitted"))};
    flight.place = bytes_from(json.at("place"));
    constexpr std::string_view in_no_name("/\0", 2);
    const bool is_name = !flight.flight.empty() && flight.flight.find_first_of(in_no_name) == std::string::npos;
    const bool is_path = (flight.path + flight.place).find('\0') == std::string::npos;
    if (!is_name || !is_path) throw std::invalid_argument("no names of a flight");
    return flight;
}

ManifestJson json_of(const LogFile& flight) {
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

/// Names this run's logs. Returns the names of the earlier flights that are among them.
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
        const auto* before = log.problem.empty() ? find(log) : nullptr;
        if (before != nullptr && known.insert(before->flight).second) {
            log.flight = before->flight;
            names.reserve(log.flight);
        } else {
            without_name.push_back(&log);
        }
    }
    if (!prune)
        for (const auto& flight : earlier) names.reserve(flight.flight);
    for (auto* log : without_name) log->flight = names.assign(log->path);
    return known;
}

/// Whether a flight without its log has a usable result; a damaged record may be one.
bool was_usable(const std::filesystem::path& out, const std::string& flight) {
    const OverwriteExemption own;
    const auto file = result_path(out, flight, record_suffix);
    std::error_code none;
    if (!std::filesystem::is_regular_file(file, none)) return false;
    const auto record = record_from_json(read_file(file));
    return !record || record->accepted;
}

/// An earlier flight that is not among this run's logs.
void add_earlier(LogFile flight, const std::filesystem::path& out, bool prune, BatchPlan& plan,
                 std::vector<LogFile>& logs) {
    if (canonical_path(flight.path) != flight.place) flight.path = flight.place;  // run from another folder
    flight.is_of_this_run = false;
    flight.is_missing = !is_there(flight.path);
    const auto state = flight.is_missing ? "is missing" : "is not in this batch";
    if (prune) {
        plan.dropped.push_back({flight.flight, fmt::format("its log {} {}", flight.path, state)});
    } else if (flight.is_missing && !was_usable(out, flight.flight)) {
        plan.dropped.push_back({flight.flight, fmt::format("its log {} is missing, no results", flight.path)});
    } else {
        logs.push_back(std::move(flight));
    }
}

void refuse_if_in_the_way(const std::filesystem::path& file, bool is_listed) {
    std::error_code none;
    const auto type = std::filesystem::symlink_status(file, none).type();
    using Type = std::filesystem::file_type;
    // A batch makes no links; a folder cannot be overwritten.
    const bool is_foreign = !is_listed && type != Type::not_found && type != Type::none && type != Type::directory;
    if (type != Type::symlink && !is_foreign) return;
    throw UsageError(
        fmt::format("{} is not of a batch (see {}) and would be replaced; move it away, or choose another folder "
                    "with -o",
                    file.string(), manifest_name));
}

/// Throws UsageError for links in OUT, which would replace or remove files of another folder.
void refuse_links(const std::filesystem::path& out) {
    for (const auto* name : {manifest_name, temporary_folder}) refuse_if_in_the_way(out / name, true);
    std::error_code unknown;
    const auto flights = std::filesystem::weakly_canonical(out / "flights", unknown);
    if (unknown || flights == std::filesystem::weakly_canonical(out, unknown) / "flights") return;
    if (!is_there(flights.parent_path() / manifest_name)) return;  // a link to a larger disk
    throw UsageError(
        fmt::format("{} leads into another batch, {}, whose flights would be lost; remove that link, or "
                    "choose another folder with -o",
                    (out / "flights").string(), flights.parent_path().string()));
}

void remove_unfinished(const std::filesystem::path& folder) {
    std::error_code ignored;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
        if (is_temporary_name(entry.path().filename().string())) files.push_back(entry.path());
    }
    for (const auto& file : files) std::filesystem::remove(file, ignored);
}

}  // namespace

nlohmann::ordered_json parse_json(const std::string& text) {
    using Json = nlohmann::ordered_json;
    return Json::parse(text, [](int depth, Json::parse_event_t /*event*/, Json& /*parsed*/) {
        constexpr int deepest = 20;
        if (depth > deepest) throw std::runtime_error("nested too deep");
        return true;
    });
}

std::filesystem::path result_path(const std::filesystem::path& out, std::string_view flight, const char* ending) {
    return out / "flights" / (std::string(flight) + ending);
}

void remove_results(const std::filesystem::path& out, const std::string& flight) {
    std::error_code ignored;
    for (const auto* ending : result_suffixes) std::filesystem::remove(result_path(out, flight, ending), ignored);
}

Manifest read_manifest(const std::filesystem::path& out) {
    const OverwriteExemption own;
    const auto file = out / manifest_name;
    std::error_code none;
    if (std::filesystem::symlink_status(file, none).type() == std::filesystem::file_type::not_found) return {};
    try {
        Manifest manifest;
        const auto json = parse_json(read_file(file));
        if (json.at("format").get<double>() > format_version) {
            throw InputError(
                {file.string()},
                fmt::format("its format is newer than this program, which reads formats up to {}", format_version),
                "use a newer FlightWatt, or another folder with -o");
        }
        manifest.files = json.at("files").get<std::set<std::string>>();
        const auto& flights = json.at("flights");
        if (!flights.is_array()) throw std::invalid_argument("no list of flights");
        manifest.flights.reserve(flights.size());
        std::ranges::transform(flights, std::back_inserter(manifest.flights), flight_from);
        if (names_of(manifest.flights).size() < manifest.flights.size()) throw std::invalid_argument("a name twice");
        return manifest;
    } catch (const InputError&) {
        throw;
    } catch (const std::exception&) {
        throw InputError({file.string()}, "not a manifest of a batch, or damaged", "choose another folder with -o");
    }
}

void write_manifest(const Manifest& manifest, const std::filesystem::path& out) {
    auto flights = ManifestJson::array();
    for (const auto& flight : manifest.flights) flights.push_back(json_of(flight));
    ManifestJson json{{"format", format_version}, {"files", manifest.files}, {"unfinished", temporary_folder}};
    json["flights"] = std::move(flights);
    const OverwriteExemption own;  // written before the work and after
    write_file_atomically(out / manifest_name, json.dump(1, ' ') + "\n", out / temporary_folder);
}

BatchPlan plan_batch(std::vector<LogFile> logs, const std::filesystem::path& out, bool prune) {
    BatchPlan plan;
    plan.earlier = read_manifest(out);
    const auto& earlier = plan.earlier.flights;
    for (auto& log : logs)
        if (log.place.empty()) log.place = canonical_path(log.path);
    const auto known = name_logs(logs, earlier, prune);
    for (const auto& flight : earlier)
        if (!known.contains(flight.flight)) add_earlier(flight, out, prune, plan, logs);
    std::ranges::stable_sort(logs, {}, [](const LogFile& log) { return std::filesystem::path(log.path); });
    plan.manifest.files = {model_names.begin(), model_names.end()};
    plan.manifest.files.insert(catalogue_name);
    // A log with a problem leaves no file.
    std::ranges::copy_if(logs, std::back_inserter(plan.manifest.flights),
                         [](const LogFile& log) { return log.problem.empty(); });
    std::ranges::stable_sort(plan.manifest.flights, {}, &LogFile::flight);
    plan.logs = std::move(logs);
    return plan;
}

void refuse_foreign_files(const BatchPlan& plan, const std::filesystem::path& out) {
    for (const auto& name : plan.manifest.files) {
        register_output(out / name);
        refuse_if_in_the_way(out / name, plan.earlier.files.contains(name));
    }
    register_output(out / manifest_name);
    refuse_links(out);
    for (const auto& dropped : plan.dropped)
        for (const auto* ending : result_suffixes) check_overwrite(result_path(out, dropped.flight, ending));
    const auto earlier = names_of(plan.earlier.flights);
    for (const auto& flight : plan.manifest.flights) {
        for (const auto* ending : result_suffixes) {
            const auto file = result_path(out, flight.flight, ending);
            check_overwrite(file);
            refuse_if_in_the_way(file, earlier.contains(flight.flight));
        }
    }
}

void prepare_folder(const BatchPlan& plan, const std::filesystem::path& out) {
    make_directories(out / "flights");
    make_directories(out / temporary_folder);
    remove_unfinished(out / temporary_folder);
    const auto stay = names_of(plan.manifest.flights);
    auto listed = plan.manifest;
    std::ranges::copy_if(plan.earlier.flights, std::back_inserter(listed.flights),
                         [&](const LogFile& flight) { return !stay.contains(flight.flight); });
    if (listed.flights.size() > plan.manifest.flights.size()) {
        write_manifest(listed, out);
        for (const auto& dropped : plan.dropped)
            if (!stay.contains(dropped.flight)) remove_results(out, dropped.flight);
    }
    write_manifest(plan.manifest, out);
}

}  // namespace flightwatt::batch
