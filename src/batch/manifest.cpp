#include "batch/manifest.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_use.h"
#include "base/toml_reader.h"
#include "batch/batch_files.h"

#include <algorithm>
#include <map>
#include <optional>

#include <boost/algorithm/hex.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace flightwatt::batch {
namespace {

using ManifestJson = nlohmann::ordered_json;

/// Names of files need not be UTF-8, as JSON is.
ManifestJson bytes_json(const std::string& bytes) {
    try {
        ManifestJson text = bytes;
        (void)text.dump();
        return text;
    } catch (const ManifestJson::exception&) {
        return {{"hex", boost::algorithm::hex(bytes)}};
    }
}

std::string bytes_from(const ManifestJson& json) {
    return json.is_object() ? boost::algorithm::unhex(json.at("hex").get<std::string>()) : json.get<std::string>();
}

bool is_there(const std::filesystem::path& path) {
    std::error_code unknown;
    return std::filesystem::exists(path, unknown);
}

bool begins_with(const std::filesystem::path& file, std::string_view beginning) {
    std::error_code none;
    return std::filesystem::is_regular_file(file, none) && read_file(file).starts_with(beginning);
}

/// The flight of a record of any version; std::nullopt for another program's file.
std::optional<ManifestFlight> flight_of_record(const std::filesystem::path& file, const std::string& name) {
    try {
        const auto json = ManifestJson::parse(read_file(file));
        for (const auto* key : {"flight", "fingerprint", "accepted", "measured"})
            if (!json.contains(key)) return std::nullopt;
        const std::string log = json.at("log");
        return ManifestFlight{name, log, place_of(log), json.value("why_not_fitted", "")};
    } catch (const InputError&) {
        return std::nullopt;
    } catch (const ManifestJson::exception&) {
        return std::nullopt;
    }
}

/// Before there was a batch.json, records told what a batch had written.
Manifest manifest_of_records(const std::filesystem::path& out) {
    Manifest manifest;
    for (const auto& name : recorded_flights(out / "flights")) {
        auto flight = flight_of_record(out / "flights" / (name + record_ending), name);
        if (flight) manifest.flights.push_back(std::move(*flight));
    }
    manifest.is_of_earlier_version = !manifest.flights.empty();
    if (manifest.is_of_earlier_version && begins_with(out / catalogue_name, "flight,sortie,phase,")) {
        manifest.files.insert(catalogue_name);
        manifest.files.insert(model_names.begin(), model_names.end());
    }
    return manifest;
}

/// Finds the earlier flight of a log: at the same place, or of the same path where its own place is gone (moved folders).
class EarlierFlights {
  public:
    explicit EarlierFlights(const std::vector<ManifestFlight>& flights) {
        for (const auto& flight : flights) {
            by_place_.emplace(flight.place, &flight);
            by_log_.emplace(flight.log, &flight);
        }
    }
    const ManifestFlight* find(const std::filesystem::path& log) const {
        if (const auto same = by_place_.find(place_of(log)); same != by_place_.end()) return same->second;
        const auto moved = by_log_.find(log);
        return moved == by_log_.end() || is_there(moved->second->place) ? nullptr : moved->second;
    }

  private:
    std::map<std::filesystem::path, const ManifestFlight*> by_place_;
    std::map<std::filesystem::path, const ManifestFlight*> by_log_;
};

/// Names this run's logs; marks in `known` the earlier flights that are among them.
void name_logs(std::vector<LogFile>& logs, const std::vector<ManifestFlight>& earlier, bool prune,
               std::set<std::string>& known) {
    const EarlierFlights flights(earlier);
    FreeNames names;
    std::vector<LogFile*> without_name;
    for (auto& log : logs) {
        const auto* before = log.problem.empty() ? flights.find(log.path) : nullptr;
        if (before != nullptr && known.insert(before->flight).second) {
            log.flight = before->flight;
            names.take(log.flight);
        } else {
            without_name.push_back(&log);
        }
    }
    if (!prune)
        for (const auto& flight : earlier) names.take(flight.flight);
    for (auto* log : without_name) log->flight = names.give(log->path);
}

/// Whether a flight without its log has a result worth keeping; a damaged record may be of one.
bool was_usable(const std::filesystem::path& out, const std::string& flight) {
    const OwnFiles own;
    const auto file = out / "flights" / (flight + record_ending);
    std::error_code none;
    if (!std::filesystem::is_regular_file(file, none)) return false;
    const auto record = record_from_json(read_file(file));
    return !record || record->accepted;
}

/// An earlier flight that is not among this run's logs.
void add_earlier(const ManifestFlight& flight, const std::filesystem::path& out, bool prune, BatchPlan& plan) {
    LogFile log{flight.log, flight.flight, flight.why_not_fitted};
    if (place_of(flight.log) != flight.place) log.path = flight.place;  // run from another folder
    log.is_of_this_run = false;
    log.is_gone = !is_there(log.path);
    const auto gone = log.is_gone ? "is gone" : "is not in this batch";
    if (prune) {
        plan.dropped.push_back({flight.flight, fmt::format("its log {} {}", log.path.string(), gone)});
    } else if (log.is_gone && !was_usable(out, flight.flight)) {
        plan.dropped.push_back(
            {flight.flight, fmt::format("its log {} is gone, and nothing came of it", log.path.string())});
    } else {
        plan.logs.push_back(std::move(log));
    }
}

bool is_in_the_way(const std::filesystem::path& file, bool is_listed) {
    std::error_code none;
    const auto type = std::filesystem::symlink_status(file, none).type();
    if (type == std::filesystem::file_type::symlink) return true;  // no batch makes links
    return !is_listed && type != std::filesystem::file_type::not_found && type != std::filesystem::file_type::none &&
           type != std::filesystem::file_type::directory;  // which is not lost: writing over it fails
}

void refuse_if_in_the_way(const std::filesystem::path& file, bool is_listed) {
    declare_output(file);
    if (!is_in_the_way(file, is_listed)) return;
    throw UsageError(
        fmt::format("{} would be replaced, and no batch wrote it (see {}); move it away, or choose another folder "
                    "with -o",
                    file.string(), manifest_name));
}

void remove_unfinished(const std::filesystem::path& folder) {
    std::error_code ignored;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
        if (is_unfinished_name(entry.path().filename().string())) files.push_back(entry.path());
    }
    for (const auto& file : files) std::filesystem::remove(file, ignored);
}

}  // namespace

std::filesystem::path place_of(const std::filesystem::path& log) {
    std::error_code error;
    const auto folder = log.has_parent_path() ? log.parent_path() : std::filesystem::path(".");
    const auto whole = std::filesystem::absolute(folder, error);
    const auto canonical = std::filesystem::weakly_canonical(whole, error);
    return (error ? whole.lexically_normal() : canonical) / log.filename();
}

Manifest read_manifest(const std::filesystem::path& out) {
    const OwnFiles own;
    const auto file = out / manifest_name;
    std::error_code none;
    if (std::filesystem::symlink_status(file, none).type() == std::filesystem::file_type::not_found) {
        return manifest_of_records(out);
    }
    const std::string hint =
        "choose another folder with -o; if a batch made this one, remove that file: its records then say what is its";
    try {
        const auto json = ManifestJson::parse(read_file(file));
        if (json.at("format").get<double>() > format_version) {
            throw InputError(
                {file.string()},
                fmt::format("its format is newer than this program, which reads formats up to {}", format_version),
                "use a newer FlightWatt, or another folder with -o");
        }
        Manifest manifest;
        manifest.files = json.at("files").get<std::set<std::string>>();
        for (const auto& flight : json.at("flights")) {
            manifest.flights.push_back({bytes_from(flight.at("flight")), bytes_from(flight.at("log")),
                                        bytes_from(flight.at("place")), bytes_from(flight.at("why_not_fitted"))});
            const auto& name = manifest.flights.back().flight;
            if (name.empty() || name.find('/') != std::string::npos) throw std::invalid_argument("no name of a file");
        }
        return manifest;
    } catch (const InputError&) {
        throw;
    } catch (const std::exception&) {
        throw InputError({file.string()}, "this is no list of what a batch wrote, or it is damaged", hint);
    }
}

void write_manifest(const Manifest& manifest, const std::filesystem::path& out) {
    auto flights = ManifestJson::array();
    for (const auto& flight : manifest.flights) {
        flights.push_back({{"flight", bytes_json(flight.flight)},
                           {"log", bytes_json(flight.log.string())},
                           {"place", bytes_json(flight.place.string())},
                           {"why_not_fitted", bytes_json(flight.why_not_fitted)}});
    }
    const ManifestJson json{
        {"format", format_version}, {"files", manifest.files}, {"unfinished", unfinished_folder}, {"flights", flights}};
    const OwnFiles own;  // written before the work and after
    write_file_atomically(out / manifest_name, json.dump(1, ' ') + "\n", out / unfinished_folder);
}

BatchPlan plan_batch(std::vector<LogFile> logs, const std::filesystem::path& out, bool prune) {
    BatchPlan plan;
    plan.earlier = read_manifest(out);
    std::set<std::string> known;
    name_logs(logs, plan.earlier.flights, prune, known);
    plan.logs = std::move(logs);
    for (const auto& flight : plan.earlier.flights) {
        if (!known.contains(flight.flight)) add_earlier(flight, out, prune, plan);
    }
    std::ranges::stable_sort(plan.logs, {}, &LogFile::path);
    plan.manifest.files = {model_names.begin(), model_names.end()};
    plan.manifest.files.insert(catalogue_name);
    for (const auto& log : plan.logs) {
        if (!log.problem.empty()) continue;  // leaves no file
        plan.manifest.flights.push_back({log.flight, log.path, place_of(log.path), log.why_not_fitted});
    }
    std::ranges::sort(plan.manifest.flights, {}, &ManifestFlight::flight);
    return plan;
}

void refuse_files_of_others(const BatchPlan& plan, const std::filesystem::path& out) {
    for (const auto& name : plan.manifest.files) {
        refuse_if_in_the_way(out / name, plan.earlier.files.contains(name));
    }
    declare_output(out / manifest_name);
    std::set<std::string> earlier;
    for (const auto& flight : plan.earlier.flights) earlier.insert(flight.flight);
    for (const auto& flight : plan.manifest.flights) {
        for (const auto* ending : result_endings) {
            refuse_if_in_the_way(out / "flights" / (flight.flight + ending), earlier.contains(flight.flight));
        }
    }
}

void prepare_folder(const BatchPlan& plan, const std::filesystem::path& out) {
    make_directories(out / unfinished_folder);
    remove_unfinished(out / unfinished_folder);
    std::set<std::string> stay;
    for (const auto& flight : plan.manifest.flights) stay.insert(flight.flight);
    auto listed = plan.manifest;
    for (const auto& flight : plan.earlier.flights)
        if (!stay.contains(flight.flight)) listed.flights.push_back(flight);
    write_manifest(listed, out);
    make_directories(out / "flights");
    if (listed.flights.size() == plan.manifest.flights.size()) return;
    for (const auto& dropped : plan.dropped)
        if (!stay.contains(dropped.flight)) remove_results(out, dropped.flight);
    write_manifest(plan.manifest, out);
}

}  // namespace flightwatt::batch
